import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from 'three';

/**
 * A skinned mesh whose position and normal attributes are written.
 *
 * It gets a geometry of its own, since the loader lets meshes share theirs. All but the two attributes is
 * shared with the geometry that was there, which comes back unharmed.
 */
export class FleshMesh {
  #primitive;
  #position;
  #normal;
  #views = [];

  constructor(mesh, primitive) {
    this.mesh = mesh;
    this.rest = mesh.geometry;
    this.#primitive = primitive;
    this.geometry = new BufferGeometry();
    this.geometry.name = this.rest.name;
    this.geometry.userData = this.rest.userData;
    this.geometry.setIndex(this.rest.index);
    for (const [name, attribute] of Object.entries(this.rest.attributes)) this.geometry.setAttribute(name, attribute);
    this.geometry.morphAttributes = this.rest.morphAttributes;
    this.geometry.morphTargetsRelative = this.rest.morphTargetsRelative;
    this.geometry.groups = this.rest.groups;
    this.geometry.drawRange = this.rest.drawRange;
    this.geometry.boundingBox = this.rest.boundingBox;
    this.geometry.boundingSphere = this.rest.boundingSphere;
    this.#position = this.#own('position');
    if (this.rest.attributes.normal) this.#normal = this.#own('normal');
  }

  /** A copy of an attribute: floats, not interleaved, to be written often. */
  #own(name) {
    const rest = this.rest.attributes[name];
    const array = new Float32Array(3 * rest.count);
    for (let i = 0; i < rest.count; i++) array.set([rest.getX(i), rest.getY(i), rest.getZ(i)], 3 * i);
    const own = new BufferAttribute(array, 3).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute(name, own);
    return own;
  }

  /** Vertices of this mesh in arrays of all vertices. */
  part(array, itemSize) {
    const { first, count } = this.#primitive;
    return array.subarray(itemSize * first, itemSize * (first + count));
  }

  /** Where to read from, until the memory moves. */
  look(positions, normals) {
    this.#views = [this.part(positions, 3), this.part(normals, 3)];
  }

  update() {
    this.#position.array.set(this.#views[0]);
    this.#position.needsUpdate = true;
    if (this.#normal === undefined) return;
    this.#normal.array.set(this.#views[1]);
    this.#normal.needsUpdate = true;
  }

  show() {
    this.mesh.geometry = this.geometry;
  }

  hide() {
    this.mesh.geometry = this.rest;
  }

  dispose() {
    this.hide();
    this.geometry.dispose();
  }
}
