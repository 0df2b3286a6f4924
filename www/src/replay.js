// Record, verify, keep: what happened can be run again, and every bit compared.
import { bytes as sizeOf, count } from './figures.js';

const $ = (id) => document.querySelector(id);

export function download(name, bytes) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes], { type: 'application/octet-stream' }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export class Replay {
  recording = false;
  frames = 0;
  /** @type {Uint8Array | null} */
  bytes = null;
  #actor = null;
  #button = $('#record');

  /** @param {() => void} onStart before a recording begins */
  constructor(onStart) {
    this.onStart = onStart;
    this.#button.addEventListener('click', () => this.toggle());
    $('#verify').addEventListener('click', () => this.check(this.bytes));
    $('#tamper').addEventListener('click', () => this.#tamper());
    $('#save-replay').addEventListener('click', () => download(`${this.#stem()}.replay`, this.bytes));
    $('#save-asset').addEventListener('click', () => download(`${this.#stem()}.sinew`, this.#actor.assetBytes));
  }

  #stem() {
    return this.#actor.name.replace(/\.\w+$/, '').toLowerCase().replace(/[^\w-]+/g, '-');
  }

  attach(actor) {
    const lost = this.recording;
    this.#actor = actor;
    this.recording = false;
    this.#keep(null);
    this.#say(lost ? 'The recording ended with the character it was of.' : 'Records every frame; verifying runs it again and compares all bits.');
    this.#show();
  }

  toggle() {
    const { character } = this.#actor;
    try {
      if (this.recording) this.#stop(character);
      else this.#start(character);
    } catch (error) {
      this.recording = false;
      this.#say(error.message, 'bad');
    }
    this.#show();
  }

  #start(character) {
    this.onStart();
    character.record();
    this.recording = true;
    this.frames = 0;
    this.#keep(null);
    this.#say('Recording…');
  }

  #stop(character) {
    this.recording = false;
    this.#keep(character.stopRecording());
    this.#say(`${count(this.frames)} frames in ${sizeOf(this.bytes.length)}. Verify runs them again.`);
  }

  /** A frame was stepped. */
  frame() {
    if (!this.recording) return;
    this.frames += 1;
    if (this.frames % 10 === 0) this.#say(`Recording… ${count(this.frames)} frames`);
  }

  /** Verifies a replay that came from elsewhere, from now on the one at hand. */
  load(bytes) {
    this.#keep(bytes);
    this.check(bytes);
  }

  /** Runs a replay again and tells what came out. */
  check(bytes) {
    const verdict = this.verify(bytes);
    if (verdict.same) this.#say(`✓ ${count(verdict.frames)} frames, identical. Digest ${verdict.digest}`, 'good');
    else this.#say(`✗ ${verdict.message}`, 'bad');
    return verdict;
  }

  /** As the character's own, except that bytes which are no replay are a verdict too. */
  verify(bytes) {
    try {
      return this.#actor.character.verify(bytes);
    } catch (error) {
      return { same: false, message: error.message };
    }
  }

  #tamper() {
    const broken = this.bytes.slice();
    const at = Math.floor(broken.length * (0.3 + 0.5 * Math.random()));
    broken[at] ^= 1 << Math.floor(8 * Math.random());
    const verdict = this.verify(broken);
    if (verdict.same) this.#say(`Byte ${count(at)} changed, and nothing noticed: ${verdict.message}`, 'bad');
    else this.#say(`Byte ${count(at)} changed, and refused: ${verdict.message}`, 'good');
  }

  #keep(bytes) {
    this.bytes = bytes;
    for (const id of ['#verify', '#tamper', '#save-replay']) $(id).disabled = bytes === null;
  }

  #say(text, kind = '') {
    const verdict = $('#verdict');
    verdict.textContent = text;
    verdict.className = kind;
  }

  #show() {
    this.#button.classList.toggle('recording', this.recording);
    this.#button.querySelector('span').textContent = this.recording ? 'Stop' : 'Record';
  }
}
