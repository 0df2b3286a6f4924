import { floatEnvironment as rawFloatEnvironment, version as rawVersion } from '../pkg/sinew.js';
import { memory } from './load.js';

export { Asset } from './asset.js';
export { stepBatch } from './batch.js';
export { Character } from './character.js';
export { init, initSync, simd } from './load.js';
export { verify } from './replay.js';

export function floatEnvironment() {
  memory();
  return rawFloatEnvironment();
}

export function version() {
  memory();
  return rawVersion();
}
