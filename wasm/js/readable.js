// What `WebAssembly.instantiate` takes, from what a person has.
import { coded } from './error.js';

const addressed = (source) => {
  if (source instanceof URL) return source;
  if (typeof Request === 'function' && source instanceof Request) return source;
  if (typeof source !== 'string') return undefined;
  return URL.canParse?.(source) ? new URL(source) : source; // a relative address is left to `fetch`
};

/** A response, bytes or a module, as they are; an address is fetched, and a file read. */
export async function readable(source) {
  const address = addressed(source);
  if (address === undefined) return source;
  if (address.protocol === 'file:') {
    // Node's fetch does not read files. Not an import: bundlers would look for the package.
    return globalThis.process.getBuiltinModule('node:fs').promises.readFile(address);
  }
  const response = await fetch(address);
  if (!response.ok) throw coded('NOT_LOADED', `${response.url}: cannot be loaded: status ${response.status}`);
  return response;
}

/** Any bytes as a `Uint8Array` over the same memory. */
export function bytesOf(source, what) {
  if (source instanceof Uint8Array) return source;
  if (ArrayBuffer.isView(source)) return new Uint8Array(source.buffer, source.byteOffset, source.byteLength);
  if (source instanceof ArrayBuffer) return new Uint8Array(source);
  if (typeof SharedArrayBuffer === 'function' && source instanceof SharedArrayBuffer) return new Uint8Array(source);
  throw coded('NOT_BYTES', `${what}: expected bytes (a Uint8Array or an ArrayBuffer)`, TypeError);
}
