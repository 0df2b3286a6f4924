// Tunables cross as a row of words (`Tunables::to_words`); a person sees names.
import { coded } from './error.js';

const VECTORS = { gravity: 0, wind: 3 };
const NUMBERS = {
  gust: 6,
  gustRate: 7,
  inertia: 8,
  gain: 9,
  frequency: 10,
  damping: 11,
  teleport: 12,
  settleAfter: 13,
};
const FIRST_REGION = 14;
const REGION_WORDS = 4;
const REGION = { frequency: 0, damping: 1, gain: 2, maxOffset: 3 };

// The file beside an asset writes `gust_rate`; here it is `gustRate`. Both are understood.
const camel = (name) => name.replace(/_([a-z])/g, (_, letter) => letter.toUpperCase());

/** An object with names, from words. */
export function toTunables(words, regionNames) {
  const out = {};
  for (const [name, at] of Object.entries(VECTORS)) out[name] = Array.from(words.subarray(at, at + 3));
  for (const [name, at] of Object.entries(NUMBERS)) out[name] = words[at];
  out.regions = regionNames.map((name, i) => {
    const region = { name };
    for (const [field, at] of Object.entries(REGION)) region[field] = words[FIRST_REGION + REGION_WORDS * i + at];
    return region;
  });
  return out;
}

/** Writes the fields that `tunables` has over `words`. */
export function writeTunables(tunables, words, regionNames) {
  if (tunables === null || typeof tunables !== 'object') throw coded('TUNABLE_NOT_AN_OBJECT', 'tunables: expected an object', TypeError);
  for (const [key, value] of Object.entries(tunables)) {
    const name = camel(key);
    if (name === 'regions') writeRegions(value, words, regionNames);
    else if (name in VECTORS) words.set(vector(value, name), VECTORS[name]);
    else if (name in NUMBERS) words[NUMBERS[name]] = number(value, name);
    else throw coded('TUNABLE_UNKNOWN', `there is no tunable \`${key}\``);
  }
}

function writeRegions(regions, words, regionNames) {
  if (!Array.isArray(regions)) throw coded('TUNABLE_NOT_AN_ARRAY', 'tunable `regions` is not an array', TypeError);
  regions.forEach((region, i) => {
    const index = region.name === undefined ? i : regionNames.indexOf(region.name);
    if (index < 0 || index >= regionNames.length) {
      throw coded('TUNABLE_UNKNOWN', `there is no region \`${region.name ?? i}\`: the asset has ${regionNames.join(', ')}`);
    }
    for (const [key, value] of Object.entries(region)) {
      const field = camel(key);
      if (field === 'name') continue;
      if (!(field in REGION)) throw coded('TUNABLE_UNKNOWN', `there is no tunable \`${key}\` of a region`);
      words[FIRST_REGION + REGION_WORDS * index + REGION[field]] = number(value, field);
    }
  });
}

function number(value, name) {
  if (typeof value !== 'number') throw coded('TUNABLE_NOT_A_NUMBER', `tunable \`${name}\` is not a number`, TypeError);
  return value;
}

function vector(value, name) {
  const array = Array.from(value ?? []);
  if (array.length !== 3) throw coded('TUNABLE_NOT_AN_ARRAY', `tunable \`${name}\` is not an array of three numbers`, TypeError);
  return array.map((x) => number(x, name));
}

/** Runs `task`; names in its errors are written as here. */
export function named(task) {
  try {
    task();
  } catch (error) {
    if (error instanceof Error) error.message = error.message.replace(/`[^`]*`/g, camel);
    throw error;
  }
}
