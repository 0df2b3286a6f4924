// The declarations hold under `tsc --strict`, and say what is there.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const here = join(import.meta.dirname, '..');

test('a strict TypeScript program compiles', () => {
  const tsc = join(here, 'node_modules/typescript/bin/tsc');
  const flags = ['--strict', '--noEmit', '--exactOptionalPropertyTypes', '--module', 'nodenext', '--target', 'es2022'];
  try {
    execFileSync(process.execPath, [tsc, ...flags, '--skipLibCheck', 'false', 'test/types/use.mts'], { cwd: here, encoding: 'utf8' });
  } catch (error) {
    assert.fail(error.stdout);
  }
});

test('what is declared is exported, and the other way round', async () => {
  for (const [name, module] of [['index', 'sinew-wasm'], ['three/index', 'sinew-wasm/three'], ['bake', 'sinew-wasm/bake']]) {
    const text = readFileSync(join(here, `js/${name}.d.ts`), 'utf8');
    const declared = [...text.matchAll(/^export declare (?:const|function|class) (\w+)/gm)].map((match) => match[1]);
    assert.deepEqual([...new Set(declared)].sort(), Object.keys(await import(module)).sort(), name);
  }
});

test('every member that is declared is there', async () => {
  for (const [name, module] of [['index', 'sinew-wasm'], ['three/index', 'sinew-wasm/three']]) {
    const text = readFileSync(join(here, `js/${name}.d.ts`), 'utf8');
    const classes = await import(module);
    for (const [, type, body] of text.matchAll(/^export declare class (\w+)[^{]*\{\n(.*?)^\}/gms)) {
      const source = classes[type].toString();
      for (const [, member] of body.matchAll(/^ {2}(?:readonly |get |set )*(\w+)[(<:]/gm)) {
        assert.ok(member === 'constructor' || member in classes[type].prototype || source.includes(`${member} =`), `${type}.${member}`);
      }
    }
  }
});
