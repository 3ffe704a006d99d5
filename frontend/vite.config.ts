import { defineConfig } from "vite";

// `npm run dev` talks to a running `stairwright serve`; in production FastAPI serves dist/ itself.
const backend = "http://127.0.0.1:8000";

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    outDir: "dist",
    chunkSizeWarningLimit: 1800, // the API's documents; the page itself stays far below
    modulePreload: { polyfill: false },
    rolldownOptions: {
      input: ["index.html", "docs.html"],
      output: {
        // One file of what the workspaces share with the page, instead of a dozen small ones.
        codeSplitting: {
          groups: [
            {
              name: "shared",
              test: /\/(src\/(?!map|designs|robot|runs|plots)|node_modules\/(@?preact))/,
              minShareCount: 2,
            },
          ],
        },
      },
    },
  },
  server: {
    proxy: {
      "/api": backend,
      "/scene": { target: backend, ws: true },
    },
  },
});
