// The page as built, end to end, in a browser. SINEW_URL names a server; without it one is started.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { preview } from 'vite';
import { launch, screenshot, watch } from './browser.mjs';

const DATA = new URL('../../shared/data/', import.meta.url);
const RIGGED = ['RiggedFigure.gltf', 'RiggedFigure0.bin'].map((name) => new URL(`khronos/${name}`, DATA));
const FOX = new URL('khronos/Fox.glb', DATA);
const skip = existsSync(FOX) || process.env.CI === 'true' ? false : 'no ../shared/data';
// Without a graphics card every pixel costs: wide enough for the card of controls, and no wider.
const SMALL = { width: 760, height: 480 };
const WIDE = { width: 1440, height: 900 };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 1 };
const NO_SKIN = { asset: { version: '2.0' }, meshes: [{ primitives: [] }], nodes: [{ mesh: 0 }] };

let server;
let browser;
let url;
before(async () => {
  server = process.env.SINEW_URL ? null : await preview({ root: import.meta.dirname, preview: { port: 0 } });
  url = process.env.SINEW_URL ?? server.resolvedUrls.local[0];
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.close();
});

/** A page that is ready, and the errors it has reported so far. */
async function open(options, errors = []) {
  const page = await browser.newPage(options);
  page.setDefaultTimeout(120_000);
  watch(page, errors);
  await page.goto(url);
  await page.waitForFunction(() => document.documentElement.dataset.state);
  assert.equal(await page.evaluate(() => document.documentElement.dataset.state), 'ready', errors.join('\n'));
  return page;
}

const state = (page) => page.evaluate(() => globalThis.sinew.state);
const frames = async (page, n) => {
  const { frames: now } = await state(page);
  await page.waitForFunction((until) => globalThis.sinew.state.frames >= until, now + n);
};
/** How many vertices are drawn elsewhere than skinning alone would have them. */
const moved = (page) => page.evaluate(() => {
  const [own, twin] = [globalThis.sinew.positions(), globalThis.sinew.positions(true)];
  if (own.length !== twin.length) throw new Error('the bodies differ');
  let count = 0;
  for (let i = 0; i < own.length; i += 3) {
    if (own[i] !== twin[i] || own[i + 1] !== twin[i + 1] || own[i + 2] !== twin[i + 2]) count += 1;
  }
  return count;
});
/** How far flesh has moved any vertex, units of the character. */
const farthest = (page) => page.evaluate(() => {
  const [own, twin] = [globalThis.sinew.positions(), globalThis.sinew.positions(true)];
  let most = 0;
  for (let i = 0; i < own.length; i += 3) most = Math.max(most, Math.hypot(own[i] - twin[i], own[i + 1] - twin[i + 1], own[i + 2] - twin[i + 2]));
  return most / globalThis.sinew.state.unit;
});
const picture = async (page, name) => {
  await page.evaluate(() => globalThis.sinew.sharpen());
  await frames(page, 2);
  await screenshot(page, name);
};
const message = (page) => page.evaluate(() => {
  const box = document.querySelector('#message');
  return box.hidden ? '' : box.innerText;
});
/** Drops files on the page, as a person would. @param {[string, Uint8Array][]} files name and contents of each */
async function dropAll(page, files) {
  await page.evaluate((all) => {
    const dataTransfer = new DataTransfer();
    for (const [name, base64] of all) {
      dataTransfer.items.add(new File([Uint8Array.from(atob(base64), (char) => char.charCodeAt(0))], name));
    }
    for (const type of ['dragenter', 'dragover', 'drop']) {
      document.body.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    }
  }, files.map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]));
}
const drop = (page, name, bytes) => dropAll(page, [[name, bytes]]);
/** Drops a model and waits until it stands there. */
async function dropModel(page, place) {
  const name = place.pathname.split('/').at(-1);
  await drop(page, name, readFileSync(place));
  await page.waitForFunction((wanted) => globalThis.sinew.state.name === wanted || !document.querySelector('#message').hidden, name);
  assert.equal(await message(page), '', `${name} opens`);
  await frames(page, 3);
}

