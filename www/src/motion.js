// Motion of a character's root on top of its clip: dragged, nudged, shaken.
import * as THREE from 'three';

const OMEGA = 17; // rad/s: how eagerly the root follows the hand, critically damped
const SHAKE_SECONDS = 1.3;
const REACH = 2.4; // how far from home the root may go, units
const wanted = new THREE.Vector3();

/** Length of the built-in curve, s. It begins and ends at rest, so that it loops. */
export const CURVE_SECONDS = 4;

/** The built-in curve for models without clips: offset in units at time `t`. */
export function curve(t, out) {
  const u = (t / CURVE_SECONDS) % 1;
  const bell = Math.sin(Math.PI * u) ** 2;
  const hops = Math.max(0, Math.sin(10 * Math.PI * u)) * bell;
  return out.set(0.16 * bell * Math.sin(6 * Math.PI * u), 0.14 * hops, 0.05 * bell * Math.sin(12 * Math.PI * u));
}

export class RootMotion {
  /** World units. */
  offset = new THREE.Vector3();
  unit = 1;
  #target = new THREE.Vector3();
  #velocity = new THREE.Vector3();
  #nudge = new THREE.Vector3();
  #shaking = Infinity;
  #held = null;

  get held() {
    return this.#held !== null;
  }

  /** The hand takes hold; `moved(event)` places it from then on. */
  grab() {
    this.#held = this.#target.clone();
  }

  /** @param {THREE.Vector3} by how far the hand is from where it took hold, world units */
  drag(by) {
    if (!this.#held) return;
    this.#target.copy(this.#held).add(by).clampLength(0, REACH * this.unit);
    this.#target.y = Math.max(0, this.#target.y);
  }

  /** Lets go: the character comes down where it is. */
  release() {
    this.#held = null;
    this.#target.y = 0;
  }

  /** Moves for as long as keys are held: `x`, `z` in -1..1, world axes. */
  nudge(x, z) {
    this.#nudge.set(x, 0, z);
  }

  shake() {
    this.#shaking = 0;
  }

  /** Back home, at once. */
  reset() {
    for (const vector of [this.offset, this.#target, this.#velocity, this.#nudge]) vector.set(0, 0, 0);
    this.#shaking = Infinity;
    this.#held = null;
  }

  /** Goes home in the ordinary way. */
  home() {
    this.#target.set(0, 0, 0);
  }

  update(dt) {
    if (!(dt > 0)) return;
    this.#target.addScaledVector(this.#nudge, 1.5 * this.unit * dt).clampLength(0, REACH * this.unit);
    wanted.copy(this.#target);
    if (this.#shaking < SHAKE_SECONDS) {
      this.#shaking += dt;
      const u = Math.min(1, this.#shaking / SHAKE_SECONDS);
      const size = 0.17 * this.unit * Math.sin(Math.PI * u);
      wanted.x += size * Math.sin(10 * Math.PI * u);
      wanted.y += 0.6 * size * Math.abs(Math.sin(5 * Math.PI * u));
    }
    // Critically damped, exact over any step: x'' = -ω²(x - wanted) - 2ω x'.
    const decay = Math.exp(-OMEGA * dt);
    for (const axis of ['x', 'y', 'z']) {
      const away = this.offset[axis] - wanted[axis];
      const pull = (this.#velocity[axis] + OMEGA * away) * dt;
      this.offset[axis] = wanted[axis] + (away + pull) * decay;
      this.#velocity[axis] = (this.#velocity[axis] - OMEGA * pull) * decay;
    }
  }
}
