// The root's frame, and joints in it.
//
// In units of the asset: a model that is shown larger behaves as it did. Joints are taken relative to the
// root in double precision, so that far from the origin costs nothing.
import { Matrix4, Quaternion, Vector3 } from 'three';

const matrix = new Matrix4();
const position = new Vector3();
const rotation = new Quaternion();
const scale = new Vector3();
const meanScale = ({ x, y, z }) => (Math.abs(x) + Math.abs(y) + Math.abs(z)) / 3;

export class RootFrame {
  /** World units in a unit of the asset; fixed, so that a character that grows is felt to grow. */
  unit = undefined;
  #scale = 1;
  #translation = [0, 0, 0];
  #rotation = [0, 0, 0, 1];
  /** Rows of asset-root from world, without the translation. */
  #rows = [1, 0, 0, 0, 1, 0, 0, 0, 1];

  /** Takes the root's `matrixWorld`. */
  read(elements) {
    matrix.fromArray(elements).decompose(position, rotation, scale);
    this.#scale = meanScale(scale) || 1;
    this.unit ??= this.#scale;
    position.toArray(this.#translation);
    rotation.toArray(this.#rotation);
    const r = matrix.makeRotationFromQuaternion(rotation).elements;
    const inverse = 1 / this.unit;
    for (let row = 0; row < 3; row++) {
      for (let column = 0; column < 3; column++) this.#rows[3 * row + column] = r[4 * row + column] * inverse;
    }
  }

  rescaled(factor) {
    return this.#scale > factor * this.unit || factor * this.#scale < this.unit;
  }

  setUnit(root) {
    this.unit = undefined;
    root.updateWorldMatrix(true, false);
    this.read(root.matrixWorld.elements);
  }

  /** Writes a character's root. */
  write(root) {
    for (let i = 0; i < 3; i++) root.translation[i] = this.#translation[i] / this.unit;
    for (let i = 0; i < 4; i++) root.rotation[i] = this.#rotation[i];
  }

  /** Writes a joint's `matrixWorld`, seen from the root, as four columns of three. */
  relative(m, out, at) {
    const [x, y, z] = this.#translation;
    const r = this.#rows;
    for (let column = 0; column < 4; column++) {
      const last = column === 3;
      const a = m[4 * column] - (last ? x : 0);
      const b = m[4 * column + 1] - (last ? y : 0);
      const c = m[4 * column + 2] - (last ? z : 0);
      const to = at + 3 * column;
      out[to] = r[0] * a + r[1] * b + r[2] * c;
      out[to + 1] = r[3] * a + r[4] * b + r[5] * c;
      out[to + 2] = r[6] * a + r[7] * b + r[8] * c;
    }
  }
}