describe('the page', () => {
  const errors = [];
  let page;
  before(async () => { page = await open({ viewport: SMALL }, errors); });
  after(async () => { await page?.close(); });

  test('has not loaded the baker', async () => {
    const names = await page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => name));
    assert.ok(names.some((name) => /plum\.sinew/.test(name)), 'its own character came baked');
    assert.ok(!names.some((name) => /bake[_-]/.test(name)), names.join('\n'));
  });

  test('is isolated, runs the SIMD build, and moves', async () => {
    assert.equal(await page.evaluate(() => globalThis.crossOriginIsolated), true);
    assert.equal(await page.evaluate(() => globalThis.sinew.simd), true);
    await frames(page, 5);
    const { clips, clip, playing } = await state(page);
    assert.ok(clips.length > 1 && clip === 0 && playing, 'the first clip plays');
  });

  test('flesh moves vertices, and off means skinning alone', async () => {
    await page.click('#shake');
    await frames(page, 6);
    assert.ok((await moved(page)) > 100, 'flesh moves');
    assert.ok((await farthest(page)) > 0.005, 'enough to be seen');
    await page.keyboard.press('f');
    await frames(page, 2);
    assert.equal((await state(page)).flesh, false);
    assert.equal(await moved(page), 0, 'skinning alone');
    await page.click('#flesh');
    await page.click('#shake');
    await frames(page, 6);
    assert.ok((await moved(page)) > 100, 'flesh moves again');
  });

  test('sliders change the tunables', async () => {
    const before = (await state(page)).tunables;
    for (const name of ['frequency', 'damping', 'gain', 'inertia', 'gravity', 'wind']) {
      await page.focus(`#feel-${name}`);
      await page.keyboard.press(name === 'inertia' ? 'PageDown' : 'PageUp');
    }
    const now = (await state(page)).tunables;
    for (const name of ['frequency', 'damping', 'gain', 'inertia', 'gravity', 'wind']) {
      assert.notDeepEqual(now[name], before[name], name);
    }
    await page.click('#authored');
    assert.deepEqual((await state(page)).tunables, before, 'as authored');
  });

  test('regions have sliders of their own', async () => {
    const before = (await state(page)).tunables.regions;
    await page.click('#regions summary');
    await page.focus('#regions input');
    await page.keyboard.press('PageUp');
    const now = (await state(page)).tunables.regions;
    assert.ok(now[0].frequency > before[0].frequency);
    assert.deepEqual(now.slice(1), before.slice(1), 'no other region changed');
    await page.click('#authored');
  });

  test('a drag on the character moves its root, and arrows do', async () => {
    const at = await page.evaluate(() => {
      const { page: { stage, actor } } = globalThis.sinew;
      return stage.project(actor.box.getCenter(actor.root.position.clone()));
    });
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    await page.mouse.move(at.x + 40, at.y - 30, { steps: 3 });
    await frames(page, 4);
    const { root: [x, y], unit } = await state(page);
    assert.ok(Math.hypot(x, y) > 0.05 * unit, `dragged by ${x}, ${y} of ${unit}`);
    await page.mouse.up();
    await page.keyboard.press('0');
    await frames(page, 8);
    await page.focus('#stage');
    await page.keyboard.down('ArrowRight');
    await frames(page, 3);
    await page.keyboard.up('ArrowRight');
    assert.ok((await state(page)).root[0] > 0, 'to the right');
    await page.keyboard.press('0');
  });

  test('records two seconds; the replay verifies, a changed byte does not', async () => {
    await page.click('#record');
    await page.click('#shake');
    await page.waitForTimeout(2000);
    await frames(page, 3);
    await page.click('#record');
    await page.click('#verify');
    assert.match(await page.textContent('#verdict'), /^✓ .*identical/);
    assert.equal((await page.evaluate(() => globalThis.sinew.verify())).same, true);
    for (const share of [0, 0.25, 0.5, 0.75, 0.9999]) {
      const verdict = await page.evaluate((part) => globalThis.sinew.verify((bytes) => {
        bytes[Math.floor(part * bytes.length)] ^= 1;
      }), share);
      assert.equal(verdict.same, false, `byte at ${share}`);
      assert.ok(verdict.message.length > 10, 'says why');
    }
    await page.click('#tamper');
    assert.match(await page.textContent('#verdict'), /changed, and refused/);
    const [replay] = await Promise.all([page.waitForEvent('download'), page.click('#save-replay')]);
    assert.match(replay.suggestedFilename(), /\.replay$/);
    await drop(page, 'again.replay', readFileSync(await replay.path()));
    await page.waitForFunction(() => document.querySelector('#verdict').textContent.startsWith('✓'));
  });

  test('what cannot work is told, and the character stays', async () => {
    const { name } = await state(page);
    await drop(page, 'notes.txt', Buffer.from('Hello, this is no model.'));
    await page.waitForFunction(() => !document.querySelector('#message').hidden);
    assert.match(await message(page), /notes\.txt is not a glTF file/);
    await drop(page, 'box.gltf', Buffer.from(JSON.stringify(NO_SKIN)));
    await page.waitForFunction(() => /no skin/.test(document.querySelector('#message').innerText));
    assert.match(await message(page), /armature/);
    assert.equal((await state(page)).name, name);
    await page.keyboard.press('Escape');
    assert.equal(await message(page), '');
  });

  test('a fox 155 units long is dropped, fits and moves', { skip }, async () => {
    await dropModel(page, FOX);
    const { unit, clips } = await state(page);
    assert.ok(unit > 50, `in its own units: ${unit}`);
    assert.equal(clips.length, 4);
    const corners = await page.evaluate(() => {
      const { page: { stage, actor } } = globalThis.sinew;
      const { min, max } = actor.frame();
      return [min, max].map((corner) => stage.project(corner));
    });
    for (const { x, y } of corners) assert.ok(x > 0 && x < SMALL.width && y > 0 && y < SMALL.height, `in view: ${x}, ${y}`);
    await page.selectOption('#clip', { label: 'Run' });
    await frames(page, 8);
    assert.ok((await moved(page)) > 50, 'flesh moves');
  });

  test('so is a VRM', { skip }, async () => {
    await dropModel(page, new URL('godette-vrm/Godette_vrm_v4.vrm', DATA));
    await page.click('#shake');
    await frames(page, 8);
    assert.ok((await moved(page)) > 50, 'flesh moves');
  });

  test('a glTF of several files opens when they come together, and says what it lacks alone', { skip }, async () => {
    const files = RIGGED.map((place) => [place.pathname.split('/').at(-1), readFileSync(place)]);
    await dropAll(page, files.slice(0, 1));
    await page.waitForFunction(() => /needs RiggedFigure0\.bin/.test(document.querySelector('#message').innerText));
    await dropAll(page, files);
    await page.waitForFunction(() => globalThis.sinew.state.name === 'RiggedFigure.gltf');
    assert.equal(await message(page), '');
  });

  test('said nothing in its console', () => assert.deepEqual(errors, []));
});

