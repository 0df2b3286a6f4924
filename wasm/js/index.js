import initGlue, { version } from '../pkg/sinew.js';

// A function that returns i8x16.splat(0): valid only where 128-bit SIMD is.
const PROBE = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11,
]);

/** True where the SIMD build runs. Both builds give the same bits; only the speed differs. */
export const simd = typeof WebAssembly === 'object' && WebAssembly.validate(PROBE);

// Written out in full, so that bundlers find the files.
const shipped = () =>
  simd
    ? new URL('../pkg/sinew_simd_bg.wasm', import.meta.url)
    : new URL('../pkg/sinew_scalar_bg.wasm', import.meta.url);

// Node's fetch does not read files.
const reachable = (url) =>
  url.protocol === 'file:' ? globalThis.process.getBuiltinModule('node:fs').readFileSync(url) : url;

/**
 * Loads the runtime, once: later calls get the same. `source` replaces the shipped module
 * (bytes, a compiled module, a response or an address).
 */
export const init = (source) => initGlue({ module_or_path: source ?? reachable(shipped()) });

export { version };
