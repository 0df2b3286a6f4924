// Characters for the tests, baked once.
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import * as baker from 'sinew-wasm/bake';

await baker.init();

/** The project's own character: `{ glb, asset, notes, regions }`. */
export const builtin = baker.builtin();

const data = new URL('../../../shared/data/', import.meta.url);

/** A file of the shared data, baked; `undefined` where a user does not have it. */
export function shared(path) {
  const url = new URL(path, data);
  if (!existsSync(url)) {
    if (process.env.CI === 'true') throw new Error(`${url.pathname} is missing`);
    console.log(`skipped: ${path} is not on this machine`);
    return undefined;
  }
  const glb = readFileSync(url);
  return { glb, ...baker.bake(glb, path) };
}

/** Paths of the shared data's models in one file, in a fixed order; none where a user does not have it. */
export function sharedModels() {
  if (!existsSync(data)) return [];
  const names = readdirSync(data, { recursive: true }).sort();
  const whole = (name) => !/"uri"\s*:\s*"(?!data:)/.test(readFileSync(new URL(name, data), 'latin1'));
  return names.filter((name) => /\.(glb|vrm)$/.test(name) || (name.endsWith('.gltf') && whole(name)));
}
