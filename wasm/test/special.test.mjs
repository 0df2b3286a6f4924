// Values that float code fears, and calls that only JavaScript can make: a code or no harm, and on it goes.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Asset, Character, floatEnvironment, init, stepBatch, verify, version } from 'sinew-wasm';
import { builtin } from './fixture.mjs';

const DT = 1 / 60;
// NaNs (quiet, signalling, payload), infinities, subnormals, the smallest and largest numbers, zero; both signs.
const BITS = [0x7fc00000, 0x7f800001, 0x7fc12345, 0x7f800000, 1, 0x7fffff, 0x800000, 0x7f7fffff, 0];
const WORDS = Uint32Array.from(BITS.flatMap((bits) => [bits, bits | 0x80000000]));
const SPECIAL = [...new Float32Array(WORDS.buffer)];
const SPECIAL64 = [NaN, Infinity, Number.MIN_VALUE, 2 ** -1022, Number.MAX_VALUE, 2 ** 128, 0].flatMap((x) => [x, -x]);
let asset;

const coded = (code) => (error) => {
  assert.ok(error instanceof Error && error.message !== '', `${error}`);
  assert.equal(error.code, code, error.message);
  return true;
};

// The first test: nothing is loaded yet.
test('class 76: calls before init are refused', () => {
  const calls = [() => new Asset(builtin.asset), () => new Character({}), () => floatEnvironment(), () => version()];
  for (const call of calls) assert.throws(call, coded('NOT_LOADED'), `${call}`);
});

const lay = (character) => {
  for (let joint = 0; joint < asset.jointCount; joint++) character.pose.set([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], 12 * joint);
};

/** Does `disturb` to a running character: what it came to. A refusal leaves no trace, anything else none after a reset. */
function midRun(disturb) {
  const [character, fresh] = [new Character(asset), new Character(asset)];
  const frames = (each) => {
    for (let frame = 0; frame < 3; frame++) for (const c of each) c.stepClip(0, frame * DT, DT);
  };
  frames([character, fresh]);
  let came = 'harmless';
  try {
    disturb(character);
  } catch (error) {
    came = error.code ?? `${error}`;
  }
  for (const view of [character.positions, character.normals, character.offsets]) {
    assert.ok(view.every(Number.isFinite), `${came}: not finite`);
  }
  if (came === 'harmless') {
    for (const c of [character, fresh]) {
      c.tunables = fresh.tunables;
      c.setRateDivisor(1);
      c.freeze(false);
      c.reset();
      c.root = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };
    }
  } else {
    character.root = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };
  }
  frames([character, fresh]);
  assert.deepEqual(character.digests, fresh.digests, `${came}: not as a fresh run`);
  character.dispose();
  fresh.dispose();
  return came;
}

const allowed = (came, codes, what) => assert.ok(['harmless', ...codes].includes(came), `${what}: ${came}`);

test('special values in root, pose, times', async () => {
  await init();
  asset = new Asset(builtin.asset);
  assert.equal(floatEnvironment(), 0);
  for (const x of SPECIAL) {
    const posed = (change) => midRun((c) => (lay(c), change(c), c.step(DT)));
    for (let i = 0; i < 12; i++) {
      const came = posed((c) => (c.pose[12 + i] = x));
      allowed(came, ['STEP_BAD_JOINT'], `pose ${i} = ${x}`);
      assert.equal(came === 'harmless', Number.isFinite(x) && Math.abs(x) < 1e7, `pose ${i} = ${x}: ${came}`);
    }
    for (let i = 0; i < 4; i++) allowed(posed((c) => (c.root.rotation[i] = x)), ['STEP_BAD_ROOT'], `rotation ${i} = ${x}`);
    for (const call of [(c) => c.step(x), (c) => c.stepClip(0, DT, x), (c) => c.stepClip(0, x, DT)]) {
      const came = midRun((c) => (lay(c), call(c)));
      assert.equal(came, Number.isFinite(x) ? 'harmless' : 'STEP_TIME_NOT_FINITE', `${call} with ${x}`);
    }
    allowed(midRun((c) => c.warmUp(0, 1, x)), ['STEP_TIME_NOT_FINITE'], `warmUp ${x}`);
    for (const call of [(c) => c.setRateDivisor(x), (c) => c.warmUp(0, x, DT), (c) => c.freeze(x)]) {
      if (Math.abs(x) < 1e9 || !Number.isFinite(x)) allowed(midRun(call), ['STEP_TIME_NOT_FINITE'], `${call} with ${x}`);
    }
  }
  for (const x of SPECIAL64) {
    for (let i = 0; i < 3; i++) {
      const came = midRun((c) => ((c.root.translation[i] = x), c.stepClip(0, DT, DT)));
      assert.equal(came, Number.isFinite(x) ? 'harmless' : 'STEP_BAD_ROOT', `translation ${i} = ${x}`);
    }
  }
});

