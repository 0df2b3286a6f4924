// node text.mjs URL: prints the text of a page once it is ready.
import { withPage } from './browser.mjs';

const [url] = process.argv.slice(2);
if (!url) throw new Error('usage: node text.mjs URL');
await withPage(url, async (page) => console.log(await page.evaluate(() => document.body.innerText)));
