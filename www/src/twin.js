// A second body from the same file, skinning only: it shows what the flesh adds.
import * as THREE from 'three';
import { clone } from 'three/addons/utils/SkeletonUtils.js';

/** Shares everything but what flesh writes to. */
function untouched(geometry) {
  const copy = new THREE.BufferGeometry();
  copy.setIndex(geometry.index);
  for (const [name, attribute] of Object.entries(geometry.attributes)) {
    copy.setAttribute(name, name === 'position' || name === 'normal' ? attribute.clone() : attribute);
  }
  copy.morphAttributes = geometry.morphAttributes;
  copy.morphTargetsRelative = geometry.morphTargetsRelative;
  for (const { start, count, materialIndex } of geometry.groups) copy.addGroup(start, count, materialIndex);
  return copy;
}

export class Twin {
  root = new THREE.Group();
  #pairs = [];
  #geometries = [];

  /** @param {THREE.Object3D} scene of a model that has no flesh yet */
  constructor(scene) {
    const copy = clone(scene);
    const originals = [];
    scene.traverse((node) => originals.push(node));
    copy.traverse((node) => {
      this.#pairs.push([originals[this.#pairs.length], node]);
      node.frustumCulled = false;
      if (!node.geometry) return;
      node.geometry = untouched(node.geometry);
      this.#geometries.push(node.geometry);
    });
    this.root.add(copy);
    this.root.visible = false;
  }

  /** Takes the pose of the original. */
  follow() {
    if (!this.root.visible) return;
    for (const [from, to] of this.#pairs) {
      to.position.copy(from.position);
      to.quaternion.copy(from.quaternion);
      to.scale.copy(from.scale);
      from.morphTargetInfluences?.forEach((share, i) => { to.morphTargetInfluences[i] = share; });
    }
  }

  dispose() {
    this.root.removeFromParent();
    for (const geometry of this.#geometries) geometry.dispose();
    for (const [, node] of this.#pairs) node.skeleton?.dispose();
  }
}
