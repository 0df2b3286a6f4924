export { SinewCharacter } from './character.js';
export { heatStops } from './heat.js';
export { SinewHelper } from './helper.js';
export { SinewLoaderPlugin } from './plugin.js';
