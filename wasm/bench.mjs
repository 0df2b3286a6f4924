// bench.mjs [--json]: what the runtime costs under WebAssembly, with the peers in the same run.
// `cargo xtask bench` builds what it needs and runs it.
import { readFileSync } from 'node:fs';
import { isMainThread, parentPort, Worker, workerData } from 'node:worker_threads';

const SPRINGS = 10_000;
const FRAMES = 60;
const ROUNDS = 40;
const NETWORKS = 1_000;
/** Inputs and outputs of the network's layers. */
const LAYERS = [96, 64, 64, 48];

/** Best time of `task` per item, ns: what the code costs when nothing disturbs it. */
function best(task, items) {
  let least = Infinity;
  for (let round = 0; round < ROUNDS; round++) {
    const start = performance.now();
    task();
    least = Math.min(least, performance.now() - start);
  }
  return (1e6 * least) / items;
}

/** The spring stage and CPU skinning of one build, in a thread of its own. */
async function measure({ build, asset: bytes }) {
  const stages = await import('./pkg-bench/sinew.js');
  const { Asset, Character, initSync } = await import('./js/index.js');
  const read = (folder) => readFileSync(new URL(`./${folder}/sinew_${build}_bg.wasm`, import.meta.url));
  stages.initSync({ module: read('pkg-bench') });
  initSync(read('pkg'));
  const springs = new stages.BenchSprings(SPRINGS);
  const network = new stages.BenchNetwork();
  const asset = new Asset(bytes);
  const character = new Character(asset);
  for (let frame = 0; frame < 10; frame++) character.stepClip(0, frame / 60, 1 / 60);
  let frame = 0;
  return {
    springs: best(() => springs.run(FRAMES), SPRINGS * FRAMES),
    network: best(() => network.run(NETWORKS), NETWORKS) / 1e3,
    skin: best(() => character.skin(), asset.vertexCount),
    frame: best(() => character.stepClip(0, frame++ / 60, 1 / 60), 1) / 1e6,
  };
}

/** The arithmetic of `kernel::spring` in a plain loop over `Float32Array`s: what one would write first. */
function plain() {
  const n = 3 * SPRINGS;
  const zeros = () => new Float32Array(n);
  const [x, y, v, slope, f, rest] = Array.from({ length: 6 }, zeros);
  const swung = Float32Array.from({ length: n }, (_, i) => [0.01, -0.02, 0.03][i % 3]);
  // Any weights do: the time does not depend on them.
  const [wy, wu] = [[0.9, 0.014, -0.4, 1e-4, 5e-5], [-5, 0.8, -30, 7e-3, 7e-3]].map((row) => Float32Array.from(row));
  const [dt, inverse, restY, restU] = Float32Array.of(1 / 60, 60, 1e-7, 2e-6);
  const step = (x1, f1) => {
    for (let i = 0; i < n; i++) {
      const d = x1[i] - x[i];
      const e = d - slope[i] * dt;
      const u0 = v[i] - slope[i];
      let y1 = wy[0] * y[i] + wy[1] * u0 + wy[2] * e + (wy[3] * f[i] + wy[4] * f1[i]);
      let u1 = wu[0] * y[i] + wu[1] * u0 + wu[2] * e + (wu[3] * f[i] + wu[4] * f1[i]);
      if (Math.abs(y1) < restY && Math.abs(u1) < restU) y1 = u1 = 0;
      const sigma = d * inverse;
      y[i] = y1;
      v[i] = u1 + sigma;
      x[i] = x1[i];
      slope[i] = sigma;
      f[i] = f1[i];
    }
  };
  return best(() => {
    for (let frame = 0; frame < FRAMES; frame++) step(frame % 20 < 10 ? swung : rest, rest);
  }, SPRINGS * FRAMES);
}

