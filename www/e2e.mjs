// The page as built, end to end. SINEW_URL names a server; without it one is started on a free port.
import assert from 'node:assert/strict';
import { preview } from 'vite';
import { screenshot, withPage } from './browser.mjs';

const server = process.env.SINEW_URL ? null : await preview({ root: import.meta.dirname, preview: { port: 0 } });
const url = process.env.SINEW_URL ?? server.resolvedUrls.local[0];
try {
  await withPage(url, async (page) => {
    assert.equal(await page.evaluate(() => globalThis.crossOriginIsolated), true, 'cross-origin isolated');
    assert.match(await page.textContent('#version'), /sinew \d+\.\d+\.\d+ \(SIMD\), bake \d/, 'both modules answer');
    await screenshot(page, 'page.png');
  });
  console.log('page: ok');
} finally {
  await server?.close();
}
