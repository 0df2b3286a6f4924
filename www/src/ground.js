// The ground: a grid that fades out, soft shadow, and the dark spot where a body stands.
import * as THREE from 'three';

const VERTEX = /* glsl */ `
  varying vec2 at;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    at = world.xz;
    gl_Position = projectionMatrix * viewMatrix * world;
  }`;

const FRAGMENT = /* glsl */ `
  varying vec2 at;
  uniform vec2 center;
  uniform float unit;
  uniform vec3 spots[2]; // x, z, strength

  // Lines of about one pixel, wider than the pixel far away so that they do not flicker.
  float grid(vec2 p) {
    vec2 width = fwidth(p);
    vec2 lines = 1.0 - smoothstep(0.0, 1.0, abs(fract(p - 0.5) - 0.5) / max(width, 1e-4));
    return max(lines.x, lines.y) * (1.0 - smoothstep(0.2, 0.6, max(width.x, width.y)));
  }

  void main() {
    float far = length(at - center) / unit;
    float fade = 1.0 - smoothstep(0.8, 5.2, far);
    float line = 0.07 * grid(2.0 * at / unit) + 0.08 * grid(0.5 * at / unit);
    float light = (line + 0.03) * fade * fade;
    float dark = 0.0;
    for (int i = 0; i < 2; i++) {
      float d = length(at - spots[i].xy) / unit;
      dark = max(dark, spots[i].z * exp(-9.0 * d * d));
    }
    // Darkness over light, both see-through.
    dark *= 0.6;
    float alpha = dark + light * (1.0 - dark);
    gl_FragColor = vec4(vec3(0.86, 0.9, 1.0) * light * (1.0 - dark) / max(alpha, 1e-4), alpha);
  }`;

export class Ground extends THREE.Group {
  #uniforms = {
    center: { value: new THREE.Vector2() },
    unit: { value: 1 },
    spots: { value: [new THREE.Vector3(), new THREE.Vector3()] },
  };

  constructor() {
    super();
    const plane = new THREE.PlaneGeometry(12, 12).rotateX(-Math.PI / 2);
    const grid = new THREE.ShaderMaterial({
      uniforms: this.#uniforms,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
    });
    const shadow = new THREE.Mesh(plane, new THREE.ShadowMaterial({ opacity: 0.42, color: 0x05060c, depthWrite: false }));
    shadow.receiveShadow = true;
    this.add(new THREE.Mesh(plane, grid), shadow);
    shadow.renderOrder = 1;
  }

  /** Lies at `height`, lines and fading in `unit` (world units). */
  fit(height, unit) {
    this.scale.setScalar(unit);
    this.position.y = height;
    this.#uniforms.unit.value = unit;
  }

  /** Fades around `point`; the lines stay where they are in the world. */
  follow(point) {
    this.position.x = point.x;
    this.position.z = point.z;
    this.#uniforms.center.value.set(point.x, point.z);
  }

  /** Darkens the ground below bodies: `{ x, z, height }` above the ground, in world units. */
  spots(bodies) {
    this.#uniforms.spots.value.forEach((spot, i) => {
      const body = bodies[i];
      if (!body) spot.z = 0;
      else spot.set(body.x, body.z, Math.max(0, 1 - (2 * body.height) / this.scale.x));
    });
  }
}
