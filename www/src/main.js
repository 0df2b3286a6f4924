// To be written: for now the least that proves three.js, the runtime and the lazy module arrive.
import * as THREE from 'three';
import { init, simd, version } from 'sinew-wasm';

const main = async () => {
  await init();
  const bake = await import('sinew-wasm/bake');
  await bake.default();

  const canvas = document.querySelector('canvas');
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
  renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x20242c);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x445566, 3));
  scene.add(new THREE.Mesh(new THREE.TorusKnotGeometry(), new THREE.MeshStandardMaterial({ color: 0xe8a06a })));
  const camera = new THREE.PerspectiveCamera(40, canvas.clientWidth / canvas.clientHeight, 0.1, 100);
  camera.position.z = 6;
  renderer.render(scene, camera);

  document.querySelector('#version').textContent =
    `sinew ${version()} (${simd ? 'SIMD' : 'scalar'}), bake ${bake.version()}`;
};

// What the tests wait for: `ready` or `failed`.
main().then(
  () => { document.documentElement.dataset.state = 'ready'; },
  (error) => {
    console.error(error);
    document.documentElement.dataset.state = 'failed';
  },
);
