// A labelled slider that shows its value.

/**
 * @param {object} how
 * @param {string} how.label
 * @param {number} how.min
 * @param {number} how.max
 * @param {boolean} [how.log] equal steps are equal factors
 * @param {(value: number) => string} [how.show]
 * @param {(value: number) => void} how.change called while it moves
 * @param {string} [how.id]
 * @returns {{ element: HTMLElement, set(value: number): void }} `set` moves it without calling `change`
 */
export function slider({ label, min, max, log = false, show = (x) => x.toFixed(2), change, id }) {
  const element = document.createElement('label');
  element.className = 'slider';
  const [name, input, output] = ['span', 'input', 'output'].map((tag) => document.createElement(tag));
  name.textContent = label;
  Object.assign(input, { type: 'range', min: 0, max: 1, step: 'any' });
  if (id) input.id = id;
  output.setAttribute('aria-hidden', 'true'); // told as the slider's own value
  element.append(name, input, output);

  const toValue = (share) => (log ? min * (max / min) ** share : min + (max - min) * share);
  const toShare = (value) => (log ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min));
  const tell = (value) => {
    output.textContent = show(value);
    input.setAttribute('aria-valuetext', show(value));
    input.style.setProperty('--filled', `${100 * input.value}%`);
  };
  // `step=any` gives the arrow keys no step of their own worth having.
  input.addEventListener('keydown', (event) => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -5, PageUp: 5 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    input.value = Number(input.value) + 0.02 * by;
    input.dispatchEvent(new Event('input'));
  });
  input.addEventListener('input', () => {
    const value = toValue(Number(input.value));
    tell(value);
    change(value);
  });
  return {
    element,
    set(value) {
      input.value = Math.min(1, Math.max(0, toShare(value)));
      tell(value);
    },
  };
}
