// The runtime: what goes in, what comes out, what is refused, and what is left behind.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { Asset, Character, init, verify } from 'sinew-wasm';
import { builtin } from './fixture.mjs';

const DT = 1 / 60;
let asset;

before(async () => {
  await init();
  asset = new Asset(builtin.asset);
});

const run = (character, frames, clip = 0) => {
  for (let frame = 0; frame < frames; frame++) character.stepClip(clip, frame * DT, DT);
};

test('an asset tells what it is', () => {
  assert.match(asset.hash, /^[0-9a-f]{16}$/);
  assert.ok(asset.vertexCount > 1000 && asset.pointCount > 100 && asset.bodySize > 0);
  assert.equal(asset.jointNodes.length, asset.jointCount);
  assert.deepEqual(asset.regions, builtin.regions);
  assert.ok(asset.clips.length > 0 && asset.clips.every(({ name, duration }) => name !== '' && duration > 0));
  assert.equal(asset.primitives.reduce((sum, { count }) => sum + count, 0), asset.vertexCount);
});

test('flesh moves, and only where it is', () => {
  const character = new Character(asset);
  const rest = character.positions.slice();
  run(character, 30);
  const moved = new Set(character.moved);
  let farthest = 0;
  character.positions.forEach((x, i) => {
    const distance = Math.abs(x - rest[i]);
    if (!moved.has(Math.floor(i / 3))) assert.equal(distance, 0, `vertex ${Math.floor(i / 3)}`);
    farthest = Math.max(farthest, distance);
  });
  assert.ok(farthest > 1e-3 * asset.bodySize, `${farthest}`);
  const heat = character.heat(new Float32Array(asset.vertexCount));
  assert.ok(heat.every((h) => h >= 0 && h <= 1.0001) && Math.max(...heat) > 0.01);
  assert.notDeepEqual(character.skin(true).positions.slice(), character.skin(false).positions.slice());
  character.dispose();
});

test('a pose filled in gives what the same clip gives', () => {
  const [posed, still] = [new Character(asset), new Character(asset)];
  for (let joint = 0; joint < asset.jointCount; joint++) posed.pose.set([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], 12 * joint);
  assert.equal(posed.step(DT), true);
  posed.pose.forEach((_, i) => i % 12 === 9 && (posed.pose[i] += 0.2 * asset.bodySize));
  assert.equal(posed.step(DT), true);
  assert.notEqual(posed.digests.dynamics, still.digests.dynamics);
  posed.dispose();
  still.dispose();
});

test('time that does not pass changes nothing', () => {
  const character = new Character(asset);
  run(character, 5);
  const { digests } = character;
  for (const dt of [0, -1]) assert.equal(character.stepClip(0, 1, dt), false);
  assert.deepEqual(character.digests, digests);
  character.dispose();
});

test('what is refused is told, and changes nothing', () => {
  const character = new Character(asset);
  run(character, 5);
  const { digests } = character;
  const refused = [
    [() => character.stepClip(0, 0, NaN), /dt is not a finite number/],
    [() => character.stepClip(0, 0), /dt is not a finite number/],
    [() => character.stepClip(999, 0, DT), /no clip 999/],
    [() => character.stepClip(-1, 0, DT), /no clip -1/],
    [() => character.stepClip('no such', 0, DT), /no clip "no such"/],
    [() => (character.tunables = { gustRate: -1 }), /`gustRate` is out of its range/],
    [() => (character.tunables = { settle_after: NaN }), /`settleAfter` is out of its range/],
    [() => (character.tunables = { wind: [0, Infinity, 0] }), /`wind` is out of its range/],
    [() => (character.tunables = { gain: '3' }), /`gain` is not a number/],
    [() => (character.tunables = { gravity: [1, 2] }), /`gravity` is not an array of three/],
    [() => (character.tunables = { flavour: 1 }), /no tunable `flavour`/],
    [() => (character.tunables = { regions: [{ name: 'wing', gain: 1 }] }), /no region `wing`/],
    [() => (character.tunables = { regions: [{ damping: -1 }] }), /`damping` of region 0/],
    [() => character.loadState(new Uint8Array(7)), /state has 7 bytes, \d+ are needed/],
    [() => character.saveState(new Uint8Array(7)), /state has \d+ bytes, the buffer given 7/],
    [() => character.stopRecording(), /nothing is being recorded/],
    [() => verify(asset, new Uint8Array(8)), /not a sinew replay/],
    [() => new Asset(new Uint8Array(40)), /not a sinew asset/],
    [() => new Asset(builtin.asset.slice(0, -1)), /bytes/],
    [() => new Asset('fox'), /expected bytes/],
    [() => new Character({}), /expected an Asset/],
  ];
  for (const [call, message] of refused) assert.throws(call, (e) => e instanceof Error && message.test(e.message), `${call}`);
  character.pose[5] = NaN;
  assert.throws(() => character.step(DT), /joint 0 is not finite/);
  character.root.translation[1] = NaN;
  assert.throws(() => character.stepClip(0, 0, DT), /root/);
  assert.deepEqual(character.digests, digests);
  character.dispose();
});

