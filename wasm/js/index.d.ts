/** Bytes. */
export type Bytes = ArrayBufferView | ArrayBufferLike;

/** What {@link init} can load the runtime from. */
export type InitInput = URL | string | Request | Response | Bytes | WebAssembly.Module;

/** True where the SIMD build runs. Both builds give the same bits; only the speed differs. */
export declare const simd: boolean;

/**
 * Loads the runtime, once; later calls wait for the first. Afterwards all constructors are synchronous.
 *
 * Without `source` the shipped module is taken, with SIMD or without as the host allows. `source` replaces
 * it: an address (in Node also `file:`), a response, bytes or a compiled module.
 */
export declare function init(source?: InitInput | Promise<InitInput>): Promise<void>;

/** As {@link init}, from bytes or a compiled module, at once: for workers and tests. */
export declare function initSync(source: Bytes | WebAssembly.Module): void;

/**
 * Zero where floats behave as IEEE 754 begins; otherwise one bit a surprise (flushed subnormals, another
 * rounding): replays of such a host will not verify elsewhere.
 */
export declare function floatEnvironment(): number;

/** Version of the runtime module. */
export declare function version(): string;

/** An animation clip of an asset. */
export interface Clip {
  readonly name: string;
  /** Length, s. */
  readonly duration: number;
}

/** A glTF primitive and its render vertices: `first` to `first + count` of the arrays of a {@link Character}. */
export interface Primitive {
  /** glTF node that carries the mesh. */
  readonly node: number;
  /** glTF mesh. */
  readonly mesh: number;
  /** Index of the primitive in the mesh. */
  readonly primitive: number;
  readonly first: number;
  readonly count: number;
}

/**
 * What is thrown: `code` is a stable name for programs, `STEP_BAD_ROOT` or `ASSET_WRONG_HASH`, the same as in Rust;
 * the text may change.
 */
export interface SinewError extends Error {
  readonly code: string;
}

/** A baked character. Its bytes are copied into the module's memory, once, and checked. */
export declare class Asset {
  /** @throws SinewError that says what is wrong with the bytes. */
  constructor(bytes: Bytes);
  /** Content hash, 16 hexadecimal digits. */
  readonly hash: string;
  readonly jointCount: number;
  /** Render vertices of all primitives. */
  readonly vertexCount: number;
  /** Points that move. */
  readonly pointCount: number;
  /** Diagonal of the rest pose's bounding box, model units: the length that tunables are told in. */
  readonly bodySize: number;
  /** Names of the regions. */
  readonly regions: readonly string[];
  readonly clips: readonly Clip[];
  readonly primitives: readonly Primitive[];
  /** glTF node of each joint. */
  readonly jointNodes: Uint32Array;
  /** Render vertices that can move; the others stay at rest. */
  readonly moved: Uint32Array;
  /** Frees the memory, when the last character of this asset is disposed too. Twice is harmless. */
  dispose(): void;
  /** The same as {@link dispose}. */
  free(): void;
}

/** Where a character's root is: `world_from_root`, without scale. */
export interface Root {
  /** Three numbers of full precision: far from the origin costs nothing. */
  translation: ArrayLike<number>;
  /** `[x, y, z, w]`. */
  rotation: ArrayLike<number>;
}

/** Parameters of a region. */
export interface RegionTunables {
  name: string;
  /** Hz, 0 to 60. */
  frequency: number;
  /** Damping ratio, 0 to 100; 1 is critical. */
  damping: number;
  /** Factor of the offset, 0 to 100. */
  gain: number;
  /** Largest offset, body sizes. */
  maxOffset: number;
}

/** What a person may turn while the character lives. Lengths are in body sizes. */
export interface Tunables {
  /** Gravity in the world, body sizes per s²; equal to the authored one, nothing sags. */
  gravity: [number, number, number];
  /** Acceleration by wind in the world, body sizes per s². */
  wind: [number, number, number];
  /** Share of the wind that comes in gusts, 0 to 1. */
  gust: number;
  /** Gusts a second, 0 to 60. */
  gustRate: number;
  /** Share of the root's motion that is felt, 0 to 1. */
  inertia: number;
  /** Factor of all offsets, 0 to 100. */
  gain: number;
  /** Factor of all frequencies, above 0, at most 20. */
  frequency: number;
  /** Factor of all damping ratios, 0 to 100. */
  damping: number;
  /** A step of the root longer than this is a teleport, body sizes. */
  teleport: number;
  /** A step longer than this settles the flesh, s, above 0, at most 10. */
  settleAfter: number;
  regions: RegionTunables[];
}

/** Some of the tunables; regions are found by `name`, or by their place without one. */
export type SomeTunables = Partial<Omit<Tunables, 'regions'>> & { regions?: Partial<RegionTunables>[] };

