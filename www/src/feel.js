// What a person may turn: the tunables of the character, while it moves.
import { slider } from './slider.js';

const factor = (x) => `${x.toFixed(2)} ×`;
const hertz = (x) => `${x.toFixed(x < 10 ? 2 : 1)} Hz`;
const percent = (x) => `${Math.round(100 * x)} %`;
/** Earth's gravity for a body as long as a person is tall: for assets authored without. */
const SOME_GRAVITY = [0, -5.8, 0];

const REGION = [
  { field: 'frequency', label: 'Frequency', min: 0.2, max: 20, log: true, show: hertz },
  { field: 'damping', label: 'Damping', min: 0, max: 2 },
  { field: 'gain', label: 'Gain', min: 0, max: 3, show: factor },
  { field: 'maxOffset', label: 'Limit', min: 0, max: 0.5, show: (x) => `${(100 * x).toFixed(1)} %` },
];

/** What the baker's own names of regions mean; other names are an author's. */
const KINDS = { flesh: 'Body', ear: 'Ears', tail: 'Tail', crest: 'Crest', limb: 'Arms and legs' };
const called = (name) => KINDS[name] ?? `${name.charAt(0).toUpperCase()}${name.slice(1)}`;

const length = (vector) => Math.hypot(...vector);

export class Feel {
  #character = null;
  #authored = null;
  #gravity = SOME_GRAVITY;
  #wind = { strength: 0, angle: 90 };
  #sliders = {};
  #regions = document.querySelector('#regions');

  constructor() {
    const plain = (field) => (value) => this.#change({ [field]: value });
    const blow = (part) => (value) => this.#blow({ [part]: value });
    this.#add('frequency', { label: 'Frequency', min: 0.25, max: 4, log: true, show: factor, change: plain('frequency') });
    this.#add('damping', { label: 'Damping', min: 0, max: 3, show: factor, change: plain('damping') });
    this.#add('gain', { label: 'Gain', min: 0, max: 3, show: factor, change: plain('gain') });
    this.#add('inertia', { label: 'Inertia', min: 0, max: 1, show: percent, change: plain('inertia') });
    this.#add('gravity', {
      label: 'Gravity', min: -1, max: 4, show: (x) => `${x.toFixed(2)} g`,
      change: (value) => this.#change({ gravity: this.#gravity.map((x) => x * value) }),
    });
    this.#add('wind', { label: 'Wind', min: 0, max: 20, show: (x) => x.toFixed(1), change: blow('strength') });
    this.#add('angle', { label: 'blowing to', min: 0, max: 360, show: (x) => `${Math.round(x)}°`, change: blow('angle') });
    this.#add('gust', { label: 'in gusts', min: 0, max: 1, show: percent, change: plain('gust') });
    document.querySelector('#authored').addEventListener('click', () => this.reset());
  }

  #add(name, how) {
    this.#sliders[name] = slider({ ...how, id: `feel-${name}` });
    document.querySelector('#feel').append(this.#sliders[name].element);
  }

  #change(some) {
    if (this.#character) this.#character.tunables = some;
  }

  #blow(part) {
    Object.assign(this.#wind, part);
    const { strength, angle } = this.#wind;
    const radians = (angle * Math.PI) / 180;
    this.#change({ wind: [strength * Math.sin(radians), 0, strength * Math.cos(radians)] });
    this.#showWind();
  }

  #showWind() {
    for (const name of ['angle', 'gust']) this.#sliders[name].element.hidden = this.#wind.strength === 0;
  }

  /** Sliders for this character, as it was authored. */
  attach(character) {
    this.#character = character;
    this.#authored = character.tunables;
    const { gravity, regions } = this.#authored;
    this.#gravity = length(gravity) > 0 ? gravity : SOME_GRAVITY;
    this.#buildRegions(regions);
    this.#show();
  }

  /** Back to what was authored. */
  reset() {
    this.#change(this.#authored);
    this.#buildRegions(this.#authored.regions);
    this.#show();
  }

  #show() {
    const t = this.#authored;
    for (const name of ['frequency', 'damping', 'gain', 'inertia', 'gust']) this.#sliders[name].set(t[name]);
    this.#sliders.gravity.set(length(t.gravity) > 0 ? 1 : 0);
    const [x, , z] = t.wind;
    this.#wind.strength = length(t.wind);
    if (this.#wind.strength > 0) this.#wind.angle = ((Math.atan2(x, z) * 180) / Math.PI + 360) % 360;
    this.#sliders.wind.set(this.#wind.strength);
    this.#sliders.angle.set(this.#wind.angle);
    this.#showWind();
  }

  #buildRegions(regions) {
    this.#regions.hidden = regions.length === 0;
    this.#regions.querySelector('summary').textContent = `Regions (${regions.length})`;
    this.#regions.querySelector('div').replaceChildren(...regions.flatMap((region) => {
      const title = document.createElement('h3');
      title.textContent = called(region.name);
      const rows = REGION.map(({ field, ...how }) => {
        const row = slider({ ...how, change: (value) => this.#change({ regions: [{ name: region.name, [field]: value }] }) });
        row.set(region[field]);
        return row.element;
      });
      return [title, ...rows];
    }));
  }
}
