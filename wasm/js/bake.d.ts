import type { Bytes, InitInput } from './index.js';

/** Loads the baker, once: a module of its own, for pages into which models are dropped. */
export declare function init(source?: InitInput | Promise<InitInput>): Promise<void>;

/** What came of baking. */
export interface Baked {
  /** The asset: `new Asset(baked.asset)`. */
  asset: Uint8Array;
  /** What a person should know: vertices left to spring bones, no flesh found. */
  notes: string[];
  /** Names of the regions. */
  regions: string[];
}

/** Bytes of the files beside a `.gltf`, by relative path, percent-decoded; `undefined` where there is none. */
export type Resolve =
  | ((uri: string) => Bytes | null | undefined)
  | Map<string, Bytes>
  | Record<string, Bytes>;

/**
 * Bakes the bytes of a `.glb`, `.gltf` or `.vrm`: where flesh is and how soft, from geometry and weights alone.
 *
 * It takes up to seconds: run it in a worker. `name` is the file's name, for errors. `recipe` is TOML.
 *
 * @throws Error with one line that names the file, the place, the problem and the remedy.
 */
export declare function bake(
  bytes: Bytes,
  name: string,
  options?: { resolve?: Resolve; recipe?: string },
): Baked;

/** The character that comes with sinew, as a file and baked. */
export declare function builtin(): Baked & { glb: Uint8Array };
