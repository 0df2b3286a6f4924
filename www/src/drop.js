// Files: dropped anywhere, or chosen.

const MOST_FILES = 500;

/** Calls `open(files)`, files by path, whenever a person hands some to the page. */
export function acceptFiles(open) {
  const input = document.querySelector('#file');
  const choose = () => input.click();
  document.querySelector('#open').addEventListener('click', choose);
  input.addEventListener('change', () => {
    if (input.files.length) open(byName(input.files));
    input.value = ''; // the same file may be chosen again
  });

  let depth = 0; // enter and leave are told for every element passed
  const dropping = (on) => document.body.classList.toggle('dropping', on);
  const carriesFiles = (event) => event.dataTransfer?.types.includes('Files');
  addEventListener('dragenter', (event) => {
    if (!carriesFiles(event)) return;
    depth += 1;
    dropping(true);
  });
  addEventListener('dragleave', () => {
    depth = Math.max(0, depth - 1);
    if (depth === 0) dropping(false);
  });
  addEventListener('dragover', (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    event.dataTransfer.dropEffect = 'copy';
  });
  addEventListener('drop', (event) => {
    depth = 0;
    dropping(false);
    if (!carriesFiles(event)) return;
    event.preventDefault();
    // Both are emptied when this listener returns.
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry?.());
    const plain = byName(event.dataTransfer.files);
    const found = entries.some((entry) => entry?.isDirectory) ? within(entries) : Promise.resolve(plain);
    found.catch(() => plain).then((files) => { if (files.size) open(files); });
  });
  return choose;
}

const byName = (files) => new Map([...files].map((file) => [file.name, file]));

/** Everything in folders. */
async function within(entries, out = new Map()) {
  for (const entry of entries.filter(Boolean)) {
    if (out.size >= MOST_FILES) break; // somebody's whole disk
    if (entry.isFile) out.set(entry.fullPath.slice(1), await new Promise((resolve, reject) => entry.file(resolve, reject)));
    else await within(await listing(entry.createReader()), out);
  }
  return out;
}

/** A reader gives some at a time, and none when it is done. */
async function listing(reader) {
  const out = [];
  for (;;) {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return out;
    out.push(...some);
  }
}

/** Of several files, the model. @param {Map<string, File>} files */
export const modelAmong = (files) => [...files.values()].find(({ name }) => /\.(glb|gltf|vrm)$/i.test(name)) ?? [...files.values()][0];
