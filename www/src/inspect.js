// Looks at a file before anything is spent on it, and says in words why it cannot be used.
import { findBeside, references } from './beside.js';
import { Problem } from './problem.js';

export const MAX_BYTES = 100 * 2 ** 20;
const MAGIC = 0x46546c67; // "glTF"
const JSON_CHUNK = 0x4e4f534a;

/** Extensions that need a decoder which this page does not carry. */
const COMPRESSED = {
  KHR_draco_mesh_compression: 'Draco',
  EXT_meshopt_compression: 'meshopt',
  KHR_meshopt_compression: 'meshopt',
};

export function checkSize(name, bytes) {
  if (bytes === 0) throw new Problem(`${name} is empty`, 'Export it again.');
  if (bytes <= MAX_BYTES) return;
  const size = Math.round(bytes / 2 ** 20);
  throw new Problem(`${name} is too big: ${size} MB`, 'The page takes up to 100 MB. Shrink the textures or split the scene; `sinew bake` has no limit.');
}

/**
 * The JSON of a glTF that can be given flesh.
 * @param {Uint8Array} bytes @param {string} name of the file, for messages
 * @param {Map<string, unknown>} [beside] files handed in with it @throws Problem
 */
export function inspect(bytes, name, beside = new Map()) {
  checkSize(name, bytes.length);
  const gltf = isBinary(bytes) ? binary(bytes, name) : text(bytes, name);
  const version = String(gltf.asset?.version ?? '');
  if (!version) throw notGltf(name, 'it has no asset.version');
  if (!version.startsWith('2')) {
    throw new Problem(`${name} is glTF ${version}`, 'Only glTF 2.0 is read. Export it again from the program it was made with.');
  }
  checkExtensions(gltf, name);
  checkReferences(gltf, name, beside);
  checkSkin(gltf, name);
  return gltf;
}

const isBinary = (bytes) => bytes.length >= 4 && view(bytes).getUint32(0, true) === MAGIC;
const view = (bytes) => new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);

const notGltf = (name, why) =>
  new Problem(`${name} is not a glTF file`, `${why[0].toUpperCase()}${why.slice(1)}. Drop a .glb, a .vrm, or a .gltf with the files beside it.`);

function binary(bytes, name) {
  const truncated = () => new Problem(`${name} is cut short`, 'Part of the file is missing. Copy or export it again.');
  if (bytes.length < 20) throw truncated();
  const data = view(bytes);
  const version = data.getUint32(4, true);
  if (version !== 2) throw new Problem(`${name} is binary glTF ${version}`, 'Only glTF 2.0 is read. Export it again.');
  const length = data.getUint32(12, true);
  if (data.getUint32(8, true) > bytes.length || 20 + length > bytes.length) throw truncated();
  if (data.getUint32(16, true) !== JSON_CHUNK) throw notGltf(name, 'its first chunk is not JSON');
  return parse(bytes.subarray(20, 20 + length), name);
}

function text(bytes, name) {
  const first = new TextDecoder().decode(bytes.subarray(0, 24)).replace(/[^\x20-\x7e]+/g, '·').trim();
  if (!first.replace(/^·/, '').startsWith('{')) throw notGltf(name, `it starts with “${first}”`);
  return parse(bytes, name);
}

function parse(bytes, name) {
  let json;
  try {
    json = JSON.parse(new TextDecoder().decode(bytes));
  } catch (error) {
    throw notGltf(name, `its JSON is damaged: ${error.message}`);
  }
  if (json === null || typeof json !== 'object' || Array.isArray(json)) throw notGltf(name, 'its JSON is no object');
  return json;
}

function checkExtensions(gltf, name) {
  for (const [extension, kind] of Object.entries(COMPRESSED)) {
    if (!(gltf.extensionsUsed ?? []).includes(extension)) continue;
    throw new Problem(`${name} is compressed with ${kind}`, `Export it without compression, or run “npx @gltf-transform/cli copy in.glb out.glb”, which unpacks it.`);
  }
  if ((gltf.extensionsRequired ?? []).includes('KHR_texture_basisu')) {
    throw new Problem(`${name} has KTX2 textures only`, 'Export it with PNG, JPEG or WebP textures.');
  }
}

function checkReferences(gltf, name, beside) {
  const [first, ...others] = references(gltf).filter((uri) => findBeside(beside, uri) === undefined);
  if (!first) return;
  const more = others.length ? ` and ${others.length} more` : '';
  throw new Problem(`${name} needs ${first}${more}, which lies beside it`, 'A page sees only what is dropped: drop the whole folder or all its files at once, or export one .glb.');
}

function checkSkin(gltf, name) {
  if (!(gltf.meshes ?? []).length) throw new Problem(`${name} has no mesh`, 'There is nothing to give flesh to.');
  const skinned = (gltf.nodes ?? []).some((node) => node.mesh !== undefined && node.skin !== undefined);
  if (skinned && (gltf.skins ?? []).length) return;
  throw new Problem(`${name} has no skin`, 'Flesh hangs on bones: bind the mesh to an armature, export it with “skinning” on, and drop it again.');
}
