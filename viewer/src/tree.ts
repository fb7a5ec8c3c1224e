// A tree as the page walks it: links and boxes in flat arrays, by the program's node numbers.
import { unpack, type Numbers, type TreeInfo } from './data';
import type { Mesh } from './mesh';
import type { Box } from './vec';

export interface Tree {
  info: TreeInfo;
  size: number;
  /** Triangles of a leaf; 0 for an inner node. */
  count: Uint32Array;
  /** The first of two children, or the first place in `prims`. */
  first: Uint32Array;
  prims: Uint32Array;
  /** lo and hi of each node. */
  boxes: Float32Array;
  parent: Int32Array;
  level: Uint16Array;
  maxLevel: number;
  measure: Float32Array;
  /** 0 ... 2, 3 for leaves; + 4 split by the fallback; + 8 forced to it. Null where nobody knows. */
  axis: Uint8Array | null;
  /** Of inner nodes only, by node; null where nobody knows. */
  quality: Float32Array | null;
}

function joinLinks(count: Uint32Array, children: Numbers, starts: Numbers): Uint32Array {
  const first = new Uint32Array(count.length);
  for (let i = 0, inner = 0, leaf = 0; i < count.length; ++i) first[i] = count[i] === 0 ? children[inner++] : starts[leaf++];
  return first;
}

/** Boxes from the leaves up: children stand after their parents. */
function computeBoxes(mesh: Mesh, count: Uint32Array, first: Uint32Array, prims: Uint32Array): Float32Array {
  const boxes = new Float32Array(6 * count.length);
  const { positions, corners } = mesh;
  for (let node = count.length - 1; node >= 0; --node) {
    const to = 6 * node;
    for (let axis = 0; axis < 3; ++axis) {
      let lo = Infinity;
      let hi = -Infinity;
      if (count[node] === 0) {
        const child = 6 * first[node] + axis;
        lo = Math.min(boxes[child], boxes[child + 6]);
        hi = Math.max(boxes[child + 3], boxes[child + 9]);
      } else {
        for (let i = first[node]; i < first[node] + count[node]; ++i)
          for (let corner = 0; corner < 3; ++corner) {
            const x = positions[3 * corners[3 * prims[i] + corner] + axis];
            if (x < lo) lo = x;
            if (x > hi) hi = x;
          }
      }
      boxes[to + axis] = lo;
      boxes[to + axis + 3] = hi;
    }
  }
  return boxes;
}

function spreadQualities(count: Uint32Array, values: Numbers | undefined): Float32Array | null {
  if (!values) return null;
  const spread = new Float32Array(count.length);
  for (let i = 0, inner = 0; i < count.length; ++i) if (count[i] === 0) spread[i] = values[inner++];
  return spread;
}

export async function loadTree(info: TreeInfo, mesh: Mesh): Promise<Tree> {
  const arrays = await unpack(info.data);
  const count = arrays.count as Uint32Array;
  const first = joinLinks(count, arrays.children, arrays.starts);
  const prims = arrays.prims as Uint32Array;
  const parent = new Int32Array(count.length).fill(-1);
  const level = new Uint16Array(count.length);
  let maxLevel = 0;
  for (let node = 0; node < count.length; ++node) {
    maxLevel = Math.max(maxLevel, level[node]);
    if (count[node] !== 0) continue;
    for (const child of [first[node], first[node] + 1]) {
      parent[child] = node;
      level[child] = level[node] + 1;
    }
  }
  return {
    info,
    size: count.length,
    count,
    first,
    prims,
    boxes: (arrays.boxes as Float32Array | undefined) ?? computeBoxes(mesh, count, first, prims),
    parent,
    level,
    maxLevel,
    measure: arrays.measure as Float32Array,
    axis: (arrays.axis as Uint8Array | undefined) ?? null,
    quality: spreadQualities(count, arrays.quality),
  };
}

export const isLeaf = (tree: Tree, node: number): boolean => tree.count[node] !== 0;

export function boxOf(tree: Tree, node: number): Box {
  const b = tree.boxes.subarray(6 * node, 6 * node + 6);
  return { lo: [b[0], b[1], b[2]], hi: [b[3], b[4], b[5]] };
}

export function siblingOf(tree: Tree, node: number): number {
  const parent = tree.parent[node];
  return parent < 0 ? -1 : 2 * tree.first[parent] + 1 - node;
}

/** The triangles below a node. */
export function trianglesBelow(tree: Tree, node: number): number[] {
  const triangles: number[] = [];
  const open = [node];
  while (open.length > 0) {
    const next = open.pop() as number;
    if (isLeaf(tree, next)) for (let i = 0; i < tree.count[next]; ++i) triangles.push(tree.prims[tree.first[next] + i]);
    else open.push(tree.first[next] + 1, tree.first[next]);
  }
  return triangles;
}

/** measure / total, at most 1: the probability that a ray of the distribution meets the node. */
export function probabilityOf(tree: Tree, node: number): number {
  return tree.info.total > 0 ? Math.min(tree.measure[node] / tree.info.total, 1) : 0;
}
