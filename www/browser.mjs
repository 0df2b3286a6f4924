// A page in headless Chromium that fails on any error in its console.
import { existsSync } from 'node:fs';
import { mkdir } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const CANDIDATES = [
  process.env.CHROMIUM,
  '/usr/bin/chromium',
  '/usr/bin/chromium-browser',
  '/usr/bin/google-chrome',
  '/usr/bin/google-chrome-stable',
  '/Applications/Google Chrome.app/Contents/MacOS/Google Chrome',
];

// Nothing a browser says of the machine it runs on, as opposed to the page.
const IGNORED = [/GPU stall due to ReadPixels/, /GL Driver Message/, /software WebGL/i];

const ARTIFACTS = new URL('artifacts/', import.meta.url);
const READY_MS = 120_000; // a busy machine without a graphics card takes its time

/** Keeps a picture of the page under `artifacts/`. */
export async function screenshot(page, name) {
  await mkdir(ARTIFACTS, { recursive: true });
  await page.screenshot({ path: fileURLToPath(new URL(name, ARTIFACTS)), timeout: READY_MS });
}

/** Headless Chromium without a word to anyone but the page. */
export async function launch() {
  const executablePath = CANDIDATES.find((path) => path && existsSync(path));
  if (!executablePath) throw new Error('no Chromium: set CHROMIUM to the path of one');
  return chromium.launch({
    executablePath,
    args: [
      '--no-sandbox', // as root there is none
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      '--no-first-run',
      '--use-angle=swiftshader', // the same picture on every machine
      '--enable-unsafe-swiftshader',
    ],
  });
}

/** Collects what goes wrong in a page, however late. */
export function watch(page, errors) {
  page.on('pageerror', (error) => errors.push(`uncaught: ${error.stack ?? error}`));
  page.on('console', (message) => {
    const text = message.text();
    if (message.type() === 'error' && !IGNORED.some((known) => known.test(text))) errors.push(`console: ${text}`);
  });
  page.on('requestfailed', (request) => errors.push(`not loaded: ${request.url()}`));
  page.on('response', (response) => {
    if (response.status() >= 400) errors.push(`${response.status()}: ${response.url()}`);
  });
}

/**
 * Opens `url`, waits until the page says it is ready, and hands it to `use(page)`.
 * Throws if the page failed, or if anything was reported as an error, however late.
 */
export async function withPage(url, use, options = { viewport: { width: 1280, height: 800 } }) {
  const browser = await launch();
  const errors = [];
  try {
    const page = await browser.newPage(options);
    page.setDefaultTimeout(READY_MS);
    watch(page, errors);
    await page.goto(url);
    try {
      await page.waitForFunction(() => document.documentElement.dataset.state);
    } catch (error) {
      errors.push(`never ready: ${error.message}`);
    }
    const state = await page.evaluate(() => document.documentElement.dataset.state);
    if (state === 'ready' && errors.length === 0) await use(page);
    else errors.unshift(`the page is ${state ?? 'not ready'}`);
  } finally {
    await browser.close();
  }
  if (errors.length > 0) throw new Error(errors.join('\n'));
}
