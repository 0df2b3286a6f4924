import { RawVerdict } from '../pkg/sinew.js';
import { Asset, rawOf } from './asset.js';
import { coded } from './error.js';
import { apart } from './load.js';
import { bytesOf } from './readable.js';

export function verify(asset, replay) {
  if (!(asset instanceof Asset)) throw coded('NOT_AN_ASSET', 'verify(asset, replay): expected an Asset', TypeError);
  const raw = RawVerdict.of(rawOf(asset), apart(bytesOf(replay, 'verify(asset, replay)')));
  try {
    const frames = Number(raw.frames());
    const [frame, difference] = [raw.frame(), raw.difference()];
    const verdict = { same: frame === undefined, frames, digest: raw.digest() };
    if (verdict.same) return { ...verdict, message: `${frames} frames, the same` };
    return { ...verdict, frame: Number(frame), stage: raw.stage(), message: difference };
  } finally {
    raw.free();
  }
}
