// What the colors of the heat map stand for.
import { heatStops } from 'sinew-wasm/three';

const css = ([r, g, b]) => `color(srgb-linear ${r} ${g} ${b})`;

export function drawLegend() {
  document.querySelector('#legend i').style.background = `linear-gradient(in srgb-linear to right, ${heatStops.map(css)})`;
  const shares = heatStops.map((_, i) => (i / (heatStops.length - 1)) ** 2); // the colors go along the root
  document.querySelector('#legend ol').replaceChildren(...shares.map((share) => {
    const item = document.createElement('li');
    item.textContent = share === 0 ? 'rest' : `${Math.round(100 * share)} %`;
    return item;
  }));
}
