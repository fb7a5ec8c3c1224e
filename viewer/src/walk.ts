// The program's search of a binary tree, step by step, so that it meets the same boxes: src/trace/walk.h and slabs.h
// have the reasons. Boxes are float32, everything else is double.
import type { Costs } from './data';
import { vertex, type Mesh } from './mesh';
import type { Tree } from './tree';
import { intersectTriangle } from './triangle';
import { isValidRay, type Ray } from './vec';

const PADDING = 2 ** -50;
const floatView = new Float32Array(1);
const bitsView = new Int32Array(floatView.buffer);

/** The next float32 above or below. */
function nextFloat(x: number, up: boolean): number {
  if (Number.isNaN(x) || x === (up ? Infinity : -Infinity)) return x;
  floatView[0] = x;
  if (x === 0) bitsView[0] = up ? 1 : -0x7fffffff;
  else bitsView[0] += x > 0 === up ? 1 : -1;
  return floatView[0];
}

/** What one search met. */
export interface Counts {
  inner: number;
  leaves: number;
  triangles: number;
  boxTests: number;
}

export interface Nearest {
  t: number;
  triangle: number;
}

export interface Search {
  counts: Counts;
  hit: Nearest | null;
}

export const costOf = (counts: Counts, costs: Costs): number => costs.inner * counts.inner + costs.triangle * counts.triangles;

const stackNodes = new Int32Array(512);
const stackEntries = new Float64Array(512);

/**
 * Nearest hit and counts. Without `prune` everything that the ray meets is visited: the paper's real cost. `visit` is
 * told every node whose box is met.
 */
export function search(tree: Tree, mesh: Mesh, ray: Ray, prune: boolean, visit?: (node: number) => void): Search {
  const counts: Counts = { inner: 0, leaves: 0, triangles: 0, boxTests: 0 };
  const result: Search = { counts, hit: null };
  if (!isValidRay(ray) || !(ray.tmin <= ray.tmax)) return result;
  const { boxes, count, first, prims } = tree;
  const [ox, oy, oz] = ray.origin;
  const inverse = ray.direction.map((x) => (x === 0 ? Infinity : 1 / x));
  const [ix, iy, iz] = inverse;
  const nearX = ix < 0 ? 3 : 0;
  const nearY = iy < 0 ? 4 : 1;
  const nearZ = iz < 0 ? 5 : 2;
  const farX = 3 - nearX;
  const farY = 5 - nearY;
  const farZ = 7 - nearZ;
  const limited: Ray = { ...ray };
  const earliest = nextFloat(ray.tmin, false);
  let latest = nextFloat(ray.tmax, true);

  /** Where the ray enters a box that it meets within its limits; NaN where it does not. */
  const meet = (node: number): number => {
    const at = 6 * node;
    let entry = -Infinity;
    let exit = Infinity;
    let t = (boxes[at + nearX] - ox) * ix;
    if (t > entry) entry = t;
    t = (boxes[at + farX] - ox) * ix;
    if (t < exit) exit = t;
    t = (boxes[at + nearY] - oy) * iy;
    if (t > entry) entry = t;
    t = (boxes[at + farY] - oy) * iy;
    if (t < exit) exit = t;
    t = (boxes[at + nearZ] - oz) * iz;
    if (t > entry) entry = t;
    t = (boxes[at + farZ] - oz) * iz;
    if (t < exit) exit = t;
    entry -= PADDING * Math.abs(entry);
    exit += PADDING * Math.abs(exit);
    return entry <= exit && entry <= latest && exit >= earliest ? entry : NaN;
  };
  const testTriangles = (leaf: number): void => {
    for (let i = first[leaf]; i < first[leaf] + count[leaf]; ++i) {
      const triangle = prims[i];
      const hit = intersectTriangle(limited, vertex(mesh, triangle, 0), vertex(mesh, triangle, 1), vertex(mesh, triangle, 2));
      const best = result.hit;
      if (!hit || (best && !(hit.t < best.t || (hit.t === best.t && triangle < best.triangle)))) continue;
      result.hit = { t: hit.t, triangle };
      limited.tmax = Math.min(limited.tmax, hit.t);
      if (prune) latest = nextFloat(limited.tmax, true);
    }
  };

  let size = 0;
  let node = 0;
  counts.boxTests = 1;
  if (Number.isNaN(meet(0))) return result;
  for (;;) {
    visit?.(node);
    if (count[node] !== 0) {
      counts.leaves += 1;
      counts.triangles += count[node];
      testTriangles(node);
    } else {
      counts.inner += 1;
      counts.boxTests += 2;
      const left = meet(first[node]);
      const right = meet(first[node] + 1);
      const meetsLeft = !Number.isNaN(left);
      const meetsRight = !Number.isNaN(right);
      const rightFirst = meetsRight && (!meetsLeft || right < left);
      if (meetsLeft && meetsRight) {
        stackNodes[size] = first[node] + (rightFirst ? 0 : 1);
        stackEntries[size++] = rightFirst ? left : right;
      }
      node = first[node] + (rightFirst ? 1 : 0);
      if (meetsLeft || meetsRight) continue;
    }
    do {
      if (size === 0) return result;
      size -= 1;
    } while (stackEntries[size] > latest);
    node = stackNodes[size];
  }
}
