// Costs or visits of a picture's pixels, computed in slices so that the page stays alive.
import { pixelRay, type Area } from './area';
import type { Costs } from './data';
import type { Mesh } from './mesh';
import type { Tree } from './tree';
import { costOf, search } from './walk';

export interface CostImage {
  width: number;
  height: number;
  cost: Float32Array;
}

/** In the proportions of the area's window, the longer side `longest` pixels. */
export function imageSize(area: Area, longest: number): { width: number; height: number } {
  const [x, y] = area.half;
  const scale = longest / Math.max(x, y);
  return { width: Math.max(16, Math.round(x * scale)), height: Math.max(16, Math.round(y * scale)) };
}

export interface HeatOptions {
  area: Area;
  size: number;
  pruned: boolean;
  /** Count boxes instead of costs. */
  visits: boolean;
  costs: Costs;
  /** Told the finished share; false ends it. */
  progress: (done: number) => boolean;
}

const SLICE = 30; // milliseconds
const pause = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

export async function costImage(tree: Tree, mesh: Mesh, options: HeatOptions): Promise<CostImage | null> {
  const { width, height } = imageSize(options.area, options.size);
  const cost = new Float32Array(width * height);
  let began = performance.now();
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      const ray = pixelRay(options.area, width, height, column, row);
      const { counts } = search(tree, mesh, ray, options.pruned);
      cost[row * width + column] = options.visits ? counts.inner + counts.leaves : costOf(counts, options.costs);
    }
    if (performance.now() - began < SLICE) continue;
    if (!options.progress((row + 1) / height)) return null;
    await pause();
    began = performance.now();
  }
  return { width, height, cost };
}

/** What all but one in a hundred stay below: scales end there. */
export function highPercentile(values: Float32Array[]): number {
  const sorted = Float32Array.from(values.flatMap((list) => Array.from(list))).sort();
  return sorted.length > 0 ? sorted[Math.min(sorted.length - 1, Math.floor(0.99 * sorted.length))] : 0;
}

export function meanOf(values: Float32Array): number {
  let sum = 0;
  for (const value of values) sum += value;
  return values.length > 0 ? sum / values.length : 0;
}

/** How many values fall into each of `bins` equal steps of [0, end]; the last takes what lies above. */
export function histogram(values: Float32Array, end: number, bins: number): number[] {
  const counts = new Array<number>(bins).fill(0);
  for (const value of values) counts[Math.min(bins - 1, Math.floor((value / (end || 1)) * bins))] += 1;
  return counts;
}
