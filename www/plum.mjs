// node plum.mjs: bakes the character that the page opens with, so that no visitor waits for it.
import { mkdir, writeFile } from 'node:fs/promises';
import { gzipSync } from 'node:zlib';
import { builtin, init } from 'sinew-wasm/bake';

const FOLDER = new URL('baked/', import.meta.url);

await init();
const { glb, asset } = builtin();
await mkdir(FOLDER, { recursive: true });
// Packed here: servers compress what they know, and these they do not know.
const keep = (name, bytes) => writeFile(new URL(`${name}.gz`, FOLDER), gzipSync(bytes, { level: 9 }));
await Promise.all([keep('plum.glb', glb), keep('plum.sinew', asset)]);
