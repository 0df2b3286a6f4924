// The script that verifies a replay: what it exits with.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Asset, Character, init } from 'sinew-wasm';
import { builtin } from './fixture.mjs';

let folder;
let replay;
const run = (...args) => spawnSync(process.execPath, [join(import.meta.dirname, '../verify.mjs'), ...args], { cwd: folder, encoding: 'utf8' });

before(async () => {
  await init();
  folder = mkdtempSync(join(tmpdir(), 'sinew-verify-'));
  const character = new Character(new Asset(builtin.asset));
  character.record(10);
  for (let frame = 0; frame < 20; frame++) character.stepClip(0, frame / 60, 1 / 60);
  replay = character.stopRecording();
  writeFileSync(join(folder, 'a.sinew'), builtin.asset);
  writeFileSync(join(folder, 'a.replay'), replay);
});

after(() => rmSync(folder, { recursive: true, force: true }));

test('0 where both builds agree with the recording', () => {
  for (const flags of [[], ['--scalar']]) {
    const { status, stdout } = run('a.replay', 'a.sinew', ...flags);
    assert.equal(status, 0);
    assert.match(stdout, /^a\.replay: 20 frames, the same, digest [0-9a-f]{16}\n$/);
  }
});

test('1 where a frame differs, and it is named', () => {
  const changed = replay.slice();
  // The first digest of the first step: behind tag, dt, root, clip and what the step returned.
  const at = Buffer.from(replay).indexOf('clip') + 4 + 8 + 44 + 12 + 12;
  changed[at] ^= 1;
  writeFileSync(join(folder, 'changed.replay'), changed);
  const { status, stdout } = run('changed.replay', 'a.sinew');
  assert.equal(status, 1);
  assert.match(stdout, /frame 0/);
});

test('2 where a file is not usable', () => {
  assert.equal(run('a.replay').status, 2);
  assert.equal(run('none.replay', 'a.sinew').status, 2);
  const { status, stderr } = run('a.sinew', 'a.sinew');
  assert.equal(status, 2);
  assert.match(stderr, /not a sinew replay/);
});