test('tunables are read, changed in part, and felt', () => {
  const [soft, stiff] = [new Character(asset), new Character(asset)];
  const before = stiff.tunables;
  stiff.tunables = { frequency: 4, regions: [{ name: asset.regions[0], maxOffset: 0.05 }] };
  assert.equal(stiff.tunables.frequency, 4);
  assert.ok(Math.abs(stiff.tunables.regions[0].maxOffset - 0.05) < 1e-6);
  assert.deepEqual(stiff.tunables.gravity, before.gravity);
  stiff.tunables = before;
  assert.deepEqual(stiff.tunables, before);
  stiff.tunables = { wind: [0, 0, 8] };
  run(soft, 30);
  run(stiff, 30);
  assert.notEqual(soft.digests.dynamics, stiff.digests.dynamics);
  soft.dispose();
  stiff.dispose();
});

test('a saved state goes on bit for bit', () => {
  const character = new Character(asset);
  run(character, 20);
  const state = character.saveState(new Uint8Array(character.stateLength));
  run(character, 20);
  const { digests } = character;
  const other = new Character(asset);
  other.loadState(state);
  run(other, 20);
  assert.deepEqual(other.digests, digests);
  state[state.length >> 1] ^= 1;
  assert.throws(() => other.loadState(state), /damaged/);
  character.dispose();
  other.dispose();
});

test('a replay verifies, and a changed one does not', () => {
  const character = new Character(asset);
  character.record(10);
  assert.equal(character.recording, true);
  assert.throws(() => character.record(), /already recording/);
  assert.throws(() => character.warmUp(0, 1, DT), /warm up before/);
  run(character, 30);
  character.tunables = { gain: 2 };
  character.root.translation[0] = 0.1 * asset.bodySize;
  run(character, 30);
  character.teleport();
  character.reset();
  const replay = character.stopRecording();
  const verdict = verify(asset, replay);
  assert.deepEqual([verdict.same, verdict.frames], [true, 60], verdict.message);
  let caught = 0;
  for (let at = 0; at < replay.length; at += 1009) {
    const changed = replay.slice();
    changed[at] ^= 16;
    try {
      assert.equal(verify(asset, changed).same, false, `byte ${at}`);
    } catch (error) {
      assert.doesNotMatch(error.message, /unreachable/, `byte ${at}`);
      if (error.code === 'ERR_ASSERTION') throw error;
    }
    caught++;
  }
  assert.ok(caught > 10);
  character.dispose();
});

test('views follow the memory as it grows', () => {
  const character = new Character(asset);
  character.pose.set([1, 0, 0, 0, 1, 0, 0, 0, 1, 0.25, 0, 0]);
  run(character, 3);
  const before = character.positions;
  const content = before.slice();
  const crowd = [];
  while (before.length > 0) crowd.push(new Character(asset));
  assert.deepEqual(character.positions.slice(), content);
  assert.equal(character.pose[9], 0.25);
  crowd.forEach((other) => other.dispose());
  character.dispose();
});

test('dispose is final, and harmless twice', () => {
  const own = new Asset(builtin.asset);
  const character = new Character(own);
  own.dispose();
  own.free();
  assert.throws(() => own.hash, /disposed/);
  run(character, 3); // keeps what it needs
  character.dispose();
  character.dispose();
  character.free();
  for (const call of [() => character.step(DT), () => character.positions, () => character.tunables, () => character.reset()]) {
    assert.throws(call, /this Character was disposed/);
  }
});

test('20,000 characters come and go in the same memory', () => {
  const cycle = () => {
    const own = new Asset(builtin.asset);
    const character = new Character(own);
    character.stepClip(0, 0, DT);
    const { buffer } = character.positions;
    character.dispose();
    own.dispose();
    return buffer.byteLength;
  };
  // An asset is checked byte by byte: most cycles share one.
  for (let i = 0; i < 20; i++) cycle();
  const settled = cycle();
  for (let i = 0; i < 500; i++) assert.equal(cycle(), settled, `asset ${i}`);
  for (let i = 0; i < 20_000; i++) {
    const character = new Character(asset);
    if (i % 1000 === 0) assert.equal(character.positions.buffer.byteLength, settled, `character ${i}`);
    character.dispose();
  }
});

test('steps leave no garbage but boxed numbers', { skip: globalThis.gc === undefined && 'needs --expose-gc' }, () => {
  const character = new Character(asset);
  const frames = 5000;
  run(character, 200);
  const { byteLength } = character.positions.buffer;
  globalThis.gc();
  const before = process.memoryUsage().heapUsed;
  run(character, frames);
  const grown = process.memoryUsage().heapUsed - before;
  // An array a step would be 100 bytes at least.
  assert.ok(grown < 80 * frames, `${grown / frames} bytes a frame`);
  assert.equal(character.positions.buffer.byteLength, byteLength);
  character.dispose();
});

test('scalar and SIMD builds give the same bits', async () => {
  const frames = 300;
  const digests = (build) =>
    new Promise((resolve, reject) => {
      const workerData = { build, frames, bytes: builtin.asset };
      const worker = new Worker(new URL('./digests.worker.mjs', import.meta.url), { workerData });
      worker.once('message', resolve).once('error', reject);
    });
  const [scalar, simd] = await Promise.all([digests('scalar'), digests('simd')]);
  assert.equal(scalar.length, frames);
  scalar.forEach((digest, frame) => assert.deepEqual(digest, simd[frame], `frame ${frame}`));
  assert.notDeepEqual(scalar[0], scalar[frames - 1]);
});
