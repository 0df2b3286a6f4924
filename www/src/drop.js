// Files: dropped anywhere, or chosen.

/** Calls `open(file)` for every file that a person hands to the page. */
export function acceptFiles(open) {
  const input = document.querySelector('#file');
  const choose = () => input.click();
  document.querySelector('#open').addEventListener('click', choose);
  input.addEventListener('change', () => {
    if (input.files.length) open(best(input.files));
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
    if (event.dataTransfer.files.length) open(best(event.dataTransfer.files));
  });
  return choose;
}

/** Of several files, the model. */
const best = (files) => [...files].find(({ name }) => /\.(glb|gltf|vrm)$/i.test(name)) ?? files[0];
