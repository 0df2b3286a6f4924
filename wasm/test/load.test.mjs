// Both builds of the runtime, and the second module, in Node.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const read = (path) => readFileSync(new URL(path, import.meta.url));
const { version } = JSON.parse(read('../package.json'));

test('the package chooses a build and loads it', async () => {
  const sinew = await import('sinew-wasm');
  assert.equal(sinew.simd, true, 'Node has SIMD');
  assert.equal(await sinew.init(), await sinew.init(), 'loaded once');
  assert.equal(sinew.version(), version);
});

test('one glue fits both builds', async () => {
  for (const build of ['scalar', 'simd']) {
    // The query makes a second copy of the glue, which holds the instance.
    const glue = await import(`../pkg/sinew.js?${build}`);
    glue.initSync({ module: read(`../pkg/sinew_${build}_bg.wasm`) });
    assert.equal(glue.version(), version, build);
    assert.equal(glue.sum(Uint32Array.from({ length: 1003 }, (_, i) => i)), 502503, build);
  }
});

test('vector instructions are in the SIMD build alone, and none is relaxed', () => {
  const tool = fileURLToPath(new URL('../node_modules/binaryen/bin/wasm-dis', import.meta.url));
  const text = (build) => {
    const module = fileURLToPath(new URL(`../pkg/sinew_${build}_bg.wasm`, import.meta.url));
    return execFileSync(process.execPath, [tool, module], { encoding: 'utf8', maxBuffer: 1 << 28 });
  };
  const [scalar, simd] = [text('scalar'), text('simd')];
  assert.doesNotMatch(scalar, /v128/);
  assert.match(simd, /v128/);
  // Their results depend on the machine.
  assert.doesNotMatch(simd, /relaxed/);
});

test('the second module loads beside the first', async () => {
  const bake = await import('sinew-wasm/bake');
  bake.initSync({ module: read('../pkg/bake/bake_bg.wasm') });
  assert.equal(bake.version(), version);
});