/** Digests of what each stage made in the last step: equal on all machines. */
export interface Digests {
  pose: bigint;
  skin: bigint;
  dynamics: bigint;
  embed: bigint;
}

/**
 * A character: pose in, offset vertices out.
 *
 * Arrays are views of the module's memory: ask for them again after creating another asset or character, since
 * memory that grew leaves old views empty; and keep none past {@link dispose}. Steps allocate nothing.
 */
export declare class Character {
  constructor(asset: Asset);

  /** To fill in before {@link step}: `root_from_joint` of each joint, columns x, y, z and translation, 12 floats. */
  readonly pose: Float32Array;
  /** Where the root is. Write into its arrays, or set another. */
  root: Root;

  /**
   * Advances by `dt` seconds to {@link pose} and {@link root}. `dt` ≤ 0 does nothing.
   *
   * @returns true where the buffers are new.
   * @throws SinewError for input that is not finite; nothing changes then.
   */
  step(dt: number): boolean;
  /** As {@link step}, to the asset's own clip (index or name) at `time`, s. */
  stepClip(clip: number | string, time: number, dt: number): boolean;
  /** Plays a clip `loops` times in steps of `dt` seconds, so that the first frame shown does not pop. */
  warmUp(clip: number | string, loops: number, dt: number): void;

  /** Bind-space positions of the render vertices, rest plus offset: three floats each. */
  readonly positions: Float32Array;
  /** Bind-space unit normals of the render vertices: three floats each. */
  readonly normals: Float32Array;
  /** Bind-space offsets of the moving points: three floats each. */
  readonly offsets: Float32Array;
  /** Render vertices that can move; the others stay at rest. */
  readonly moved: Uint32Array;
  /** |offset| / largest offset of each render vertex, written to `out` or in a view of the module's memory. */
  heat(): Float32Array;
  heat<T extends Float32Array | Float64Array | number[]>(out: T): T;
  /** Skins on the processor: positions and normals in the root's frame, with flesh or without. */
  skin(flesh?: boolean): { positions: Float32Array; normals: Float32Array };

  /**
   * What is in force. Reading gives a copy; setting an object with some of the fields changes those, and the
   * motion goes on.
   *
   * @throws SinewError that names the field out of its range; nothing changes then.
   */
  get tunables(): Tunables;
  set tunables(tunables: SomeTunables);

  /** Forgets all motion: shows rest, and the next step starts at rest in its pose. */
  reset(): void;
  /** Lets the next step put the flesh where it would come to rest in its pose. */
  settle(): void;
  /** Declares that the next step of the root is a teleport: it is not felt. */
  teleport(): void;
  /** Stops the flesh where it is, or lets it catch up at the next step. */
  freeze(frozen: boolean): void;
  /** Advances only every `divisor`-th step, by all the time since the last. */
  setRateDivisor(divisor: number): void;

  /** Bytes of a saved state. */
  readonly stateLength: number;
  /** Saves the state, to `out` or to new bytes. */
  saveState(out?: Uint8Array): Uint8Array;
  /** Restores a state; the next step goes on from it bit for bit. */
  loadState(bytes: Bytes): void;

  readonly digests: Digests;

  /** Begins a recording, with a snapshot of the state after every `snapshotEvery`-th step (60). It grows in memory. */
  record(snapshotEvery?: number): void;
  readonly recording: boolean;
  /** Ends the recording: the bytes of a replay. */
  stopRecording(): Uint8Array;

  /** Frees the memory. Twice is harmless; every other method throws afterwards. */
  dispose(): void;
  /** The same as {@link dispose}. */
  free(): void;
}

/** What became of a batch. */
export interface Batch {
  /** How many characters advanced: their buffers are new. */
  advanced: number;
  /** Those refused, which are as they were. */
  refusals: { index: number; error: SinewError }[];
}

/**
 * {@link Character.step} on each of many characters, their poses and roots being filled in. One that
 * is refused holds up no other.
 */
export declare function stepBatch(characters: readonly Character[], dt: number): Batch;

/** What verifying a replay found. */
export interface Verdict {
  /** Whether every frame came out the same, to the bit. */
  same: boolean;
  frames: number;
  /** Digest of the whole run, 16 hexadecimal digits. */
  digest: string;
  /** In words. */
  message: string;
  /** The first frame that differs. */
  frame?: number;
  /** The earliest stage that differs there; `undefined` where it is the replay that is damaged. */
  stage?: string | undefined;
}

/**
 * Runs a replay again on a new character of `asset`, to the first difference.
 *
 * @throws SinewError for bytes that are no replay of this asset, or whose inputs are damaged.
 */
export declare function verify(asset: Asset, replay: Bytes): Verdict;
