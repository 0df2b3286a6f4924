import { RawAsset } from '../pkg/sinew.js';
import { coded } from './error.js';
import { apart, memory } from './load.js';
import { bytesOf } from './readable.js';

/** The handle of an asset, for the other classes of this package. */
export let rawOf;

/** Index of a clip in `clips`, from its index or name. */
export function clipIndex(clips, clip) {
  const index = typeof clip === 'string' ? clips.findIndex(({ name }) => name === clip) : clip;
  if (Number.isInteger(index) && index >= 0 && index < clips.length) return index;
  throw coded('STEP_NO_SUCH_CLIP', `the asset has no clip ${typeof clip === 'string' ? `"${clip}"` : clip}`);
}

export class Asset {
  #raw;
  #cache = {};

  static {
    rawOf = (asset) => asset.#live();
  }

  constructor(bytes) {
    memory();
    this.#raw = RawAsset.parse(apart(bytesOf(bytes, 'new Asset(bytes)')));
  }

  #live() {
    if (this.#raw === undefined) throw coded('DISPOSED', 'this Asset was disposed');
    return this.#raw;
  }

  /** Made once: none of it changes. */
  #once(name, make) {
    const raw = this.#live();
    return (this.#cache[name] ??= make(raw));
  }

  get hash() {
    return this.#once('hash', (raw) => raw.hash());
  }

  get jointCount() {
    return this.#once('jointCount', (raw) => raw.joints());
  }

  get vertexCount() {
    return this.#once('vertexCount', (raw) => raw.vertices());
  }

  get pointCount() {
    return this.#once('pointCount', (raw) => raw.points());
  }

  get bodySize() {
    return this.#once('bodySize', (raw) => raw.body_size());
  }

  get regions() {
    return this.#once('regions', (raw) => Object.freeze(raw.regions()));
  }

  get clips() {
    return this.#once('clips', (raw) => {
      const durations = raw.clip_durations();
      return Object.freeze(raw.clip_names().map((name, i) => Object.freeze({ name, duration: durations[i] })));
    });
  }

  get primitives() {
    return this.#once('primitives', (raw) => {
      const rows = raw.primitives();
      const row = (_, i) => {
        const [node, mesh, primitive, first, count] = rows.subarray(6 * i);
        return Object.freeze({ node, mesh, primitive, first, count });
      };
      return Object.freeze(Array.from({ length: rows.length / 6 }, row));
    });
  }

  get jointNodes() {
    return this.#once('jointNodes', (raw) => raw.joint_nodes());
  }

  get moved() {
    return this.#once('moved', (raw) => raw.moved());
  }

  dispose() {
    this.#raw?.free();
    this.#raw = undefined;
  }

  free() {
    this.dispose();
  }

  [Symbol.dispose ?? '@@dispose']() {
    this.dispose();
  }
}
