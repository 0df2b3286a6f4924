// Prints what the program says, in Node.
import { readFileSync } from 'node:fs';
import { NAMES, run } from './run.mjs';

const [module, ...files] = NAMES.map((name) => readFileSync(new URL(name, import.meta.url)));
process.stdout.write(await run(module, files));
