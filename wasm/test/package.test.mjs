// The package as npm would publish it, used as others use it: by Node, and by Vite.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { build } from 'vite';

const here = join(import.meta.dirname, '..');
let project;

before(() => {
  project = mkdtempSync(join(tmpdir(), 'sinew-package-'));
  const installed = join(project, 'node_modules/sinew-wasm');
  mkdirSync(installed, { recursive: true });
  const [{ filename }] = JSON.parse(
    execFileSync('npm', ['pack', '--json', '--pack-destination', project], { cwd: here, encoding: 'utf8' }),
  );
  execFileSync('tar', ['-xzf', join(project, filename), '-C', installed, '--strip-components=1']);
  writeFileSync(join(project, 'package.json'), '{ "type": "module" }');
  writeFileSync(join(project, 'index.html'), '<script type="module" src="/main.js"></script>');
  writeFileSync(
    join(project, 'main.js'),
    `import * as sinew from 'sinew-wasm';
     const { init, version } = sinew;
     globalThis.sinew = sinew; // so that the bundle has all of it
     await init();
     const bake = await import('sinew-wasm/bake');
     await bake.init();
     console.log(version(), bake.builtin().regions.length > 0);`,
  );
});

after(() => rmSync(project, { recursive: true, force: true }));

test('Node imports the packed package', () => {
  const printed = execFileSync('node', ['main.js'], { cwd: project, encoding: 'utf8' });
  assert.match(printed, /^\d+\.\d+\.\d+ true\n$/);
});

test('Vite bundles the packed package with every module beside it', async () => {
  await build({
    root: project,
    configFile: false,
    logLevel: 'error',
    build: { target: 'es2022', assetsInlineLimit: 0 },
  });
  const assets = readdirSync(join(project, 'dist/assets'));
  for (const name of ['sinew_scalar_bg', 'sinew_simd_bg', 'bake_bg']) {
    const copies = assets.filter((asset) => asset.startsWith(name) && asset.endsWith('.wasm'));
    assert.equal(copies.length, 1, `${name} among ${assets}`);
  }
  // What a browser downloads for the runtime: one module, and all our JavaScript as the bundler writes it.
  const read = (name) => readFileSync(join(project, 'dist/assets', name));
  const entry = readdirSync(join(project, 'dist/assets')).filter((name) => /^index-.*\.js$/.test(name));
  const module = assets.filter((name) => name.startsWith('sinew_simd_bg'));
  const size = [...entry, ...module].reduce((sum, name) => sum + gzipSync(read(name), { level: 9 }).length, 0);
  console.log(`runtime as bundled, gzip: ${size} of 64000 bytes`);
  assert.ok(entry.length === 1 && size <= 64_000, `${size} bytes in ${entry} and ${module}`);
});
