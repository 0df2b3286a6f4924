export { SinewCharacter } from './character.js';
export { SinewHelper } from './helper.js';
export { SinewLoaderPlugin } from './plugin.js';
