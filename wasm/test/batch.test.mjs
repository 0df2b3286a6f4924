// Many characters in one call.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Asset, Character, init, stepBatch } from 'sinew-wasm';
import { builtin } from './fixture.mjs';

const DT = 1 / 60;

test('a batch is each of its characters alone, and a refused one holds up no other', async () => {
  await init();
  const asset = new Asset(builtin.asset);
  const [crowd, alone] = [0, 1].map(() => Array.from({ length: 4 }, () => new Character(asset)));
  const lay = (character, sway) => {
    for (let joint = 0; joint < asset.jointCount; joint++) character.pose.set([1, 0, 0, 0, 1, 0, 0, 0, 1, sway, 0, 0], 12 * joint);
  };
  for (let frame = 0; frame < 20; frame++) {
    for (const set of [crowd, alone]) set.forEach((character, i) => lay(character, 1e-3 * frame * (i + 1)));
    if (frame === 10) crowd[1].pose[3] = alone[1].pose[3] = NaN;
    const { advanced, refusals } = stepBatch(crowd, DT);
    assert.deepEqual([advanced, refusals.map(({ index }) => index)], frame === 10 ? [3, [1]] : [4, []]);
    alone.forEach((character, i) => {
      if (frame === 10 && i === 1) assert.throws(() => character.step(DT), /joint 0/);
      else character.step(DT);
      assert.deepEqual(crowd[i].digests, character.digests, `character ${i}, frame ${frame}`);
    });
  }
  assert.notDeepEqual(crowd[0].digests, crowd[3].digests);
  for (const character of [...crowd, ...alone]) character.dispose();
});
