import { RawCharacter } from '../pkg/sinew.js';
import { Asset, clipIndex, rawOf } from './asset.js';
import { coded } from './error.js';
import { apart, memory } from './load.js';
import { bytesOf } from './readable.js';
import { named, toTunables, writeTunables } from './tunables.js';

/** Whether a step advanced. It is told as a number: see `RawCharacter::step`. */
function told(raw, code) {
  if (code === 2) raw.refusal();
  return code === 1;
}

export class Character {
  #raw;
  #asset;
  #root = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };
  #views = {};

  constructor(asset) {
    memory();
    if (!(asset instanceof Asset)) throw coded('NOT_AN_ASSET', 'new Character(asset): expected an Asset', TypeError);
    this.#raw = new RawCharacter(rawOf(asset));
    const { jointCount, vertexCount, pointCount, regions, clips, moved } = asset;
    this.#asset = { jointCount, vertexCount, pointCount, regions, clips, moved };
  }

  #live() {
    if (this.#raw === undefined) throw coded('DISPOSED', 'this Character was disposed');
    return this.#raw;
  }

  /** A view of the module's memory, made anew only after that has grown. */
  #view(name, address, length) {
    const { buffer } = memory();
    const known = this.#views[name];
    if (known !== undefined && known.buffer === buffer) return known;
    return (this.#views[name] = new Float32Array(buffer, address, length));
  }

  get pose() {
    return this.#view('pose', this.#live().pose(), 12 * this.#asset.jointCount);
  }

  get positions() {
    return this.#view('positions', this.#live().positions(), 3 * this.#asset.vertexCount);
  }

  get normals() {
    return this.#view('normals', this.#live().normals(), 3 * this.#asset.vertexCount);
  }

  get offsets() {
    return this.#view('offsets', this.#live().offsets(), 3 * this.#asset.pointCount);
  }

  get moved() {
    this.#live();
    return this.#asset.moved;
  }

  get root() {
    return this.#root;
  }

  set root({ translation, rotation }) {
    this.#root = { translation, rotation };
  }

  // Numbers are made of what is given before the handle is taken: `valueOf` may do anything, dispose of it too.
  step(dt) {
    const { translation: t, rotation: r } = this.#root;
    const x = +t[0], y = +t[1], z = +t[2];
    const a = +r[0], b = +r[1], c = +r[2], d = +r[3], time = +dt;
    const raw = this.#live();
    return told(raw, raw.step(x, y, z, a, b, c, d, time));
  }

  stepClip(clip, time, dt) {
    const { translation: t, rotation: r } = this.#root;
    const at = +time, x = +t[0], y = +t[1], z = +t[2];
    const a = +r[0], b = +r[1], c = +r[2], d = +r[3], by = +dt;
    const raw = this.#live();
    const index = clipIndex(this.#asset.clips, clip);
    return told(raw, raw.step_clip(index, at, x, y, z, a, b, c, d, by));
  }

  warmUp(clip, loops, dt) {
    const { translation: t, rotation: r } = this.#root;
    const numbers = [loops, ...t, ...r, dt].map(Number);
    this.#live().warm_up(clipIndex(this.#asset.clips, clip), ...numbers);
  }

  reset() {
    this.#live().reset();
  }

  settle() {
    this.#live().settle();
  }

  teleport() {
    this.#live().teleport();
  }

  freeze(frozen) {
    this.#live().freeze(Boolean(frozen));
  }

  setRateDivisor(divisor) {
    const whole = Number(divisor);
    this.#live().set_rate_divisor(whole);
  }

  get tunables() {
    return toTunables(this.#live().tunables(), this.#asset.regions);
  }

  set tunables(tunables) {
    const raw = this.#live();
    const words = raw.tunables();
    writeTunables(tunables, words, this.#asset.regions);
    named(() => raw.set_tunables(words));
  }

  get stateLength() {
    return this.#live().state_len();
  }

  saveState(out) {
    const raw = this.#live();
    const length = raw.state_len();
    const to = out === undefined ? new Uint8Array(length) : bytesOf(out, 'saveState(out)');
    if (to.length !== length) throw coded('STATE_WRONG_LENGTH', `state has ${length} bytes, the buffer given ${to.length}`);
    const address = raw.save_state();
    to.set(new Uint8Array(memory().buffer, address, length));
    return to;
  }

  loadState(bytes) {
    const state = apart(bytesOf(bytes, 'loadState(bytes)'));
    this.#live().load_state(state);
  }

  record(snapshotEvery = 60) {
    const every = Number(snapshotEvery);
    this.#live().record(every);
  }

  get recording() {
    return this.#live().is_recording();
  }

  stopRecording() {
    return this.#live().stop_recording();
  }

  get digests() {
    const [pose, skin, dynamics, embed] = this.#live().digests();
    return { pose, skin, dynamics, embed };
  }

  heat(out) {
    const address = this.#live().heat();
    const heat = this.#view('heat', address, this.#asset.vertexCount);
    if (out === undefined) return heat;
    out.set(heat);
    return out;
  }

  skin(flesh = true) {
    const address = this.#live().skin(Boolean(flesh));
    const length = 3 * this.#asset.vertexCount;
    return {
      positions: this.#view('skinnedPositions', address, length),
      normals: this.#view('skinnedNormals', address + 4 * length, length),
    };
  }

  dispose() {
    this.#raw?.free();
    this.#raw = undefined;
    this.#views = {};
  }

  free() {
    this.dispose();
  }

  [Symbol.dispose ?? '@@dispose']() {
    this.dispose();
  }
}
