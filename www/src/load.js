// Files that came with the page.
import { Problem } from './problem.js';

const GZIP = 0x1f8b;

/** The bytes of a packed file, whether or not its server said so and the browser has unpacked it. @throws Problem */
export async function load(url) {
  const bytes = await fetched(url).catch((error) => {
    throw new Problem('The character could not be loaded', `${error.message}. Check your connection and load the page again.`);
  });
  if (new DataView(bytes).getUint16(0) !== GZIP) return new Uint8Array(bytes);
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(unpacked).arrayBuffer());
}

async function fetched(url) {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`The server answered ${answer.status}`);
  return answer.arrayBuffer();
}
