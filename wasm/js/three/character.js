import { Asset, Character, verify } from '../index.js';
import { Heat } from './heat.js';
import { findJoints, findMeshes } from './match.js';
import { RootFrame } from './root.js';
import { FleshMesh } from './mesh.js';

/** A scale that changes by more than this factor is another character, not a growing one. */
const RESCALED = 2;

export class SinewCharacter {
  #asset;
  #ownsAsset;
  #character;
  #root;
  #joints;
  #meshes;
  #frame = new RootFrame();
  #heat;
  #enabled = true;
  #buffer;

  stats = { microseconds: 0, stepMicroseconds: 0, points: 0, vertices: 0, held: true };

  constructor(gltf, asset) {
    this.#ownsAsset = !(asset instanceof Asset);
    this.#asset = this.#ownsAsset ? new Asset(asset) : asset;
    try {
      this.#root = gltf.scene;
      this.#joints = findJoints(gltf, this.#asset);
      const found = findMeshes(gltf, this.#asset);
      this.#character = new Character(this.#asset);
      this.#meshes = found.map(({ mesh, primitive }) => new FleshMesh(mesh, primitive));
    } catch (error) {
      if (this.#ownsAsset) this.#asset.dispose();
      throw error;
    }
    Object.assign(this.stats, { points: this.#asset.pointCount, vertices: this.#asset.vertexCount });
    this.#meshes.forEach((mesh) => mesh.show());
  }

  get asset() {
    return this.#asset;
  }

  get character() {
    return this.#live();
  }

  get root() {
    return this.#root;
  }

  /** What one unit of the asset is in the world. */
  get unit() {
    return this.#frame.unit;
  }

  #live() {
    if (this.#character === undefined) throw new Error('this SinewCharacter was disposed');
    return this.#character;
  }

  update(delta) {
    const character = this.#live();
    if (delta <= 0 || !this.#enabled) return false;
    const start = performance.now();
    this.#root.updateWorldMatrix(true, true);
    this.#frame.read(this.#root.matrixWorld.elements);
    if (this.#frame.rescaled(RESCALED)) this.setInitState();
    this.#frame.write(character.root);
    const pose = character.pose;
    for (let i = 0; i < this.#joints.length; i++) {
      this.#frame.relative(this.#joints[i].matrixWorld.elements, pose, 12 * i);
    }
    const before = performance.now();
    const advanced = character.step(delta);
    const after = performance.now();
    if (advanced) this.#show();
    this.stats.held = !advanced;
    this.stats.stepMicroseconds = 1000 * (after - before);
    this.stats.microseconds = 1000 * (performance.now() - start);
    return advanced;
  }

  #show() {
    const { positions, normals } = this.#character;
    const moved = positions.buffer !== this.#buffer;
    this.#buffer = positions.buffer;
    for (const mesh of this.#meshes) {
      if (moved) mesh.look(positions, normals);
      mesh.update();
    }
    this.#heat?.update(this.#character.heat());
  }

  reset() {
    this.#live().reset();
    this.#show();
  }

  setInitState() {
    this.#live().settle();
    this.#frame.setUnit(this.#root);
  }

  teleport() {
    this.#live().teleport();
  }

  get enabled() {
    return this.#enabled;
  }

  set enabled(enabled) {
    this.#live();
    if (this.#enabled === Boolean(enabled)) return;
    this.#enabled = Boolean(enabled);
    if (this.#enabled) this.#character.settle();
    for (const mesh of this.#meshes) this.#enabled ? mesh.show() : mesh.hide();
    this.#heat?.[this.#enabled ? 'show' : 'hide']();
  }

  get tunables() {
    return this.#live().tunables;
  }

  set tunables(tunables) {
    this.#live().tunables = tunables;
  }

  get heatMap() {
    return this.#heat !== undefined;
  }

  set heatMap(shown) {
    this.#live();
    if (Boolean(shown) === this.heatMap) return;
    if (shown) {
      this.#heat = new Heat(this.#meshes, this.#asset.vertexCount);
      this.#heat.update(this.#character.heat());
      if (this.#enabled) this.#heat.show();
    } else {
      this.#heat.dispose();
      this.#heat = undefined;
    }
  }

  record(snapshotEvery) {
    this.#live().record(snapshotEvery);
  }

  get recording() {
    return this.#live().recording;
  }

  stopRecording() {
    return this.#live().stopRecording();
  }

  verify(bytes) {
    this.#live();
    return verify(this.#asset, bytes);
  }

  dispose() {
    if (this.#character === undefined) return;
    this.#heat?.dispose();
    this.#meshes.forEach((mesh) => mesh.dispose());
    this.#character.dispose();
    this.#character = undefined;
    if (this.#ownsAsset) this.#asset.dispose();
  }
}
