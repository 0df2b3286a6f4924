// Compiled, never run.
import { Asset, Character, floatEnvironment, init, initSync, simd, verify, version } from 'sinew-wasm';
import type { Tunables, Verdict } from 'sinew-wasm';
import * as baker from 'sinew-wasm/bake';
import { SinewCharacter, SinewHelper, SinewLoaderPlugin } from 'sinew-wasm/three';
import { Scene } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

await init();
await init(new URL('x.wasm', import.meta.url));
initSync(new ArrayBuffer(8));
const word: number = floatEnvironment();
const text: string = `${version()} ${simd} ${word}`;

const asset = new Asset(new Uint8Array(8));
const character = new Character(asset);
character.root.translation = [0, 1, 2];
character.tunables = { wind: [1, 0, 0], regions: [{ name: 'belly', gain: 2 }] };
const tunables: Tunables = character.tunables;
const [clip] = asset.clips;
if (clip !== undefined) character.stepClip(clip.name, clip.duration, 1 / 60);
const heat: Float32Array = character.heat(new Float32Array(asset.vertexCount));
const bits: bigint = character.digests.embed;
const verdict: Verdict = verify(asset, character.stopRecording());
// @ts-expect-error: there is no such tunable
character.tunables = { flavour: 1 };
// @ts-expect-error: hashes are told, not set
asset.hash = text;

await baker.init();
const { asset: bytes, notes } = baker.bake(new Uint8Array(), 'fox.glb', { resolve: (uri) => (uri === 'fox.bin' ? heat : undefined) });

const scene = new Scene();
const loader = new GLTFLoader();
loader.register((parser) => new SinewLoaderPlugin(parser, { asset: bytes, helperRoot: scene }));
const gltf = await loader.loadAsync('fox.glb');
const flesh = new SinewCharacter(gltf, asset);
flesh.heatMap = flesh.update(1 / 60);
scene.add(new SinewHelper(flesh, { every: 4 }));
console.log(tunables, bits, verdict.frame ?? verdict.message, notes, flesh.stats.microseconds);
