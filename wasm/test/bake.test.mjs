// The second module: characters in, assets out.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { Asset, init } from 'sinew-wasm';
import { bake } from 'sinew-wasm/bake';
import { builtin, shared } from './fixture.mjs';

before(() => init());

test('the built-in character is a file that bakes to the same asset', () => {
  assert.ok(builtin.regions.length > 0);
  const again = bake(builtin.glb, 'again.glb');
  const [a, b] = [new Asset(builtin.asset), new Asset(again.asset)];
  assert.deepEqual([b.vertexCount, b.jointCount, b.regions], [a.vertexCount, a.jointCount, a.regions]);
});

test('baking is deterministic, and a recipe changes it', () => {
  const [once, twice] = [bake(builtin.glb, 'a.glb'), bake(builtin.glb, 'a.glb')];
  assert.deepEqual(once.asset, twice.asset);
  const softer = bake(builtin.glb, 'a.glb', { recipe: 'softness = 0.5' });
  assert.notDeepEqual(softer.asset, once.asset);
});

test('files that cannot be used are refused in one line', () => {
  const refused = [
    [() => bake(new Uint8Array(), 'empty.glb'), /^empty\.glb: /],
    [() => bake(new TextEncoder().encode('hello'), 'hello.glb'), /^hello\.glb: /],
    [() => bake(builtin.glb.slice(0, 1000), 'half.glb'), /^half\.glb: /],
    [() => bake(builtin.glb, 'a.glb', { recipe: 'softness = "much"' }), /^recipe: line 1: /],
    [() => bake('a.glb'), /expected bytes/],
  ];
  for (const [call, message] of refused) {
    assert.throws(call, (e) => e instanceof Error && message.test(e.message) && !e.message.includes('\n'), `${call}`);
  }
});

test('files beside a .gltf are asked for', () => {
  const chunk = (at) => builtin.glb.subarray(at + 8, at + 8 + new DataView(builtin.glb.buffer, builtin.glb.byteOffset).getUint32(at, true));
  const text = chunk(12);
  const json = JSON.parse(new TextDecoder().decode(text));
  const binary = chunk(20 + text.length);
  json.buffers[0].uri = 'body%20parts.bin';
  const gltf = new TextEncoder().encode(JSON.stringify(json));
  const whole = bake(gltf, 'split.gltf', { resolve: { 'body parts.bin': binary } });
  assert.equal(new Asset(whole.asset).vertexCount, new Asset(builtin.asset).vertexCount);
  assert.throws(() => bake(gltf, 'split.gltf'), { message: /^split\.gltf: body parts\.bin: the file beside it is missing/ });
  const failing = () => {
    throw new Error('no network');
  };
  assert.throws(() => bake(gltf, 'split.gltf', { resolve: failing }), /is missing/);
});

test('the Fox bakes', () => {
  const fox = shared('khronos/Fox.glb');
  if (fox === undefined) return;
  const asset = new Asset(fox.asset);
  assert.equal(asset.vertexCount, 1728);
  assert.deepEqual(asset.clips.map(({ name }) => name), ['Survey', 'Walk', 'Run']);
});
