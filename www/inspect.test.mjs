// Files that the page must refuse, and the words it does it with.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { findBeside } from './src/beside.js';
import { MAX_BYTES, checkSize, inspect } from './src/inspect.js';

const GOOD = { asset: { version: '2.0' }, meshes: [{}], skins: [{}], nodes: [{ mesh: 0, skin: 0 }] };
const json = (value) => new TextEncoder().encode(JSON.stringify(value));

function glb(value, { version = 2, cut = 0, type = 0x4e4f534a } = {}) {
  const chunk = json(value);
  const bytes = new Uint8Array(20 + chunk.length);
  const view = new DataView(bytes.buffer);
  [0x46546c67, version, bytes.length, chunk.length, type].forEach((word, i) => view.setUint32(4 * i, word, true));
  bytes.set(chunk, 20);
  return bytes.subarray(0, bytes.length - cut);
}

test('a rigged model passes, in both forms', () => {
  assert.equal(inspect(json(GOOD), 'a.gltf').meshes.length, 1);
  assert.equal(inspect(glb(GOOD), 'a.glb').meshes.length, 1);
  const shifted = new Uint8Array([0, 0, 0, ...glb(GOOD)]).subarray(3); // a view that does not start a buffer
  assert.equal(inspect(shifted, 'a.glb').meshes.length, 1);
});

const refused = [
  ['nothing', new Uint8Array(), /is empty/, /again/],
  ['text', new TextEncoder().encode('Hello'), /not a glTF/, /“Hello”/],
  ['a picture', new Uint8Array([0x89, 0x50, 0x4e, 0x47, 13, 10]), /not a glTF/, /PNG/],
  ['broken JSON', new TextEncoder().encode('{"asset": {'), /not a glTF/, /damaged/],
  ['other JSON', json({ hello: 1 }), /not a glTF/, /asset\.version/],
  ['a JSON array', new TextEncoder().encode('{}').fill(0x20), /not a glTF/, /starts with/],
  ['glTF 1', json({ ...GOOD, asset: { version: '1.0' } }), /glTF 1\.0/, /2\.0/],
  ['binary glTF 1', glb(GOOD, { version: 1 }), /binary glTF 1/, /2\.0/],
  ['the first bytes', glb(GOOD).subarray(0, 12), /cut short/, /again/],
  ['half a chunk', glb(GOOD, { cut: 5 }), /cut short/, /again/],
  ['another chunk first', glb(GOOD, { type: 7 }), /not a glTF/, /chunk/],
  ['Draco', json({ ...GOOD, extensionsUsed: ['KHR_draco_mesh_compression'] }), /Draco/, /without compression/],
  ['meshopt', glb({ ...GOOD, extensionsUsed: ['EXT_meshopt_compression'] }), /meshopt/, /without compression/],
  ['KTX2', json({ ...GOOD, extensionsRequired: ['KHR_texture_basisu'] }), /KTX2/, /PNG/],
  ['a file beside it', json({ ...GOOD, buffers: [{ uri: 'a%20b.bin' }] }), /needs a%20b\.bin/, /folder/],
  ['no mesh', json({ ...GOOD, meshes: [] }), /no mesh/, /flesh/],
  ['no skin', json({ ...GOOD, skins: [] }), /no skin/, /armature/],
  ['a skin that no mesh has', json({ ...GOOD, nodes: [{ mesh: 0 }] }), /no skin/, /armature/],
];

test('files beside a glTF are found by path, then by name', () => {
  const needy = { ...GOOD, buffers: [{ uri: 'a%20b.bin' }], images: [{ uri: './tex/c.png' }] };
  const beside = new Map([['model/a b.bin', 1], ['other/tex/c.png', 2], ['tex/c.png', 3]]);
  assert.equal(inspect(json(needy), 'a', beside).buffers.length, 1);
  assert.equal(findBeside(beside, 'tex/c.png'), 2, 'the first whose path ends so');
  assert.equal(findBeside(new Map([['x/tex/c.png', 1], ['C.PNG', 2]]), './tex/c.png'), 1, 'a path before a name');
  assert.equal(findBeside(new Map([['C.PNG', 2]]), 'tex/c.png'), 2);
  assert.throws(() => inspect(json(needy), 'a', new Map([['c.png', 1]])), ({ message }) => /needs a%20b\.bin, which/.test(message));
  assert.throws(() => inspect(json(needy), 'a'), ({ message }) => /needs a%20b\.bin and 1 more/.test(message));
});

for (const [what, bytes, message, remedy] of refused) {
  test(`refused: ${what}`, () => {
    assert.throws(() => inspect(bytes, 'a'), (error) => message.test(error.message) && remedy.test(error.remedy));
  });
}

test('refused: too big, before it is read', () => {
  checkSize('a', MAX_BYTES);
  assert.throws(() => checkSize('a', MAX_BYTES + 2 ** 20), /too big: 101 MB/);
});
