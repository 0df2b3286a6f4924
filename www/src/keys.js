// The keyboard: one letter each, arrows for the root.
const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const ARROWS_THEIRS = 'input[type=range], select, summary';
const TYPED = 'input:not([type=range]), textarea, select';

/**
 * @param {Record<string, () => void>} actions by key, lower case
 * @param {(x: number, y: number) => void} walk -1..1: right, towards the viewer
 */
export function listen(actions, walk) {
  const held = new Set();
  const tell = () => {
    let [x, y] = [0, 0];
    for (const key of held) {
      x += STEPS[key][0];
      y += STEPS[key][1];
    }
    walk(x, y);
  };
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in STEPS) {
      if (event.target.matches?.(ARROWS_THEIRS)) return;
      event.preventDefault();
      if (held.add(event.key)) tell();
      return;
    }
    if (event.repeat || event.target.matches?.(TYPED)) return;
    if (event.key === ' ' && event.target.matches?.('button, summary')) return; // theirs
    const action = actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  });
  // A button that was clicked would take the space bar from now on.
  addEventListener('click', (event) => {
    if (event.detail > 0) event.target.closest?.('button')?.blur();
  });
  addEventListener('keyup', (event) => {
    if (held.delete(event.key)) tell();
  });
  addEventListener('blur', () => {
    held.clear();
    tell();
  });
}
