import { defineConfig } from 'vite';

// The page is cross-origin isolated: only then are timers fine-grained.
const headers = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

export default defineConfig({
  // Relative addresses: the built page works in any folder of any server.
  base: './',
  build: {
    target: 'es2022',
    // Inlined, a module could not be compiled while it streams in.
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
  },
  worker: { format: 'es' },
  resolve: {
    // `sinew-wasm` is a link to a folder with modules of its own.
    dedupe: ['three'],
  },
  server: { host: '127.0.0.1', headers, fs: { allow: ['.', '../wasm'] } },
  preview: { host: '127.0.0.1', headers },
});
