// The three.js adapter on real files: GLTFLoader, AnimationMixer and SkinnedMesh are three's own.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { Asset, Character, init } from 'sinew-wasm';
import { SinewCharacter, SinewHelper, SinewLoaderPlugin } from 'sinew-wasm/three';
import { AnimationMixer, Group, Scene, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { builtin, shared } from './fixture.mjs';

const DT = 1 / 60;

before(() => init());

/** Loads a file without its pictures, which Node cannot decode. */
async function load(bytes, ...plugins) {
  const loader = new GLTFLoader();
  loader.register(() => ({ name: 'NO_PICTURES', loadTexture: () => Promise.resolve(new Texture()) }));
  plugins.forEach((plugin) => loader.register(plugin));
  return loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
}

const meshesOf = (gltf) => {
  const found = [];
  gltf.scene.traverse((object) => object.isSkinnedMesh && found.push(object));
  return found;
};

/** Plays `frames` of the first clip; `place` moves the scene before each. */
function play(gltf, flesh, frames, place = () => {}) {
  const mixer = new AnimationMixer(gltf.scene);
  mixer.clipAction(gltf.animations[0]).play();
  for (let frame = 0; frame < frames; frame++) {
    mixer.setTime(frame * DT);
    place(gltf.scene, frame);
    assert.equal(flesh.update(DT), true);
  }
}

const farthest = (a, b) => a.reduce((most, x, i) => Math.max(most, Math.abs(x - b[i])), 0);

for (const [name, get] of [
  ['the built-in character', () => builtin],
  ['the Fox', () => shared('khronos/Fox.glb')],
  ['CesiumMan', () => shared('khronos/CesiumMan.glb')],
]) {
  test(`${name}: posed by three, the flesh moves as posed by the asset's own clip`, async () => {
    const file = get();
    if (file === undefined) return;
    const gltf = await load(file.glb);
    const asset = new Asset(file.asset);
    const flesh = new SinewCharacter(gltf, asset);
    play(gltf, flesh, 40);
    const own = new Character(asset);
    const rest = own.positions.slice();
    for (let frame = 0; frame < 40; frame++) own.stepClip(0, frame * DT, DT);
    const moved = farthest(own.positions, rest);
    assert.ok(moved > 1e-4 * asset.bodySize, `moved ${moved}`);
    assert.ok(farthest(own.positions, flesh.character.positions) < 0.02 * moved);
    // What three skins is what the runtime skins.
    const skinned = flesh.character.skin().positions;
    const at = new Vector3();
    const meshes = meshesOf(gltf);
    let compared = 0;
    asset.primitives.forEach(({ first, count }, i) => {
      for (let vertex = 0; vertex < count; vertex += 97, compared++) {
        meshes[i].getVertexPosition(vertex, at).applyMatrix4(meshes[i].matrixWorld);
        const there = skinned.subarray(3 * (first + vertex));
        assert.ok(farthest([at.x, at.y, at.z], there) < 1e-4 * asset.bodySize, `mesh ${i}, vertex ${vertex}`);
      }
    });
    assert.ok(compared > 10);
    flesh.dispose();
    own.dispose();
    asset.dispose();
  });
}

test('far away, turned and a hundred times as large, the motion is the same', async () => {
  const results = [];
  for (const [scale, x] of [[1, 0], [100, 0], [0.01, 0], [1, 1e6]]) {
    const gltf = await load(builtin.glb);
    new Group().add(gltf.scene);
    gltf.scene.parent.scale.setScalar(scale);
    const flesh = new SinewCharacter(gltf, builtin.asset);
    const sway = (scene, frame) => scene.position.set(x + 0.125 * Math.floor(frame / 8), 0, 0);
    play(gltf, flesh, 60, sway);
    results.push(flesh.character.positions.slice());
    flesh.dispose();
  }
  const size = new Asset(builtin.asset).bodySize;
  results.slice(1).forEach((result, i) => {
    const apart = farthest(result, results[0]);
    assert.ok(apart < 1e-3 * size, `case ${i + 1}: ${apart / size} body sizes`);
  });
});

test('meshes are given back as they were', async () => {
  const gltf = await load(builtin.glb);
  const meshes = meshesOf(gltf);
  const before = meshes.map(({ geometry, material }) => ({ geometry, material, ...geometry.attributes }));
  const contents = before.map(({ position }) => position.array.slice());
  const automatic = [];
  gltf.scene.traverse((object) => automatic.push(object.matrixAutoUpdate));
  const flesh = new SinewCharacter(gltf, builtin.asset);
  flesh.heatMap = true;
  play(gltf, flesh, 20);
  assert.notEqual(meshes[0].material, before[0].material);
  assert.ok(meshes[0].geometry.attributes.color.array.some((c) => c > 0.1));
  const asBefore = () =>
    meshes.forEach(({ geometry, material }, i) => {
      assert.deepEqual([geometry, material], [before[i].geometry, before[i].material]);
      for (const name of Object.keys(geometry.attributes)) assert.equal(geometry.attributes[name], before[i][name]);
      assert.deepEqual(geometry.attributes.position.array, contents[i]);
    });
  flesh.enabled = false;
  asBefore();
  assert.equal(flesh.update(DT), false);
  flesh.enabled = true;
  assert.notEqual(meshes[0].geometry, before[0].geometry);
  flesh.dispose();
  flesh.dispose();
  asBefore();
  const after = [];
  gltf.scene.traverse((object) => after.push(object.matrixAutoUpdate));
  assert.deepEqual(after, automatic);
  assert.throws(() => flesh.update(DT), /disposed/);
});

test('the loader plugin, the helper, reset, and a recording', async () => {
  const helperRoot = new Scene();
  const gltf = await load(builtin.glb, (parser) => new SinewLoaderPlugin(parser, { asset: async () => builtin.asset, helperRoot }));
  const flesh = gltf.userData.sinew;
  assert.ok(flesh instanceof SinewCharacter);
  assert.equal(flesh.update(0), false);
  flesh.record();
  play(gltf, flesh, 30);
  assert.ok(flesh.stats.microseconds > 0 && flesh.stats.points > 100 && !flesh.stats.held);
  const verdict = flesh.verify(flesh.stopRecording());
  assert.deepEqual([verdict.same, verdict.frames], [true, 30], verdict.message);
  const [helper] = helperRoot.children;
  assert.ok(helper instanceof SinewHelper);
  helper.updateMatrixWorld();
  assert.ok(helper.geometry.attributes.position.array.some((x) => x !== 0));
  flesh.reset();
  const [{ geometry }] = meshesOf(gltf);
  const { first, count } = flesh.asset.primitives[0];
  const rest = new Character(flesh.asset).positions.subarray(3 * first, 3 * (first + count));
  assert.deepEqual(geometry.attributes.position.array, rest.slice());
  helper.dispose();
  flesh.dispose();
});

test('an asset of another file is refused', async () => {
  const fox = shared('khronos/Fox.glb');
  if (fox === undefined) return;
  const gltf = await load(fox.glb);
  assert.throws(() => new SinewCharacter(gltf, builtin.asset), /asset of another file|no skinned mesh/);
});
