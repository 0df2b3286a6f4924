// What the tests may look at, as `window.sinew`. Not an interface to build on.

/** @param {import('./main.js').Page} page */
export const hooks = (page, { version, simd }) => ({
  page,
  version,
  simd,
  get state() {
    const { actor, panel, replay, frames, playing, speed, stage, motion } = page;
    return {
      name: actor.name,
      clips: actor.clips,
      clip: actor.clip,
      flesh: panel.flesh.on,
      side: panel.side.on,
      heat: panel.heat.on,
      recording: replay.recording,
      recorded: replay.bytes?.length ?? 0,
      tunables: actor.character.tunables,
      root: motion.offset.toArray(),
      unit: stage.unit,
      frames,
      playing,
      speed,
    };
  },
  /** Bind-space positions as the graphics card gets them. @param {boolean} [twin] of the body without flesh */
  positions(twin = false) {
    const out = [];
    (twin ? page.actor.twin.root : page.actor.model).traverse((node) => {
      if (!node.isSkinnedMesh) return;
      const { position } = node.geometry.attributes; // may be interleaved with others
      for (let i = 0; i < position.count; i++) out.push(position.getX(i), position.getY(i), position.getZ(i));
    });
    return out;
  },
  /** The picture at its best, until slow frames lower it again. */
  sharpen: () => page.quality.raise(),
  /** The replay at hand, with `change(bytes)` done to a copy, verified. */
  verify(change = () => {}) {
    const bytes = page.replay.bytes.slice();
    change(bytes);
    return page.replay.verify(bytes);
  },
});
