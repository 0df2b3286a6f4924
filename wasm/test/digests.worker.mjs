// Runs one build of the runtime in a thread of its own; posts the digests of every frame.
import { readFileSync } from 'node:fs';
import { parentPort, workerData } from 'node:worker_threads';
import { Asset, Character, initSync } from 'sinew-wasm';

const { build, frames, bytes } = workerData;
initSync(readFileSync(new URL(`../pkg/sinew_${build}_bg.wasm`, import.meta.url)));
const character = new Character(new Asset(bytes));
character.tunables = { wind: [1, 0, 2], gust: 0.7 };
const digests = [];
for (let frame = 0; frame < frames; frame++) {
  character.root.translation[0] = 0.01 * (frame % 50);
  character.stepClip(0, frame / 60, frame % 7 === 0 ? 1 / 30 : 1 / 60);
  digests.push(character.digests);
}
parentPort.postMessage(digests);
