import initGlue, { bake as rawBake, builtin as rawBuiltin } from '../pkg/bake/bake.js';
import { bytesOf, readable } from './readable.js';

let loading;

export function init(source) {
  loading ??= start(source).catch((error) => {
    loading = undefined; // a later call may do better
    throw error;
  });
  return loading;
}

let loaded = false;

async function start(source) {
  const shipped = () => new URL('../pkg/bake/bake_bg.wasm', import.meta.url);
  await initGlue({ module_or_path: await readable((await source) ?? shipped()) });
  loaded = true;
}

function check() {
  if (!loaded) throw new Error('sinew-wasm/bake is not loaded: call `await init()` of it first');
}

/** Takes what `raw` holds, and frees it. */
function take(raw) {
  try {
    const out = { asset: raw.asset(), notes: raw.notes(), regions: raw.regions() };
    const glb = raw.glb();
    return glb.length > 0 ? { glb, ...out } : out;
  } finally {
    raw.free();
  }
}

export function bake(bytes, name, { resolve = {}, recipe } = {}) {
  check();
  const find = typeof resolve === 'function' ? resolve : (uri) => (resolve instanceof Map ? resolve.get(uri) : resolve[uri]);
  const asBytes = (uri) => {
    const found = find(uri);
    return found === undefined || found === null ? undefined : bytesOf(found, `resolve("${uri}")`);
  };
  return take(rawBake(bytesOf(bytes, 'bake(bytes, name)'), String(name ?? 'character'), asBytes, recipe));
}

export function builtin() {
  check();
  return take(rawBuiltin());
}
