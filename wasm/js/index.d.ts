import type { InitInput, InitOutput } from '../pkg/sinew.js';

/** True where the SIMD build runs. Both builds give the same bits; only the speed differs. */
export declare const simd: boolean;

/**
 * Loads the runtime, once: later calls get the same. `source` replaces the shipped module
 * (bytes, a compiled module, a response or an address).
 */
export declare function init(source?: InitInput | Promise<InitInput>): Promise<InitOutput>;

export { version } from '../pkg/sinew.js';
