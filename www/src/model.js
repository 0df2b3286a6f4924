// From bytes to an actor.
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import plumModel from '../generated/plum.glb?url';
import plumAsset from '../generated/plum.sinew?url';
import { notes as plumNotes } from '../generated/plum.json';
import { Actor } from './actor.js';
import * as baker from './baker.js';
import { inspect } from './inspect.js';
import { Problem, asProblem } from './problem.js';

const loader = new GLTFLoader();

/** Reads and bakes at the same time; neither needs the other. @throws Problem */
export async function fromFile(bytes, name) {
  inspect(bytes, name);
  const baking = baker.bake(bytes, name).catch((error) => {
    throw asProblem(error, `${name} cannot be given flesh`);
  });
  const [{ asset, notes }, gltf] = await Promise.all([baking, parse(bytes, name)]);
  return actor({ name, gltf, asset, notes });
}

/** The character that comes with the page, baked when that was built. */
export async function builtin() {
  const [gltf, asset] = await Promise.all([fetched(plumModel).then((glb) => parse(glb, 'Plum')), fetched(plumAsset)]);
  return actor({ name: 'Plum', gltf, asset, notes: plumNotes });
}

async function fetched(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Problem('The character that comes with the page is missing', `${url}: ${response.status}. Build the page again.`);
  return new Uint8Array(await response.arrayBuffer());
}

async function parse(bytes, name) {
  try {
    // A copy: the loader keeps the buffer, and a glTF in JSON is told apart by its first bytes.
    return await loader.parseAsync(bytes.slice().buffer, '');
  } catch (error) {
    throw asProblem(error, `${name} cannot be read`);
  }
}

function actor(model) {
  try {
    return new Actor(model);
  } catch (error) {
    throw asProblem(error, `${model.name} cannot be shown`);
  }
}
