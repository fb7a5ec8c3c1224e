// What rays pay in a tree, as `raygrain analyze` counts it.
import { serves, areaRay, type Area } from './area';
import type { Costs } from './data';
import type { Mesh } from './mesh';
import type { Tree } from './tree';
import type { Ray } from './vec';
import { costOf, search, type Nearest } from './walk';

/** Means per ray; `full` without pruning. Names are those of the program's fields. */
export interface RayStats {
  rays: number;
  hits: number;
  real_cost: number;
  pruned_cost: number;
  hit_ratio: number;
  inner_hits: number;
  leaf_hits: number;
  leaf_triangles: number;
  /** Of each ray. */
  nearest: (Nearest | null)[];
  realCosts: Float64Array;
  prunedCosts: Float64Array;
}

/** The first `count` rays of the seed that the area serves, as the analyzer takes them. */
export function castRays(area: Area, seed: bigint, count: number): Ray[] {
  return Array.from({ length: count }, (_, i) => areaRay(area, seed, i)).filter((ray) => serves(area, ray));
}

export function measureRays(tree: Tree, mesh: Mesh, rays: Ray[], costs: Costs): RayStats {
  const sums = { inner: 0, leaves: 0, triangles: 0, prunedInner: 0, prunedTriangles: 0 };
  const nearest: (Nearest | null)[] = [];
  const realCosts = new Float64Array(rays.length);
  const prunedCosts = new Float64Array(rays.length);
  rays.forEach((ray, i) => {
    const full = search(tree, mesh, ray, false);
    const pruned = search(tree, mesh, ray, true);
    nearest.push(full.hit);
    realCosts[i] = costOf(full.counts, costs);
    prunedCosts[i] = costOf(pruned.counts, costs);
    sums.inner += full.counts.inner;
    sums.leaves += full.counts.leaves;
    sums.triangles += full.counts.triangles;
    sums.prunedInner += pruned.counts.inner;
    sums.prunedTriangles += pruned.counts.triangles;
  });
  const hits = nearest.filter((hit) => hit !== null).length;
  const mean = (sum: number): number => (rays.length > 0 ? sum / rays.length : 0);
  return {
    rays: rays.length,
    hits,
    real_cost: mean(costs.inner * sums.inner + costs.triangle * sums.triangles),
    pruned_cost: mean(costs.inner * sums.prunedInner + costs.triangle * sums.prunedTriangles),
    hit_ratio: mean(hits),
    inner_hits: mean(sums.inner),
    leaf_hits: mean(sums.leaves),
    leaf_triangles: mean(sums.triangles),
    nearest,
    realCosts,
    prunedCosts,
  };
}
