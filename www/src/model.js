// From bytes to an actor.
import { LoadingManager } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { init } from 'sinew-wasm';
import plumAsset from '../baked/plum.sinew.gz?url';
import plumGlb from '../baked/plum.glb.gz?url';
import { Actor } from './actor.js';
import * as baker from './baker.js';
import { findBeside, references } from './beside.js';
import { checkSize, inspect } from './inspect.js';
import { load } from './load.js';
import { asProblem } from './problem.js';

/**
 * Reads and bakes at the same time; neither needs the other.
 * @param {File} file the model @param {Map<string, File>} files handed in with it, by path @throws Problem
 */
export async function fromFile(file, files) {
  const { name } = file;
  const bytes = await read(file);
  const needed = new Set(references(inspect(bytes, name, files)).map((uri) => findBeside(files, uri)));
  const beside = new Map();
  for (const [path, one] of files) if (needed.has(one)) beside.set(path, await read(one));
  checkSize(name, [bytes, ...beside.values()].reduce((sum, { length }) => sum + length, 0));
  const baking = baker.bake(bytes, name, beside).catch((error) => {
    throw asProblem(error, `${name} cannot be given flesh`);
  });
  const [{ asset, notes }, gltf] = await Promise.all([baking, parse(bytes, name, beside)]);
  return actor({ name, gltf, asset, notes });
}

/** The character that comes with the page, baked when the page was built. @throws Problem */
export async function plum() {
  const reading = load(plumGlb).then((bytes) => parse(bytes, 'Plum'));
  const [gltf, asset] = await Promise.all([reading, load(plumAsset), init()]);
  return actor({ name: 'Plum', gltf, asset, notes: [] });
}

/** The bytes of a file. @param {File} file @throws Problem where it is too big or empty */
export async function read(file) {
  checkSize(file.name, file.size);
  return new Uint8Array(await file.arrayBuffer());
}

async function parse(bytes, name, beside = new Map()) {
  const urls = new Map([...beside].map(([path, file]) => [path, URL.createObjectURL(new Blob([file]))]));
  const manager = new LoadingManager().setURLModifier((url) => findBeside(urls, url) ?? url);
  try {
    // A copy: the loader keeps the buffer, and a glTF in JSON is told apart by its first bytes.
    return await new GLTFLoader(manager).parseAsync(bytes.slice().buffer, '');
  } catch (error) {
    throw asProblem(error, `${name} cannot be read`);
  } finally {
    for (const url of urls.values()) URL.revokeObjectURL(url);
  }
}

function actor(model) {
  try {
    return new Actor(model);
  } catch (error) {
    throw asProblem(error, `${model.name} cannot be shown`);
  }
}
