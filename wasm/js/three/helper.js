import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments } from 'three';

/** Lines from where skinning alone puts the vertices to where their flesh is. Add it to an object at the origin. */
export class SinewHelper extends LineSegments {
  #flesh;
  #vertices;

  constructor(flesh, { every = 1, color = 0xff4060 } = {}) {
    const vertices = flesh.character.moved.filter((_, i) => i % every === 0);
    const geometry = new BufferGeometry();
    const ends = new BufferAttribute(new Float32Array(6 * vertices.length), 3).setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', ends);
    super(geometry, new LineBasicMaterial({ color, depthTest: false, transparent: true }));
    this.#flesh = flesh;
    this.#vertices = vertices;
    this.frustumCulled = false;
    this.renderOrder = 1e3;
  }

  updateMatrixWorld(force) {
    this.update();
    super.updateMatrixWorld(force);
  }

  update() {
    const { character, root, unit } = this.#flesh;
    if (unit === undefined) return;
    const ends = this.geometry.attributes.position;
    // Both share one buffer in the module: the first is copied out before the second is made.
    [false, true].forEach((flesh, end) => {
      const { positions } = character.skin(flesh);
      this.#vertices.forEach((vertex, i) => {
        for (let c = 0; c < 3; c++) ends.array[6 * i + 3 * end + c] = positions[3 * vertex + c];
      });
    });
    ends.needsUpdate = true;
    root.matrixWorld.decompose(this.position, this.quaternion, this.scale);
    this.scale.setScalar(unit);
  }

  dispose() {
    this.geometry.dispose();
    this.material.dispose();
    this.removeFromParent();
  }
}