test('special values in tunables and states', () => {
  const some = new Character(asset);
  const { regions, ...rest } = some.tunables;
  const state = some.saveState();
  some.dispose();
  for (const x of SPECIAL) {
    const run = (c) => {
      for (const dt of [DT, 0.5, 5]) c.stepClip(0, dt, dt);
    };
    for (const [name, value] of Object.entries(rest)) {
      const given = Array.isArray(value) ? [x, 0, x] : x;
      const came = midRun((c) => ((c.tunables = { [name]: given }), run(c)));
      allowed(came, ['TUNABLE_OUT_OF_RANGE'], `${name} = ${x}`);
    }
    for (const name of Object.keys(regions[0]).filter((field) => field !== 'name')) {
      const came = midRun((c) => ((c.tunables = { regions: [{ [name]: x }] }), run(c)));
      allowed(came, ['TUNABLE_OUT_OF_RANGE'], `region ${name} = ${x}`);
    }
    // Pending time, root, tunables, then some of the arrays.
    const places = Array.from({ length: 24 }, (_, i) => (i < 16 ? 28 + 16 * i : 4 * Math.floor(((i - 15) * state.length) / 40)));
    for (const at of places) {
      const changed = state.slice();
      new DataView(changed.buffer).setFloat32(at, x, true);
      const came = midRun((c) => c.loadState(changed));
      allowed(came, ['STATE_DAMAGED'], `state byte ${at} = ${x}`);
    }
  }
});

test('class 77: buffers that lie in the module are read as any other', () => {
  const character = new Character(asset);
  for (let frame = 0; frame < 3; frame++) character.stepClip(0, frame * DT, DT);
  const before = character.digests;
  const state = character.saveState();
  // Bytes of an asset, a state and a replay inside the module's own memory, which grows while they are read.
  const inside = (bytes) => {
    const { buffer, byteOffset } = character.positions;
    const view = new Uint8Array(buffer, byteOffset, bytes.length);
    const saved = view.slice();
    view.set(bytes);
    return { view, restore: () => new Uint8Array(character.positions.buffer, byteOffset, saved.length).set(saved) };
  };
  const small = inside(state.subarray(0, Math.min(state.length, character.positions.byteLength)));
  const code = small.view.length === state.length ? undefined : 'STATE_WRONG_LENGTH';
  if (code === undefined) character.loadState(small.view);
  else assert.throws(() => character.loadState(small.view), coded(code));
  small.restore();
  const head = inside(builtin.asset.subarray(0, character.positions.byteLength));
  assert.throws(() => new Asset(head.view), coded('ASSET_WRONG_LENGTH'));
  assert.throws(() => verify(asset, head.view), coded('REPLAY_BAD_MAGIC'));
  assert.throws(() => new Asset(new Uint8Array(character.positions.buffer)), /ASSET|not a sinew asset/);
  head.restore();
  assert.deepEqual(character.digests, before);
  // A state saved over a view of the module: the caller's own, and no harm to what comes next.
  if (state.length <= character.positions.byteLength) {
    const over = new Uint8Array(character.positions.buffer, character.positions.byteOffset, state.length);
    const kept = over.slice();
    assert.deepEqual(character.saveState(over).slice(), state);
    over.set(kept);
  }
  // One buffer as pose of two characters, and as its own output.
  const other = new Character(asset);
  other.pose.set(character.pose);
  other.pose.set(other.pose);
  other.step(DT);
  character.dispose();
  other.dispose();
});

