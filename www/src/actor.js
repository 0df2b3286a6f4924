// What stands on the stage: a model, its clips, its flesh, and its twin without.
import * as THREE from 'three';
import { SinewCharacter } from 'sinew-wasm/three';
import { CURVE_SECONDS, curve } from './motion.js';
import { Twin } from './twin.js';

const FADE_SECONDS = 0.3;
const SAMPLES = 6;
/** The name of a clip without what some exporters put before it: `Armature|Walk_Slow`. */
const called = ({ name }, i) => name.split('|').at(-1).replaceAll('_', ' ').trim() || `Clip ${i + 1}`;
const mean = new THREE.Vector3();
const at = new THREE.Vector3();

export class Actor {
  root = new THREE.Group();
  /** Size of the first clip's poses: half the diagonal of their box, world units. */
  unit = 1;
  #action = null;
  #time = 0;
  #bones = [];
  #anchor = new THREE.Vector3();
  #center = new THREE.Vector3();

  /** @param {{ name: string, gltf: object, asset: Uint8Array, notes: string[] }} model */
  constructor({ name, gltf, asset, notes }) {
    Object.assign(this, { name, notes, assetBytes: asset, model: gltf.scene });
    if (gltf.parser?.json.extensions?.VRM) this.model.rotation.y = Math.PI; // VRM 0 looks the other way
    this.root.add(this.model);
    this.model.traverse((node) => this.#prepare(node));
    this.twin = new Twin(this.model);
    this.mixer = new THREE.AnimationMixer(this.model);
    this.animations = gltf.animations;
    this.clips = [...gltf.animations.map(called), 'Built-in shake'];
    this.box = this.#measure();
    this.character = new SinewCharacter(gltf, asset);
    this.asset = this.character.asset;
    this.play(0);
  }

  #prepare(node) {
    if (node.isBone) this.#bones.push(node);
    if (!node.isMesh) return;
    Object.assign(node, { castShadow: true, receiveShadow: true, frustumCulled: false });
  }

  /** The box of the first clip's poses, gathered above one place so that a walk does not make it long. */
  #measure() {
    const action = this.animations[0] && this.mixer.clipAction(this.animations[0]).play();
    const box = new THREE.Box3();
    const pose = new THREE.Box3();
    const first = new THREE.Vector3();
    for (let i = 0; i < (action ? SAMPLES : 1); i++) {
      if (action) this.mixer.setTime((i / SAMPLES) * this.animations[0].duration);
      this.root.updateMatrixWorld(true);
      pose.setFromObject(this.root, true);
      this.#mean(mean);
      if (i === 0) first.copy(mean);
      box.union(pose.translate(at.set(first.x - mean.x, 0, first.z - mean.z)));
    }
    this.mixer.stopAllAction();
    this.root.updateMatrixWorld(true);
    this.unit = box.getSize(at).length() / 2;
    box.getCenter(this.#center);
    this.#anchor.subVectors(this.#center, first);
    return box;
  }

  #mean(out) {
    out.set(0, 0, 0);
    for (const bone of this.#bones) out.add(at.setFromMatrixPosition(bone.matrixWorld));
    return this.#bones.length ? out.divideScalar(this.#bones.length) : out.copy(this.root.position);
  }

  /** Plays the clip of that index; the one after the file's own is the built-in curve. */
  play(index) {
    this.clip = index;
    const clip = this.animations[index];
    const before = this.#action;
    this.#action = clip ? this.mixer.clipAction(clip).reset().play() : null;
    this.#time = 0;
    if (!before || before === this.#action) return;
    if (this.#action) this.#action.crossFadeFrom(before, FADE_SECONDS, false);
    else before.fadeOut(FADE_SECONDS);
  }

  /**
   * @param {number} clipDelta s by which the clip goes on
   * @param {number} delta s by which everything else does
   * @param {THREE.Vector3} offset of the root, world units
   */
  update(clipDelta, delta, offset) {
    this.mixer.update(clipDelta);
    this.#time += clipDelta;
    this.root.position.copy(offset);
    if (this.clip === this.animations.length) {
      this.root.position.addScaledVector(curve(this.#time % CURVE_SECONDS, at), this.unit);
    }
    this.root.updateMatrixWorld(true);
    this.character.update(delta);
    this.twin.follow();
    this.twin.root.position.copy(this.root.position).x -= this.spacing;
    this.#mean(mean).sub(this.root.position).add(this.#anchor);
    this.#center.lerp(mean, 1 - Math.exp(-4 * delta));
  }

  /** Where the camera should look: goes with the clip, not with the hand. */
  center(out) {
    out.copy(this.#center);
    if (this.side) out.x -= this.spacing / 2;
    return out;
  }

  /** How far apart the two bodies stand. */
  get spacing() {
    const size = this.box.getSize(at);
    return Math.max(1.12 * size.x, 0.7 * size.z);
  }

  get side() {
    return this.twin.root.visible;
  }

  set side(shown) {
    this.twin.root.visible = shown;
  }

  /** The box that should be in view. */
  frame() {
    const box = this.box.clone().translate(this.#center).translate(this.box.getCenter(at).negate());
    [box.min.y, box.max.y] = [this.box.min.y, this.box.max.y];
    if (this.side) box.min.x -= this.spacing;
    return box;
  }

  /** Ground points below the bodies. */
  feet() {
    const foot = (shift) => ({
      x: this.#center.x + this.root.position.x + shift,
      z: this.#center.z + this.root.position.z,
      height: this.root.position.y,
    });
    return this.side ? [foot(0), foot(-this.spacing)] : [foot(0)];
  }

  /** True where the ray meets the body; fills `point`. */
  hit(raycaster, point) {
    const bodies = this.side ? [this.root, this.twin.root] : [this.root];
    const [first] = raycaster.intersectObjects(bodies, true).filter(({ object }) => object.isMesh);
    if (first) point.copy(first.point);
    return Boolean(first);
  }

  dispose() {
    this.character.dispose();
    this.twin.dispose();
    this.mixer.stopAllAction();
    this.root.removeFromParent();
    this.model.traverse((node) => {
      node.geometry?.dispose();
      node.skeleton?.dispose();
      for (const material of [node.material ?? []].flat()) {
        // Their bitmaps stay open: the renderer's material of shadows may still ask for the last one.
        for (const value of Object.values(material)) if (value?.isTexture) value.dispose();
        material.dispose();
      }
    });
  }
}
