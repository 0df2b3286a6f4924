// The baker, in a thread of its own, so that the page stays alive meanwhile.
import { bake, init } from 'sinew-wasm/bake';
import { findBeside } from './beside.js';

const ready = init();

addEventListener('message', async ({ data: { id, bytes, name, beside } }) => {
  try {
    await ready;
    postMessage({ id, result: bake(bytes, name, { resolve: (uri) => findBeside(beside, uri) }) });
  } catch (error) {
    postMessage({ id, error: error?.message ?? String(error) });
  }
});
