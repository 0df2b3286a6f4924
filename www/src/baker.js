// Calls the baker in its worker.
let worker;
let last = 0;
const waiting = new Map();

function start() {
  worker = new Worker(new URL('./bake-worker.js', import.meta.url), { type: 'module', name: 'baker' });
  worker.addEventListener('message', ({ data: { id, result, error } }) => {
    const { resolve, reject } = waiting.get(id);
    waiting.delete(id);
    if (error === undefined) resolve(result);
    else reject(new Error(error));
  });
  worker.addEventListener('error', (event) => {
    for (const { reject } of waiting.values()) reject(new Error(event.message || 'the baker could not be loaded'));
    waiting.clear();
    worker.terminate();
    worker = undefined; // a trap leaves the module unusable: the next call begins anew
  });
}

/** @param {Map<string, Uint8Array>} beside files by path @returns {Promise<{ asset: Uint8Array, notes: string[] }>} */
export function bake(bytes, name, beside) {
  if (!worker) start();
  const id = ++last;
  return new Promise((resolve, reject) => {
    waiting.set(id, { resolve, reject });
    worker.postMessage({ id, bytes, name, beside });
  });
}
