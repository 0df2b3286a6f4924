// Loads the runtime module, once.
import initGlue, { initSync as initGlueSync } from '../pkg/sinew.js';
import { coded } from './error.js';
import { readable } from './readable.js';

// A function that returns i8x16.splat(0): valid only where 128-bit SIMD is.
const PROBE = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11,
]);

export const simd = typeof WebAssembly === 'object' && WebAssembly.validate(PROBE);

// Written out in full, so that bundlers find the files.
const shipped = () =>
  simd
    ? new URL('../pkg/sinew_simd_bg.wasm', import.meta.url)
    : new URL('../pkg/sinew_scalar_bg.wasm', import.meta.url);

let loading;
let linear;

export function init(source) {
  loading ??= start(source).catch((error) => {
    loading = undefined; // a later call may do better
    throw error;
  });
  return loading;
}

async function start(source) {
  const module = await readable((await source) ?? shipped());
  linear = (await initGlue({ module_or_path: module })).memory;
}

export function initSync(module) {
  linear ??= initGlueSync({ module }).memory;
}

/** `bytes`, copied if they lie in the module's memory: a call that lets it grow would take them away. */
export function apart(bytes) {
  return bytes.buffer === memory().buffer ? bytes.slice() : bytes;
}

/** The module's memory. Its buffer is another one after it has grown. */
export function memory() {
  if (linear === undefined) throw coded('NOT_LOADED', 'sinew-wasm is not loaded: call `await init()` first');
  return linear;
}