/** Chains of `@pixiv/three-vrm-springbone`, per joint. */
async function springBones() {
  const { Object3D } = await import('three');
  const { VRMSpringBoneJoint, VRMSpringBoneManager } = await import('@pixiv/three-vrm-springbone');
  const [chains, length] = [100, 10];
  const manager = new VRMSpringBoneManager();
  const root = new Object3D();
  for (let chain = 0; chain < chains; chain++) {
    let parent = root;
    const bones = Array.from({ length: length + 1 }, () => {
      const bone = new Object3D();
      bone.position.y = -0.1;
      parent.add(bone);
      return (parent = bone);
    });
    for (let i = 0; i < length; i++) {
      manager.addJoint(new VRMSpringBoneJoint(bones[i], bones[i + 1], { stiffness: 1, dragForce: 0.4, gravityPower: 0.1 }));
    }
  }
  root.updateMatrixWorld(true);
  manager.setInitState();
  let frame = 0;
  return best(() => {
    root.position.x = frame++ % 20 < 10 ? 0.01 : 0;
    manager.update(1 / 60);
  }, chains * length);
}

/** The same network in plain loops over `Float32Array`s, µs. */
function plainNetwork() {
  const layers = LAYERS.slice(1).map((outputs, i) => {
    const inputs = LAYERS[i];
    const weights = Float32Array.from({ length: inputs * outputs }, (_, k) => ((k * 37) % 255) * 1e-5 - 1e-3);
    return { inputs, weights, bias: new Float32Array(outputs).fill(0.01), y: new Float32Array(outputs) };
  });
  const x = Float32Array.from({ length: LAYERS[0] }, (_, i) => (i % 17) * 0.05 - 0.4);
  const once = () => {
    let input = x;
    for (const { inputs, weights, bias, y } of layers) {
      for (let row = 0; row < y.length; row++) {
        let sum = bias[row];
        for (let i = 0; i < inputs; i++) sum += weights[row * inputs + i] * input[i];
        y[row] = Math.max(sum, 0);
      }
      input = y;
    }
    x[0] = 1e-3 * input[0];
  };
  return best(() => {
    for (let i = 0; i < NETWORKS; i++) once();
  }, NETWORKS) / 1e3;
}

async function main() {
  const baker = await import('./js/bake.js');
  await baker.init();
  const { asset } = baker.builtin();
  const run = (build) =>
    new Promise((resolve, reject) => {
      const worker = new Worker(new URL(import.meta.url), { workerData: { build, asset } });
      worker.once('message', resolve).once('error', reject);
    });
  // One after the other: they would disturb each other.
  const simd = await run('simd');
  const scalar = await run('scalar');
  const peers = [
    { name: 'plain JavaScript loop', value: plain() },
    { name: '@pixiv/three-vrm-springbone, per joint', value: await springBones() },
  ];
  const loops = [{ name: 'plain JavaScript loop', value: plainNetwork() }];
  const results = [
    { name: 'springs', case: 'wasm simd', value: simd.springs, unit: 'ns/vertex', peers, limit: 8 },
    { name: 'springs', case: 'wasm scalar', value: scalar.springs, unit: 'ns/vertex', peers },
    { name: 'skin', case: 'wasm simd, with normals', value: simd.skin, unit: 'ns/vertex', limit: 12 },
    { name: 'skin', case: 'wasm scalar, with normals', value: scalar.skin, unit: 'ns/vertex' },
    { name: 'network', case: '96-64-64-48, wasm simd', value: simd.network, unit: 'us', peers: loops, limit: 2 },
    { name: 'network', case: '96-64-64-48, wasm scalar', value: scalar.network, unit: 'us', peers: loops },
    { name: 'character-frame', case: 'built-in, wasm simd', value: simd.frame, unit: 'ms' },
    { name: 'character-frame', case: 'built-in, wasm scalar', value: scalar.frame, unit: 'ms' },
  ];
  if (process.argv.includes('--json')) {
    console.log(JSON.stringify({ machine: `Node ${process.version}, ${process.arch}`, results }));
    return;
  }
  for (const { name, case: which, value, unit, limit, peers: others = [] } of results) {
    const beside = others.map((peer) => `, ${peer.name} ${peer.value.toPrecision(3)}`).join('');
    console.log(`${name}, ${which}: ${value.toPrecision(3)} ${unit}${limit ? ` (limit ${limit})` : ''}${beside}`);
  }
}

if (isMainThread) await main();
else parentPort.postMessage(await measure(workerData));
