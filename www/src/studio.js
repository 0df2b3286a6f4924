// What shiny things mirror: a dark room with three soft lamps. Small, so that it is blurred in no time.
import * as THREE from 'three';

const WIDTH = 128;
const HEIGHT = 64;
/** Direction, color and width (cosine at the rim) of each lamp. */
const LAMPS = [
  { at: [1.5, 2.6, 1.9], color: [9, 8, 6.6], rim: 0.9 },
  { at: [-2.2, 1.7, -2.6], color: [3.4, 4.6, 7.4], rim: 0.86 },
  { at: [2.6, 0.9, -2.2], color: [5.2, 3.6, 2.6], rim: 0.93 },
].map(({ at, ...lamp }) => ({ ...lamp, at: new THREE.Vector3(...at).normalize() }));

/** Light that comes from `direction`, into `out`. */
function radiance(direction, out) {
  const up = 0.5 + 0.5 * direction.y;
  out.setRGB(0.1 + 0.42 * up * up, 0.09 + 0.46 * up * up, 0.1 + 0.58 * up * up);
  for (const { at, color: [r, g, b], rim } of LAMPS) {
    const share = THREE.MathUtils.smoothstep(direction.dot(at), rim, 1 - 0.3 * (1 - rim));
    out.r += share * r;
    out.g += share * g;
    out.b += share * b;
  }
}

/** The room as an environment map. @param {THREE.WebGLRenderer} renderer */
export function studio(renderer) {
  const data = new Uint16Array(4 * WIDTH * HEIGHT); // half floats: every machine can blend those
  const direction = new THREE.Vector3();
  const color = new THREE.Color();
  for (let y = 0; y < HEIGHT; y++) {
    for (let x = 0; x < WIDTH; x++) {
      const around = ((x + 0.5) / WIDTH - 0.5) * 2 * Math.PI;
      direction.setFromSphericalCoords(1, Math.PI * (1 - (y + 0.5) / HEIGHT), Math.PI / 2 - around);
      radiance(direction, color);
      data.set([color.r, color.g, color.b, 1].map(THREE.DataUtils.toHalfFloat), 4 * (y * WIDTH + x));
    }
  }
  const room = new THREE.DataTexture(data, WIDTH, HEIGHT, THREE.RGBAFormat, THREE.HalfFloatType, THREE.EquirectangularReflectionMapping);
  room.minFilter = room.magFilter = THREE.LinearFilter;
  room.needsUpdate = true;
  const generator = new THREE.PMREMGenerator(renderer);
  const { texture } = generator.fromEquirectangular(room);
  generator.dispose();
  room.dispose();
  return texture;
}
