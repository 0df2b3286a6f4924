// Lowers what the picture costs where frames take long. It does not rise by itself, so that nothing flickers.
const SLOW_MS = 42; // under 24 frames a second
const VERY_SLOW_MS = 150;
const PATIENCE = 12; // slow frames among the last before something is done; a very slow one counts as four
const PAUSE_MS = 3000; // longer is the browser's doing

export class Quality {
  #slow = 0;
  #steps = [];

  /** @param {import('./stage.js').Stage} stage */
  constructor(stage) {
    this.stage = stage;
    this.raise({ plain: stage.software });
  }

  /** All as good as it gets, or where the processor draws, as good as it can bear. */
  raise({ plain = false } = {}) {
    const { stage } = this;
    stage.limit(plain ? 1 : 2);
    stage.plain(plain);
    this.#slow = 0;
    this.#steps = [() => stage.limit(1), () => stage.plain(true), () => stage.limit(0.6)];
    this.#steps.splice(0, plain ? 2 : devicePixelRatio <= 1 ? 1 : 0); // what is done, or gains nothing
  }

  /** The last frame took that long. */
  add(frameMs) {
    if (this.#steps.length === 0 || frameMs > PAUSE_MS) return;
    const weight = frameMs > VERY_SLOW_MS ? 4 : 1;
    this.#slow = Math.max(0, this.#slow + (frameMs > SLOW_MS ? weight : -1));
    if (this.#slow < PATIENCE) return;
    this.#slow = 0;
    this.#steps.shift()();
  }
}
