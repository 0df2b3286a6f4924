import { init } from '../index.js';
import { readable } from '../readable.js';
import { SinewCharacter } from './character.js';
import { SinewHelper } from './helper.js';

export class SinewLoaderPlugin {
  name = 'SINEW';
  #parser;
  #options;

  constructor(parser, options = {}) {
    this.#parser = parser;
    this.#options = options;
  }

  async afterRoot(gltf) {
    const { asset, helperRoot } = this.#options;
    const given = await (typeof asset === 'function' ? asset(gltf, this.#parser) : asset);
    if (given === undefined) throw new Error('SinewLoaderPlugin: options.asset is missing: bake the file first');
    await init();
    const found = await readable(given);
    const flesh = new SinewCharacter(gltf, found instanceof Response ? await found.arrayBuffer() : found);
    gltf.userData.sinew = flesh;
    helperRoot?.add(new SinewHelper(flesh));
  }
}
