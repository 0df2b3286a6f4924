// The page: a character on a stage, and everything one may do to it.
import * as THREE from 'three';
import { simd, version } from 'sinew-wasm';
import { acceptFiles, modelAmong } from './drop.js';
import { Feel } from './feel.js';
import { Figures } from './figures.js';
import { allowGrabbing } from './grab.js';
import { hooks } from './hooks.js';
import { listen } from './keys.js';
import { placeLabels } from './labels.js';
import { drawLegend } from './legend.js';
import { fromFile, plum, read } from './model.js';
import { RootMotion } from './motion.js';
import { busy, hideMessage, showProblem } from './notice.js';
import { Panel } from './panel.js';
import { Problem, asProblem } from './problem.js';
import { Quality } from './quality.js';
import { Replay } from './replay.js';
import { Stage } from './stage.js';

const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
const LONGEST_STEP = 0.25; // s: what a clip advances at most after a pause of the browser's
const point = new THREE.Vector3();

export class Page {
  motion = new RootMotion();
  actor = null;
  speed = 1;
  playing = true;
  frames = 0;
  #turn = 0;
  #before = null;

  constructor(canvas) {
    this.stage = new Stage(canvas, { calm });
    this.quality = new Quality(this.stage);
    this.figures = new Figures({ simd });
    this.feel = new Feel();
    this.replay = new Replay(() => this.panel.flesh.set(true)); // without flesh there are no steps
    this.panel = new Panel({
      flesh: () => this.apply(),
      heat: () => this.apply(),
      side: () => { this.apply(); this.frame(); },
      playing: (playing) => { this.playing = playing; },
      clip: (index) => this.actor?.play(index),
      speed: (speed) => { this.speed = speed; },
      shake: () => this.motion.shake(),
      insets: (insets) => { this.stage.setInsets(insets); this.frame({ keepView: true }); },
    });
    const choose = acceptFiles((files) => this.open(files));
    allowGrabbing(this.stage, this.motion, () => this.actor);
    listen({
      f: () => this.panel.flesh.flip(), s: () => this.panel.side.flip(), h: () => this.panel.heat.flip(),
      ' ': () => this.panel.play(!this.panel.playing), x: () => this.motion.shake(), 0: () => this.home(),
      o: choose, r: () => this.actor && this.replay.toggle(), escape: hideMessage,
    }, (x, y) => this.walk(x, y));
    drawLegend();
    if (calm) this.panel.play(false);
  }

  /** Shows what the switches say. */
  apply() {
    const { flesh, side, heat } = this.panel;
    document.body.classList.toggle('side', side.on);
    document.body.classList.toggle('plain', !flesh.on);
    if (!this.actor) return;
    this.actor.side = side.on;
    this.actor.character.enabled = flesh.on;
    this.actor.character.heatMap = heat.on;
    document.body.classList.toggle('heat', heat.on);
  }

  /** The camera fits what is shown. */
  frame(how = {}) {
    if (this.actor) this.stage.fit(this.actor.frame(), { abreast: this.actor.side, ...how });
  }

  /** Arrow keys, as seen from the camera. */
  walk(x, y) {
    this.stage.camera.getWorldDirection(point);
    const length = Math.hypot(point.x, point.z) || 1;
    const [forwardX, forwardZ] = [point.x / length, point.z / length];
    this.motion.nudge(-forwardZ * x - forwardX * y, forwardX * x - forwardZ * y);
  }

  home() {
    this.motion.home();
    this.frame();
  }

  /** Opens a model, with files beside it; on any problem the character that is there stays. @param {Map<string, File>} files by path */
  async open(files) {
    const turn = ++this.#turn; // the last model wins
    hideMessage();
    const file = modelAmong(files);
    try {
      if (/\.replay$/i.test(file.name)) return this.replay.load(await read(file));
      const actor = await busy(`Giving flesh to ${file.name}`, () => fromFile(file, files));
      if (turn === this.#turn) this.show(actor);
      else actor.dispose();
    } catch (error) {
      if (turn !== this.#turn) return undefined;
      if (!(error instanceof Problem)) console.warn(error);
      showProblem(asProblem(error, `${file.name} cannot be opened`));
    }
    return undefined;
  }

  show(actor) {
    this.actor?.dispose();
    this.actor = actor;
    this.motion.reset();
    this.motion.unit = actor.unit;
    this.stage.scene.add(actor.root, actor.twin.root);
    for (const part of [this.feel, this.figures, this.replay, this.panel]) part.attach(part === this.feel ? actor.character : actor);
    this.apply();
    this.frame({ instant: true });
  }

  /** One frame of the browser's. */
  tick(now) {
    const elapsed = this.#before === null ? 0 : now - this.#before;
    this.#before = now;
    const real = Math.min(elapsed / 1000, LONGEST_STEP);
    const delta = real * this.speed;
    const { actor, stage } = this;
    if (actor && delta > 0) {
      this.motion.update(delta);
      actor.update(this.playing ? delta : 0, delta, this.motion.offset);
      if (actor.character.enabled) this.replay.frame();
      this.figures.add(actor.character.enabled ? actor.character.stats.microseconds : null, elapsed);
      this.figures.show(now);
      stage.follow(actor.center(point));
      stage.ground.spots(actor.feet());
      this.frames += 1;
    }
    stage.render(real);
    this.quality.add(elapsed);
    if (actor) placeLabels(stage, actor);
  }
}

async function main() {
  let page;
  try {
    page = new Page(document.querySelector('#stage'));
  } catch (error) {
    console.warn(error);
    throw new Problem('This page needs WebGL 2', 'Turn on hardware acceleration in the settings of your browser, or open the page in another one.');
  }
  page.stage.renderer.setAnimationLoop((now) => page.tick(now));
  page.show(await busy('Loading the character', plum));
  globalThis.sinew = hooks(page, { version: version(), simd });
}

// What the tests wait for: `ready` or `failed`.
main().then(
  () => { document.documentElement.dataset.state = 'ready'; },
  (error) => {
    showProblem(asProblem(error, 'The page could not start'), true);
    if (!(error instanceof Problem)) console.error(error);
    document.documentElement.dataset.state = 'failed';
  },
);
