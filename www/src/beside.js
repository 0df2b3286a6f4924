// Files that lie beside a .gltf: handed to the page together with it.

const decoded = (uri) => {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri; // a lone percent sign is one
  }
};
const last = (path) => path.split('/').at(-1).toLowerCase();

/**
 * The one of `files` that `uri` means: by its path, else by its name alone, since a browser tells no folders of
 * files that are chosen one by one.
 * @template T @param {Map<string, T>} files by path @returns {T | undefined}
 */
export function findBeside(files, uri) {
  const path = decoded(uri).replaceAll('\\', '/').replace(/^(\.\/)+/, '');
  for (const [own, file] of files) if (own === path || own.endsWith(`/${path}`)) return file;
  for (const [own, file] of files) if (last(own) === last(path)) return file;
  return undefined;
}

/** What a glTF names outside of itself. @returns {string[]} */
export const references = (gltf) => [...(gltf.buffers ?? []), ...(gltf.images ?? [])]
  .map(({ uri }) => uri)
  .filter((uri) => uri && !/^(data|blob):/.test(uri));
