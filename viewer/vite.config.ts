import { defineConfig } from "vitest/config";

export default defineConfig({
  base: "./",
  // no inlined data: addresses: the page's content policy allows only files of the server
  build: {
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
    modulePreload: { polyfill: false },
    rollupOptions: { input: ["index.html", "study/operator.html", "study/participant.html"] },
  },
  test: { include: ["test/**/*.test.ts"] },
});
