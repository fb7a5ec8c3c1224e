// The scene's triangles, bit for bit.
import { unpack, type ViewData } from './data';
import { emptyBox, type Box, type Vec } from './vec';

export interface Mesh {
  /** x, y, z of each vertex. */
  positions: Float32Array;
  /** Three vertices of each triangle. */
  corners: Uint32Array;
  box: Box;
}

export async function loadMesh(data: ViewData): Promise<Mesh> {
  const arrays = await unpack(data.mesh);
  const positions = new Float32Array(3 * data.vertices);
  [arrays.x, arrays.y, arrays.z].forEach((values, axis) => {
    for (let i = 0; i < values.length; ++i) positions[3 * i + axis] = values[i];
  });
  const corners = arrays.corners as Uint32Array;
  const box = emptyBox();
  for (const corner of corners)
    for (let axis = 0; axis < 3; ++axis) {
      const x = positions[3 * corner + axis];
      if (x < box.lo[axis]) box.lo[axis] = x;
      if (x > box.hi[axis]) box.hi[axis] = x;
    }
  return { positions, corners, box };
}

export function vertex(mesh: Mesh, triangle: number, corner: number): Vec {
  const at = 3 * mesh.corners[3 * triangle + corner];
  return [mesh.positions[at], mesh.positions[at + 1], mesh.positions[at + 2]];
}
