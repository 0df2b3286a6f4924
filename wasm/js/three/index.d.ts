import type { LineSegments, Object3D } from 'three';
import type { GLTF, GLTFLoaderPlugin, GLTFParser } from 'three/examples/jsm/loaders/GLTFLoader.js';
import type { Asset, Bytes, Character, SomeTunables, Tunables, Verdict } from '../index.js';

/** What a frame cost. */
export interface SinewStats {
  /** The whole of {@link SinewCharacter.update}, µs. */
  microseconds: number;
  /** The step alone, µs. */
  stepMicroseconds: number;
  /** Points that move. */
  points: number;
  /** Render vertices. */
  vertices: number;
  /** Whether nothing was due in the last step. */
  held: boolean;
}

/**
 * The flesh of a loaded glTF file.
 *
 * It writes the position and normal attributes of the skinned meshes, in bind space: skinning on the GPU,
 * shadows, morphs, outlines and materials go on as they were. A frame is, in this order:
 *
 * ```js
 * mixer.update(delta);   // animation
 * // inverse kinematics, look-at
 * vrm?.update(delta);    // VRM: constraints, spring bones
 * sinew.update(delta);   // flesh, on the bones as they now are
 * renderer.render(scene, camera);
 * ```
 *
 * The root is the world transform of `gltf.scene`: move the character by that or by what it hangs on.
 */
export declare class SinewCharacter {
  /**
   * @param asset the asset of this very file, or its bytes.
   * @throws Error where asset and file do not belong together.
   */
  constructor(gltf: Pick<GLTF, 'scene' | 'parser'>, asset: Asset | Bytes);
  readonly asset: Asset;
  /** What is below: everything that is not offered here. */
  readonly character: Character;
  /** `gltf.scene`. */
  readonly root: Object3D;
  /** World units in a unit of the asset; known after the first update. */
  readonly unit: number | undefined;
  readonly stats: SinewStats;

  /**
   * Lets `delta` seconds pass; updates the world matrices below the root. `delta` ≤ 0 does nothing.
   *
   * @returns true where the attributes are new.
   */
  update(delta: number): boolean;
  /** Forgets all motion and shows rest. */
  reset(): void;
  /** Takes the pose and the size at the next update as where the character begins. */
  setInitState(): void;
  /** Declares that the root's next move is a teleport: it is not felt. */
  teleport(): void;
  /** Off, the meshes have the attributes that the file gave them. */
  enabled: boolean;
  /** As {@link Character.tunables}. */
  get tunables(): Tunables;
  set tunables(tunables: SomeTunables);
  /** Whether the flesh is coloured by how far it is from rest: see `heatStops`. Materials are swapped meanwhile. */
  heatMap: boolean;

  record(snapshotEvery?: number): void;
  readonly recording: boolean;
  stopRecording(): Uint8Array;
  /** Runs a replay again, on a character of its own. */
  verify(bytes: Bytes): Verdict;

  /** Gives the meshes back as they were and frees the memory. Twice is harmless. */
  dispose(): void;
}

type AssetSource = Asset | Bytes | Response | URL | string;

export interface SinewLoaderOptions {
  /** The asset of the file that is loaded, where to get it, or a function that tells. */
  asset: AssetSource | Promise<AssetSource> | ((gltf: GLTF, parser: GLTFParser) => AssetSource | Promise<AssetSource>);
  /** An object at the origin to which a {@link SinewHelper} is added. */
  helperRoot?: Object3D;
}

/**
 * Gives loaded files flesh: `loader.register((parser) => new SinewLoaderPlugin(parser, { asset }))`, then
 * `gltf.userData.sinew` is a {@link SinewCharacter}. Loads the runtime where that was not done.
 */
export declare class SinewLoaderPlugin implements GLTFLoaderPlugin {
  readonly name: string;
  constructor(parser: GLTFParser, options: SinewLoaderOptions);
  afterRoot(gltf: GLTF): Promise<void>;
}

/** Lines from where skinning alone puts the vertices to where their flesh is. Add it to an object at the origin. */
export declare class SinewHelper extends LineSegments {
  constructor(flesh: SinewCharacter, options?: { every?: number; color?: number });
  update(): void;
  dispose(): void;
}

/**
 * Colours of the heat map, linear RGB, from rest to the largest offset, evenly along the root of the share:
 * of five colours the second stands for 1/16 of the largest offset, the third for 1/4, the fourth for 9/16.
 */
export declare const heatStops: readonly (readonly [number, number, number])[];
