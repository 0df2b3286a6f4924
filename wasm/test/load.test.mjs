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
    assert.equal(glue.floatEnvironment(), 0, build);
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
  assert.throws(() => bake.bake(new Uint8Array(), 'x.glb'), /init/);
  await bake.init();
  await bake.init();
});

test('init takes an address, a response, bytes, a module and promises of them', () => {
  const sources = {
    URL: `new URL('./pkg/sinew_scalar_bg.wasm', root)`,
    string: `new URL('./pkg/sinew_scalar_bg.wasm', root).href`,
    bytes: `fs.readFileSync(file)`,
    buffer: `new Uint8Array(fs.readFileSync(file)).buffer`,
    module: `new WebAssembly.Module(fs.readFileSync(file))`,
    promise: `fs.promises.readFile(file)`,
    response: `new Response(fs.readFileSync(file), { headers: { 'Content-Type': 'application/wasm' } })`,
  };
  const root = new URL('../', import.meta.url).href;
  for (const [name, source] of Object.entries(sources)) {
    // A process each: a module is loaded once.
    const program = `import fs from 'node:fs';
      import { init, version } from ${JSON.stringify(new URL('../js/index.js', import.meta.url).href)};
      const root = ${JSON.stringify(root)}, file = new URL('./pkg/sinew_scalar_bg.wasm', root);
      await init(${source});
      console.log(version());`;
    const printed = execFileSync(process.execPath, ['--input-type=module', '-e', program], { encoding: 'utf8' });
    assert.equal(printed.trim(), version, name);
  }
});

test('a failed init tells why and can be tried again', () => {
  const program = `import { init, version } from ${JSON.stringify(new URL('../js/index.js', import.meta.url).href)};
    await init('file:///no/such.wasm').then(() => console.log('?'), ({ message }) => console.log(message));
    try { version(); } catch ({ message }) { console.log(message); }
    await init();
    console.log(version());`;
  const printed = execFileSync(process.execPath, ['--input-type=module', '-e', program], { encoding: 'utf8' });
  const [missing, early, last] = printed.trim().split('\n');
  assert.match(missing, /no such file/);
  assert.match(early, /call `await init\(\)` first/);
  assert.equal(last, version);
});
