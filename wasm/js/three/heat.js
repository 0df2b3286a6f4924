import { BufferAttribute, DynamicDrawUsage, MeshStandardMaterial } from 'three';

// Linear RGB. Each is darker than the one before, so that eyes which miss a hue still tell them apart.
export const heatStops = [
  [0.53, 0.57, 0.63],
  [0.85, 0.5, 0.09],
  [0.78, 0.17, 0.05],
  [0.5, 0.03, 0.14],
  [0.13, 0.01, 0.24],
];
const STEPS = 255;

/** `STEPS + 1` colours, one after the other. */
function ramp() {
  const out = new Float32Array(3 * (STEPS + 1));
  for (let i = 0; i <= STEPS; i++) {
    const at = (i / STEPS) * (heatStops.length - 1);
    const low = Math.min(Math.floor(at), heatStops.length - 2);
    const [from, to] = [heatStops[low], heatStops[low + 1]];
    for (let c = 0; c < 3; c++) out[3 * i + c] = from[c] + (at - low) * (to[c] - from[c]);
  }
  return out;
}

/** The colour of a share of the largest offset; its root, since ordinary motion needs only a small share. */
const step = (share) => (share > 0 ? Math.round(STEPS * Math.sqrt(Math.min(share, 1))) : 0);

/** Colours meshes by how far their flesh is from rest. */
export class Heat {
  #parts;
  #ramp = ramp();

  constructor(fleshMeshes) {
    this.#parts = fleshMeshes.map((flesh) => {
      const { mesh, geometry } = flesh;
      const before = { material: mesh.material, color: geometry.attributes.color };
      const color = new BufferAttribute(new Float32Array(3 * geometry.attributes.position.count), 3);
      const { side } = [mesh.material].flat()[0];
      const material = new MeshStandardMaterial({ vertexColors: true, roughness: 0.9, side });
      return { flesh, before, color: color.setUsage(DynamicDrawUsage), material };
    });
  }

  update(heat) {
    for (const { flesh, color } of this.#parts) {
      const part = flesh.part(heat, 1);
      for (let i = 0; i < part.length; i++) {
        const from = 3 * step(part[i]);
        for (let c = 0; c < 3; c++) color.array[3 * i + c] = this.#ramp[from + c];
      }
      color.needsUpdate = true;
    }
  }

  show() {
    for (const { flesh, color, material } of this.#parts) {
      flesh.geometry.setAttribute('color', color);
      flesh.mesh.material = material;
    }
  }

  hide() {
    for (const { flesh, before, material } of this.#parts) {
      if (before.color) flesh.geometry.setAttribute('color', before.color);
      else flesh.geometry.deleteAttribute('color');
      if (flesh.mesh.material === material) flesh.mesh.material = before.material;
    }
  }

  dispose() {
    this.hide();
    this.#parts.forEach(({ material }) => material.dispose());
  }
}
