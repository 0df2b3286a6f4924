// Names below the two bodies when they stand side by side.
import * as THREE from 'three';

const [plain, flesh] = document.querySelectorAll('#labels .label');
const point = new THREE.Vector3();

export function placeLabels(stage, actor) {
  if (!actor.side) return;
  const [own, twin] = actor.feet();
  for (const [label, foot] of [[flesh, own], [plain, twin]]) {
    point.set(foot.x, stage.ground.position.y - 0.05 * stage.unit, foot.z + 0.25 * stage.unit);
    const { x, y } = stage.project(point);
    label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, 40%)`;
  }
}
