// One hash on every target: the constants of tests/target/src/golden.rs, baked, played and verified under wasm.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

const source = readFileSync(new URL('../../tests/target/src/golden.rs', import.meta.url), 'utf8');
const constant = (name) => source.match(new RegExp(`pub const ${name}: u64 = 0x([0-9a-f_]+);`))[1].replaceAll('_', '');

/** The frames of golden.rs: every number is exact in binary. */
const script = (build) => `
  import { readFileSync } from 'node:fs';
  import { init, Asset, Character, verify } from 'sinew-wasm';
  import * as bake from 'sinew-wasm/bake';
  await init(readFileSync('pkg/sinew_${build}_bg.wasm'));
  await bake.init();
  const asset = new Asset(bake.builtin().asset);
  const character = new Character(asset);
  character.record(120);
  for (let i = 0; i < 600; i++) {
    const part = (k, n) => ((i * k) % n) / 256;
    character.root = {
      translation: [part(5, 64), part(7, 32), -part(1, 128)],
      rotation: [0, part(3, 64) - 0.125, 0, 1],
    };
    character.stepClip(Math.floor(i / 150), (i % 96) / 64, 1 / 64);
  }
  const verdict = verify(asset, character.stopRecording());
  console.log(JSON.stringify({ asset: asset.hash, ...verdict }));
`;

for (const build of ['scalar', 'simd']) {
  test(`the golden replay holds in the ${build} build`, () => {
    const options = { cwd: new URL('..', import.meta.url), encoding: 'utf8' };
    const text = execFileSync(process.execPath, ['--input-type=module', '--eval', script(build)], options);
    const { asset, same, frames, digest } = JSON.parse(text);
    assert.deepEqual(
      { asset, digest, same, frames },
      { asset: constant('ASSET'), digest: constant('REPLAY'), same: true, frames: 600 },
    );
  });
}
