// Every model of the shared data, through the loader and the adapter, as a page would.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Asset, init } from 'sinew-wasm';
import { SinewCharacter } from 'sinew-wasm/three';
import { Texture } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { shared, sharedModels } from './fixture.mjs';

// What three's FileLoader needs of a browser to read `data:` addresses.
globalThis.ProgressEvent ??= class extends Event {};
const models = sharedModels();
assert.ok(models.length > 20 || process.env.CI !== 'true', `${models.length} models`);
await init();

for (const path of models) {
  test(path, async () => {
    let file;
    try {
      file = shared(path);
    } catch (error) {
      assert.match(error.message, /no mesh has a skin/, path);
      return;
    }
    const loader = new GLTFLoader();
    loader.register(() => ({ name: 'NO_PICTURES', loadTexture: () => Promise.resolve(new Texture()) }));
    const { buffer, byteOffset, byteLength } = file.glb;
    const gltf = await loader.parseAsync(buffer.slice(byteOffset, byteOffset + byteLength), '');
    const asset = new Asset(file.asset);
    const flesh = new SinewCharacter(gltf, asset);
    for (let frame = 0; frame < 3; frame++) {
      gltf.scene.position.x += 0.02 * asset.bodySize;
      assert.equal(flesh.update(1 / 60), true);
    }
    assert.ok(flesh.character.positions.every(Number.isFinite));
    flesh.dispose();
    asset.dispose();
  });
}
