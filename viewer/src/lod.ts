// A coarser mesh for redrawing while the camera moves: vertices of one grid cell become one (Rossignac and Borrel,
// "Multi-resolution 3D approximations for rendering complex scenes", 1993).
import type { Mesh } from './mesh';

const CELLS = 160; // along the longest side

/** Triangles over the mesh's own vertices; those that collapse are gone. */
export function coarseCorners(mesh: Mesh): Uint32Array {
  const { lo, hi } = mesh.box;
  const size = Math.max(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]) || 1;
  const scale = CELLS / size;
  const { positions, corners } = mesh;
  const keeper = new Map<number, number>();
  const standIn = new Uint32Array(positions.length / 3);
  for (let i = 0; i < standIn.length; ++i) {
    const cell = [0, 1, 2].map((axis) => Math.floor((positions[3 * i + axis] - lo[axis]) * scale));
    const key = (cell[0] * 1024 + cell[1]) * 1024 + cell[2];
    const known = keeper.get(key);
    if (known === undefined) keeper.set(key, i);
    standIn[i] = known ?? i;
  }
  const kept = new Uint32Array(corners.length);
  let count = 0;
  for (let i = 0; i < corners.length; i += 3) {
    const a = standIn[corners[i]];
    const b = standIn[corners[i + 1]];
    const c = standIn[corners[i + 2]];
    if (a === b || b === c || c === a) continue;
    kept[count++] = a;
    kept[count++] = b;
    kept[count++] = c;
  }
  return kept.slice(0, count);
}
