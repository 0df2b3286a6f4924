// From bytes to an actor.
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { Actor } from './actor.js';
import * as baker from './baker.js';
import { inspect } from './inspect.js';
import { asProblem } from './problem.js';

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

/** The character that comes with the page. */
export async function builtin() {
  const { glb, asset, notes } = await baker.builtin();
  const gltf = await parse(glb, 'Plum');
  return actor({ name: 'Plum', gltf, asset, notes });
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
