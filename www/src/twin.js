// A second body from the same file, skinning only: it shows what the flesh adds.
import * as THREE from 'three';
import { clone } from 'three/addons/utils/SkeletonUtils.js';

export class Twin {
  root = new THREE.Group();
  #pairs = [];

  /** @param {THREE.Object3D} scene of a model that has no flesh yet: its geometries stay as they are, and are shared */
  constructor(scene) {
    const copy = clone(scene);
    const originals = [];
    scene.traverse((node) => originals.push(node));
    copy.traverse((node) => {
      this.#pairs.push([originals[this.#pairs.length], node]);
      node.frustumCulled = false;
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
    for (const [, node] of this.#pairs) node.skeleton?.dispose();
  }
}