test('class 78: null, nothing, length 0 and other kinds of things', () => {
  const nothing = [null, undefined, 0, '', {}, [], NaN, true, () => 1, Symbol('s'), 1n];
  for (const thing of nothing) {
    assert.throws(() => new Asset(thing), coded('NOT_BYTES'));
    assert.throws(() => new Character(thing), coded('NOT_AN_ASSET'));
    assert.throws(() => verify(thing, new Uint8Array(0)), coded('NOT_AN_ASSET'));
    assert.throws(() => verify(asset, thing), coded('NOT_BYTES'));
    midRun((c) => c.loadState(thing));
    midRun((c) => c.step(thing));
    midRun((c) => c.stepClip(thing, 0, DT));
    midRun((c) => c.stepClip(0, thing, DT));
    midRun((c) => ((c.tunables = thing), c.stepClip(0, 0, DT)));
    midRun((c) => ((c.root = { translation: thing, rotation: thing }), c.step(DT)));
    midRun((c) => ((c.root.translation = thing), c.step(DT)));
    midRun((c) => c.setRateDivisor(thing));
    midRun((c) => c.freeze(thing));
    midRun((c) => (c.record(thing), c.stopRecording()));
    midRun((c) => c.warmUp(0, thing, DT));
  }
  const empty = new Uint8Array(0);
  assert.throws(() => new Asset(empty), coded('ASSET_TOO_SHORT'));
  assert.throws(() => verify(asset, empty), coded('REPLAY_NO_HEADER'));
  assert.equal(midRun((c) => c.loadState(empty)), 'STATE_WRONG_LENGTH');
  assert.equal(midRun((c) => c.saveState(empty)), 'STATE_WRONG_LENGTH');
  assert.deepEqual(stepBatch([], DT), { advanced: 0, refusals: [] });
  assert.ok(stepBatch([null], DT).refusals.length === 1);
});

test('class 80: what is called from inside a call does no harm', () => {
  const number = (task, value) => ({ valueOf: () => (task(), value) });
  // Getters and valueOf run while a step gathers its numbers: they may step, save, dispose.
  const tasks = [(c) => c.stepClip(0, 0.1, DT), (c) => c.reset(), (c) => (c.tunables = { gain: 2 }), (c) => c.record(0) ?? c.stopRecording()];
  for (const task of tasks) {
    midRun((c) => c.stepClip(0, 0.2, number(() => task(c), DT)));
    midRun((c) => c.stepClip(0, number(() => task(c), 0.2), DT));
    midRun((c) => ((c.root.translation[1] = number(() => task(c), 0.1)), c.step(DT)));
    midRun((c) => ((c.root.rotation[0] = number(() => task(c), 0.1)), c.step(DT)));
    midRun((c) => (c.tunables = { get gain() { return task(c), 1; } }));
  }
  const calls = [
    (c, bad) => c.step(bad),
    (c, bad) => c.stepClip(0, bad, DT),
    (c, bad) => c.warmUp(0, bad, DT),
    (c, bad) => c.setRateDivisor(bad),
    (c, bad) => c.record(bad),
    (c, bad) => ((c.root.translation[2] = bad), c.step(DT)),
  ];
  for (const call of calls) {
    const character = new Character(asset);
    assert.throws(() => call(character, number(() => character.dispose(), 1)), coded('DISPOSED'), `${call}`);
  }
  const gone = new Character(asset);
  assert.throws(() => (gone.tunables = { get gain() { return gone.dispose(), 1; } }));
  const going = new Character(asset);
  const twice = () => ((going.root.translation[0] = number(twice, 0)), going.step(DT));
  assert.throws(twice, RangeError); // the stack ends, the module does not
  going.root.translation[0] = 0;
  lay(going);
  assert.equal(going.step(DT), true);
  going.dispose();
});
