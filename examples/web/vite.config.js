// Configures Vite, which builds the page.

import { defineConfig } from "vite";
import { distFolder, publicFolder } from "./tools/folders.mjs";

// Paths relative to the page, so that the built files may be served from any folder.
// The package of runtime/web is linked: it must use the same three as the page, and be served during development.
export default defineConfig({
  base: "./",
  resolve: { dedupe: ["three"] },
  server: { fs: { allow: ["../.."] } },
  publicDir: publicFolder,
  build: { outDir: distFolder, emptyOutDir: true, chunkSizeWarningLimit: 1200 },
});
