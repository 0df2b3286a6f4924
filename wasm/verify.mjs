#!/usr/bin/env node
// verify.mjs FILE.replay FILE.sinew [--scalar]: runs a replay under WebAssembly.
// Exits 0 where every frame is the same, 1 where one is not, 2 where a file is not usable.
import { readFileSync } from 'node:fs';
import { Asset, init, verify } from './js/index.js';

const scalar = process.argv.includes('--scalar');
const [replay, asset] = process.argv.slice(2).filter((argument) => !argument.startsWith('--'));
if (asset === undefined) {
  console.error('usage: verify.mjs FILE.replay FILE.sinew [--scalar]');
  process.exit(2);
}
try {
  await init(scalar ? new URL('./pkg/sinew_scalar_bg.wasm', import.meta.url) : undefined);
  const { same, digest, message } = verify(new Asset(readFileSync(asset)), readFileSync(replay));
  console.log(`${replay}: ${message}${same ? `, digest ${digest}` : ''}`);
  process.exitCode = same ? 0 : 1;
} catch (error) {
  console.error(`${replay}: ${error.message}`);
  process.exitCode = 2;
}
