// Bakes the character that comes with the page, before the page is built: a visitor need not wait for it, nor
// load the baker for it.
import { mkdirSync, writeFileSync } from 'node:fs';
import { builtin, init } from 'sinew-wasm/bake';

const folder = new URL('./generated/', import.meta.url);
await init();
const { glb, asset, notes } = builtin();
mkdirSync(folder, { recursive: true });
writeFileSync(new URL('plum.glb', folder), glb);
writeFileSync(new URL('plum.sinew', folder), asset);
writeFileSync(new URL('plum.json', folder), `${JSON.stringify({ notes })}\n`);
console.log(`Plum: model ${glb.length} bytes, asset ${asset.length} bytes`);
