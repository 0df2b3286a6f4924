// The card of controls: switches, clips, speed; on a phone, a sheet.
import { slider } from './slider.js';

const $ = (id) => document.querySelector(id);
const PHONE = matchMedia('(max-width: 720px)');

/** A button with role `switch`. */
function toggle(id, on) {
  const button = $(id);
  const set = (checked) => {
    button.setAttribute('aria-checked', String(checked));
    on(checked);
  };
  const flip = () => set(button.getAttribute('aria-checked') !== 'true');
  button.addEventListener('click', flip);
  return { flip, set, get on() { return button.getAttribute('aria-checked') === 'true'; } };
}

export class Panel {
  #speed;

  /** @param {Record<string, Function>} on what happens: flesh, side, heat, playing, clip, speed, shake, insets */
  constructor(on) {
    this.flesh = toggle('#flesh', on.flesh);
    this.side = toggle('#side', on.side);
    this.heat = toggle('#heat', on.heat);
    this.on = on;
    this.playing = true;
    $('#play').addEventListener('click', () => this.play(!this.playing));
    $('#shake').addEventListener('click', on.shake);
    $('#clip').addEventListener('change', (event) => on.clip(Number(event.target.value)));
    this.#speed = slider({ label: 'Speed', id: 'speed-slider', min: 0.1, max: 2.5, log: true, show: (x) => `${x.toFixed(2)} ×`, change: on.speed });
    this.#speed.set(1);
    $('#speed').append(this.#speed.element);
    this.#sheet();
  }

  play(playing) {
    this.playing = playing;
    const button = $('#play');
    button.classList.toggle('paused', !playing);
    button.setAttribute('aria-label', playing ? 'Pause' : 'Play');
    this.on.playing(playing);
  }

  /** Names of the clips, and the model's own name with what the baker had to say. */
  attach({ name, notes, clips, clip }) {
    $('#model-name').textContent = name;
    $('#model-notes').textContent = notes.join('. ');
    $('#model-notes').hidden = notes.length === 0;
    $('#clip').replaceChildren(...clips.map((label, i) => new Option(label, i, false, i === clip)));
  }

  #sheet() {
    const panel = $('#panel');
    const grip = $('#grip');
    const open = (wanted) => {
      panel.classList.toggle('open', wanted);
      grip.setAttribute('aria-expanded', String(wanted));
    };
    grip.addEventListener('click', () => open(!panel.classList.contains('open')));
    let from = null;
    panel.addEventListener('pointerdown', (event) => {
      if (PHONE.matches && event.target.closest('#grip, .cost')) from = event.clientY;
    });
    addEventListener('pointerup', (event) => {
      if (from !== null && Math.abs(event.clientY - from) > 24) open(event.clientY < from);
      from = null;
    });
    new ResizeObserver(() => this.#tellInsets()).observe(panel);
    PHONE.addEventListener('change', () => this.#tellInsets());
    addEventListener('resize', () => this.#tellInsets());
  }

  #tellInsets() {
    const { left, top } = $('#panel').getBoundingClientRect();
    if (PHONE.matches) this.on.insets({ top: 76, right: 0, bottom: Math.max(0, innerHeight - top), left: 0 });
    else this.on.insets({ top: 24, right: Math.max(0, innerWidth - left), bottom: 24, left: 0 });
  }
}
