// The program of every target as a WebAssembly module: the same lines in Node and in a browser.

/** What the program prints: `module` and `files` (asset, replay) as bytes. */
export async function run(module, files) {
  const { instance } = await WebAssembly.instantiate(module, {});
  const { memory, room, run: start, text } = instance.exports;
  // Making room moves the memory: only then is it looked at.
  files.forEach((bytes, i) => {
    const at = room(i, bytes.length);
    new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
  });
  const length = start();
  return new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length));
}

export const NAMES = ['target.wasm', 'golden.sinew', 'golden.replay'];
