// Configures Vite, which builds the page.

import { defineConfig } from "vite";
import { distFolder, publicFolder } from "./tools/folders.mjs";

// Paths relative to the page, so that the built files may be served from any folder.
export default defineConfig({
  base: "./",
  publicDir: publicFolder,
  build: { outDir: distFolder, emptyOutDir: true, chunkSizeWarningLimit: 1200 },
});