describe('pictures', () => {
  test('of a wide window', async () => {
    const errors = [];
    const page = await open({ viewport: WIDE }, errors);
    await frames(page, 4);
    await picture(page, 'wide.png');
    await page.keyboard.press('s');
    await page.keyboard.press('h');
    await frames(page, 6);
    await picture(page, 'wide-side-heat.png');
    if (!skip) {
      await page.keyboard.press('h');
      await page.keyboard.press('s');
      await dropModel(page, FOX);
      await picture(page, 'wide-fox.png');
    }
    assert.deepEqual(errors, []);
    await page.close();
  });

  test('of a phone, where nothing overflows', async () => {
    const errors = [];
    const page = await open(PHONE, errors);
    await frames(page, 4);
    await picture(page, 'phone.png');
    await page.tap('#grip');
    await page.waitForTimeout(300);
    await frames(page, 6);
    await picture(page, 'phone-open.png');
    await page.setViewportSize({ width: 360, height: 640 });
    await frames(page, 2);
    const wide = await page.evaluate(() => [...document.querySelectorAll('#panel *, .brand *')]
      .filter((node) => node.getClientRects().length && node.getBoundingClientRect().right > innerWidth + 0.5)
      .map((node) => node.outerHTML.slice(0, 80)));
    assert.deepEqual(wide, [], 'nothing is cut off at 360 px');
    assert.deepEqual(errors, []);
    await page.close();
  });
});

test('without WebGL the page says so', async () => {
  const page = await browser.newPage({ viewport: SMALL });
  await page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  await page.goto(url);
  await page.waitForFunction(() => document.documentElement.dataset.state === 'failed');
  assert.match(await message(page), /WebGL 2/);
  await page.close();
});

test('those who want less motion start with a still', async () => {
  const page = await open({ viewport: SMALL, reducedMotion: 'reduce' });
  assert.equal((await state(page)).playing, false);
  await page.close();
});
