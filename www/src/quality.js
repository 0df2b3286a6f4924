// Lowers what the picture costs where frames take long; never raises it again, so that nothing flickers.
const SLOW_MS = 42; // under 24 frames a second
const PATIENCE = 12; // slow frames among the last, before something is done
const WORST_MS = 1500; // longer is a pause, not a slow frame

export class Quality {
  #slow = 0;
  #level = 0;

  /** @param {import('./stage.js').Stage} stage @param {boolean} fixed stays as it is */
  constructor(stage, fixed) {
    this.steps = fixed ? [] : [
      () => stage.limit(1.25),
      () => stage.limit(1),
      () => stage.plain(),
      () => stage.limit(0.6),
    ];
  }

  /** The last frame took that long. */
  add(frameMs) {
    if (this.#level === this.steps.length || frameMs > WORST_MS) return;
    this.#slow = Math.max(0, this.#slow + (frameMs > SLOW_MS ? 1 : -1));
    if (this.#slow < PATIENCE) return;
    this.#slow = 0;
    this.steps[this.#level++]();
  }
}
