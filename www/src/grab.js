// The pointer on the character: takes hold of it. Beside it, the camera's own controls go on.
import * as THREE from 'three';

/**
 * @param {import('./stage.js').Stage} stage
 * @param {import('./motion.js').RootMotion} motion
 * @param {() => import('./actor.js').Actor | null} current
 */
export function allowGrabbing(stage, motion, current) {
  const { canvas } = stage;
  const plane = new THREE.Plane();
  const start = new THREE.Vector3();
  const point = new THREE.Vector3();
  let pointer = null;
  let hoverDue = 0;

  const hits = (event) => Boolean(current()?.hit(stage.ray(event), point));

  canvas.addEventListener('pointerdown', (event) => {
    if (pointer !== null || event.button !== 0 || !event.isPrimary || !hits(event)) return;
    pointer = event.pointerId;
    start.copy(point);
    plane.setFromNormalAndCoplanarPoint(stage.camera.getWorldDirection(new THREE.Vector3()), start);
    motion.grab();
    stage.controls.enabled = false; // before its own listener, which comes after this one
    canvas.setPointerCapture(pointer);
    canvas.classList.add('grabbing');
  }, { capture: true });

  canvas.addEventListener('pointermove', (event) => {
    if (event.pointerId === pointer) {
      if (stage.ray(event).ray.intersectPlane(plane, point)) motion.drag(point.sub(start));
    } else if (event.pointerType === 'mouse' && event.buttons === 0 && event.timeStamp > hoverDue) {
      const began = performance.now();
      canvas.classList.toggle('can-grab', hits(event));
      // Meeting a big mesh costs milliseconds: look rarely there.
      hoverDue = event.timeStamp + 80 + 20 * (performance.now() - began);
    }
  });

  const release = (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    motion.release();
    stage.controls.enabled = true;
    canvas.classList.remove('grabbing');
  };
  for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) canvas.addEventListener(name, release);
}
