// The stage: renderer, light, ground, and a camera that fits whatever stands there.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Ground } from './ground.js';
import { studio } from './studio.js';

const FRONT = new THREE.Vector3(0.5, 0.24, 1).normalize();
const ABREAST = new THREE.Vector3(0.12, 0.2, 1).normalize();
const point = new THREE.Vector3();
const ndc = new THREE.Vector2();

export class Stage {
  scene = new THREE.Scene();
  camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
  ground = new Ground();
  #key;
  #lights = new THREE.Group();
  #insets = { top: 0, right: 0, bottom: 0, left: 0 };
  #followed = new THREE.Vector3();
  #goal = null;
  #maxRatio = 2;
  #reflections;
  #raycaster = new THREE.Raycaster();
  /** Size of what stands here: half the diagonal of its box, world units. */
  unit = 1;

  /** @param {HTMLCanvasElement} canvas @throws where there is no WebGL 2 */
  constructor(canvas, { calm }) {
    this.canvas = canvas;
    this.calm = calm;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: 'high-performance' });
    this.renderer.toneMapping = THREE.ACESFilmicToneMapping;
    this.renderer.toneMappingExposure = 0.92;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.#light();
    this.scene.add(this.ground, this.#lights);
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, { enableDamping: !calm, dampingFactor: 0.09, maxPolarAngle: 1.54, zoomToCursor: false });
    this.controls.addEventListener('start', () => { this.#goal = null; });
    addEventListener('resize', () => this.resize());
    this.resize();
  }

  #light() {
    this.scene.environmentIntensity = 0.45;
    const sun = (color, intensity, x, y, z) => {
      const light = new THREE.DirectionalLight(color, intensity);
      light.position.set(x, y, z);
      this.#lights.add(light, light.target);
      return light;
    };
    this.#key = sun(0xffead2, 2.9, 1.5, 2.6, 1.9);
    this.#key.castShadow = true;
    this.#key.shadow.mapSize.set(2048, 2048);
    this.#key.shadow.radius = 5;
    this.#key.shadow.bias = -0.0004;
    sun(0x9db8ff, 2.4, -2.2, 1.7, -2.6); // rim, cool
    sun(0xffc9a8, 0.9, 2.6, 0.9, -2.2); // rim, warm
    this.#lights.add(new THREE.HemisphereLight(0xcdd8ff, 0x3d2f2c, 0.55));
  }

  /** Parts of the window covered by panels, CSS pixels; the camera centers on what is left. */
  setInsets(insets) {
    Object.assign(this.#insets, insets);
    this.resize();
  }

  /** Draws at most so many pixels to a CSS pixel. */
  limit(ratio) {
    this.#maxRatio = ratio;
    this.resize();
  }

  /** Whether the processor draws: it takes seconds over what a graphics card does in no time. */
  get software() {
    const gl = this.renderer.getContext();
    const info = gl.getExtension('WEBGL_debug_renderer_info');
    return /swiftshader|llvmpipe|softpipe|basic render/i.test(gl.getParameter(info?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
  }

  /** For machines without a graphics card: light without reflections, coarser shadow. */
  plain(plain) {
    this.scene.environment = plain ? null : (this.#reflections ??= studio(this.renderer));
    const { shadow } = this.#key;
    shadow.mapSize.setScalar(plain ? 1024 : 2048);
    shadow.map?.dispose();
    shadow.map = null;
  }

  resize() {
    const [width, height] = [innerWidth, innerHeight];
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, this.#maxRatio));
    this.renderer.setSize(width, height, false);
    const { top, right, bottom, left } = this.#insets;
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height);
  }

  /**
   * Fits light, ground and camera to `box` on the ground at `box.min.y`.
   * @param {THREE.Box3} box world space
   * @param {{ keepView?: boolean, abreast?: boolean, instant?: boolean }} [how] keepView: from the side the camera
   *   is at now; abreast: so that two bodies look equally near
   */
  fit(box, { keepView = false, abreast = false, instant = false } = {}) {
    const size = box.getSize(new THREE.Vector3());
    const center = box.getCenter(new THREE.Vector3());
    this.unit = size.length() / 2 || 1;
    this.ground.fit(box.min.y, this.unit);
    this.#followed.copy(center);
    this.follow(center);
    const far = 100 * this.unit;
    const { shadow } = this.#key;
    Object.assign(shadow.camera, { left: -2.2 * this.unit, right: 2.2 * this.unit, top: 2.2 * this.unit, bottom: -2.2 * this.unit, near: 0.1 * this.unit, far: 12 * this.unit });
    shadow.camera.updateProjectionMatrix();
    shadow.normalBias = 0.012 * this.unit;
    this.#key.position.set(1.5, 2.6, 1.9).multiplyScalar(1.6 * this.unit);
    Object.assign(this.camera, { near: this.unit / 60, far });
    Object.assign(this.controls, { minDistance: 0.6 * this.unit, maxDistance: 40 * this.unit });
    const side = keepView ? point.copy(this.camera.position).sub(this.controls.target).normalize().clone() : (abreast ? ABREAST : FRONT).clone();
    const target = center.clone();
    const position = side.clone().multiplyScalar(this.#distance(size, side)).add(target);
    this.#goal = { position, target };
    if (instant || this.calm) this.#arrive(1);
    this.resize();
  }

  /** How far the camera must be to see a box of `size` from `side` in the part of the window that is free. */
  #distance(size, side) {
    const { top, right, bottom, left } = this.#insets;
    const tall = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    const free = { x: Math.max(0.2, 1 - (left + right) / innerWidth), y: Math.max(0.2, 1 - (top + bottom) / innerHeight) };
    const slope = { x: tall * this.camera.aspect * free.x, y: tall * free.y };
    const x = new THREE.Vector3(0, 1, 0).cross(side).normalize();
    const y = side.clone().cross(x);
    let distance = 0;
    for (let corner = 0; corner < 8; corner++) {
      point.set(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5).multiply(size);
      const across = Math.max(Math.abs(point.dot(x)) / slope.x, Math.abs(point.dot(y)) / slope.y);
      distance = Math.max(distance, across + point.dot(side));
    }
    return 1.16 * distance;
  }

  /** Camera, light and ground go along with `center`, in the plane. */
  follow(center) {
    const dx = center.x - this.#followed.x;
    const dz = center.z - this.#followed.z;
    this.#followed.copy(center);
    for (const moved of [this.camera.position, this.controls.target, this.#goal?.position, this.#goal?.target]) {
      if (moved) { moved.x += dx; moved.z += dz; }
    }
    this.ground.follow(center);
    this.#key.target.position.copy(center);
    this.#lights.position.set(0, 0, 0);
    this.#key.position.set(1.5, 2.6, 1.9).multiplyScalar(1.6 * this.unit).add(center);
  }

  #arrive(share) {
    this.camera.position.lerp(this.#goal.position, share);
    this.controls.target.lerp(this.#goal.target, share);
    if (share === 1 || this.camera.position.distanceTo(this.#goal.position) < 0.002 * this.unit) this.#goal = null;
  }

  /** A ray from the camera through a place in the window. */
  ray({ clientX, clientY }) {
    ndc.set((2 * clientX) / innerWidth - 1, 1 - (2 * clientY) / innerHeight);
    this.#raycaster.setFromCamera(ndc, this.camera);
    return this.#raycaster;
  }

  /** Where a world point is in the window, CSS pixels. */
  project(world) {
    point.copy(world).project(this.camera);
    return { x: ((point.x + 1) / 2) * innerWidth, y: ((1 - point.y) / 2) * innerHeight };
  }

  render(delta) {
    if (this.#goal) this.#arrive(1 - Math.exp(-6 * delta));
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }
}
