// Which objects of three.js are which nodes, meshes and primitives of the file.

/** The objects that move the asset's joints, in its order. */
export function findJoints({ parser }, asset) {
  const objects = new Map();
  for (const [object, known] of parser.associations) {
    // A material made by the loader, as for a mesh without normals, is associated with nothing.
    if (object.isObject3D && known?.nodes !== undefined) objects.set(known.nodes, object);
  }
  return Array.from(asset.jointNodes, (node) => {
    const object = objects.get(node);
    if (object === undefined) throw new Error(`the file has no node ${node}: is this the asset of another file?`);
    return object;
  });
}

/** The skinned meshes, each with its row of `asset.primitives`. */
export function findMeshes({ scene, parser }, asset) {
  const found = [];
  scene.traverse((mesh) => {
    if (!mesh.isSkinnedMesh) return;
    const { meshes, primitives = 0, nodes } = parser.associations.get(mesh) ?? {};
    // One of several primitives hangs below its node.
    const node = nodes ?? parser.associations.get(mesh.parent)?.nodes;
    const rows = asset.primitives.filter((row) => row.mesh === meshes && row.primitive === primitives);
    // The node tells instances of a mesh apart; a lone one may hang elsewhere in a file made anew.
    const primitive = rows.length > 1 ? rows.find((row) => row.node === node) : rows[0];
    if (primitive === undefined) return; // not baked: lines, points, or a file of several scenes
    const { count } = mesh.geometry.attributes.position;
    if (count !== primitive.count) {
      throw new Error(
        `mesh ${meshes}, primitive ${primitives} has ${count} vertices, the asset ${primitive.count}: ` +
          'is this the asset of another file?',
      );
    }
    found.push({ mesh, primitive });
  });
  if (found.length === 0) throw new Error('no skinned mesh of the file is in the asset');
  return found;
}
