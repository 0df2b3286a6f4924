// node smoke.mjs URL: loads the page once.
import { screenshot, withPage } from './browser.mjs';

const [url] = process.argv.slice(2);
if (!url) throw new Error('usage: node smoke.mjs URL');
await withPage(url, async (page) => {
  if (!(await page.evaluate(() => globalThis.crossOriginIsolated))) throw new Error('not cross-origin isolated');
  await screenshot(page, 'smoke.png');
});
console.log(`${url} is ready`);
