// What it costs, as measured here and now.
const FRAMES = 120;
const EVERY_MS = 400;
const RESOLUTION = globalThis.crossOriginIsolated ? 5 : 100; // of the clock, µs

export const count = (n) => n.toLocaleString('en-US');
export const bytes = (n) => (n < 1e6 ? `${(n / 1e3).toFixed(n < 1e4 ? 1 : 0)} kB` : `${(n / 1e6).toFixed(1)} MB`);

/** Microseconds in words, no finer than the clock is. */
function micros(us) {
  if (us < RESOLUTION) return `< ${RESOLUTION} µs`;
  return us < 1000 ? `${Math.round(us)} µs` : `${(us / 1000).toFixed(2)} ms`;
}

const perSecond = (ms) => (1000 / ms).toFixed(ms > 100 ? 1 : 0);

/** The last values of a series. */
class Recent {
  #values = new Float64Array(FRAMES);
  #sorted = new Float64Array(FRAMES);
  #next = 0;
  length = 0;

  add(value) {
    this.#values[this.#next] = value;
    this.#next = (this.#next + 1) % FRAMES;
    this.length = Math.min(FRAMES, this.length + 1);
  }

  clear() {
    this.length = this.#next = 0;
  }

  /** The value below which `share` of them lie. */
  quantile(share) {
    const sorted = this.#sorted.subarray(0, this.length);
    sorted.set(this.#values.subarray(0, this.length));
    sorted.sort();
    return sorted[Math.min(this.length - 1, Math.floor(share * this.length))];
  }
}

export class Figures {
  #cost = new Recent();
  #frame = new Recent();
  #due = 0;
  #cells = {};

  constructor({ simd }) {
    const rows = [
      ['vertices', 'Vertices'], ['cost', 'Median, 95th percentile'],
      ['fps', 'Frames per second'], ['asset', 'Asset'], ['flavor', 'Runtime'],
    ];
    const list = document.querySelector('#figures');
    for (const [key, title] of rows) {
      const [dt, dd] = [document.createElement('dt'), document.createElement('dd')];
      dt.textContent = title;
      dd.textContent = '–';
      list.append(dt, dd);
      this.#cells[key] = dd;
    }
    this.#cells.flavor.textContent = simd ? 'wasm, SIMD' : 'wasm, scalar';
    this.#cells.flavor.title = 'The page takes the build that this browser can run; both give the same bits.';
    this.median = document.querySelector('#fig-median');
    this.moving = document.querySelector('#fig-moving');
  }

  attach({ asset, assetBytes }) {
    this.#cost.clear();
    this.#frame.clear();
    this.moving.textContent = count(asset.pointCount);
    this.#cells.vertices.textContent = count(asset.vertexCount);
    this.#cells.asset.textContent = bytes(assetBytes.length);
  }

  /** One frame: what sinew took, or nothing where it did not run, and the time since the last frame. */
  add(microseconds, frameMs) {
    if (microseconds !== null) this.#cost.add(microseconds);
    this.#frame.add(frameMs);
  }

  show(now) {
    if (now < this.#due) return;
    this.#due = now + EVERY_MS;
    if (this.#frame.length) this.#cells.fps.textContent = perSecond(this.#frame.quantile(0.5));
    if (!this.#cost.length) return;
    this.median.textContent = micros(this.#cost.quantile(0.5));
    this.#cells.cost.textContent = `${this.median.textContent}, ${micros(this.#cost.quantile(0.95))}`;
  }
}
