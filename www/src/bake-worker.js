// The baker, in a thread of its own, so that the page stays alive meanwhile.
import { bake, builtin, init } from 'sinew-wasm/bake';

const ready = init();
const tasks = {
  bake: ({ bytes, name }) => bake(bytes, name),
  builtin: () => builtin(),
};

addEventListener('message', async ({ data: { id, task, ...input } }) => {
  try {
    await ready;
    const result = await tasks[task](input);
    postMessage({ id, result });
  } catch (error) {
    postMessage({ id, error: error?.message ?? String(error) });
  }
});
