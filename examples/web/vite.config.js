import { defineConfig } from "vite";

// Paths relative to the page, so that the built files may be served from any folder.
export default defineConfig({ base: "./", build: { chunkSizeWarningLimit: 1200 } });
