// What lies below the pointer.
import type { App } from './app';
import type { Tree } from './tree';
import type { Box, Ray, Vec } from './vec';
import { search } from './walk';

/** Where a ray enters a box, or infinity; the start counts where the ray begins inside. */
function entryOf(origin: Vec, direction: Vec, box: ArrayLike<number>): number {
  let entry = -Infinity;
  let exit = Infinity;
  for (let axis = 0; axis < 3; ++axis) {
    const a = (box[axis] - origin[axis]) / direction[axis];
    const b = (box[axis + 3] - origin[axis]) / direction[axis];
    if (direction[axis] === 0) {
      if (origin[axis] < box[axis] || origin[axis] > box[axis + 3]) return Infinity;
      continue;
    }
    entry = Math.max(entry, Math.min(a, b));
    exit = Math.min(exit, Math.max(a, b));
  }
  return entry <= exit && exit >= 0 ? entry : Infinity;
}

const volume = (b: ArrayLike<number>): number => (b[3] - b[0]) * (b[4] - b[1]) * (b[5] - b[2]);

/** The nearest of the drawn boxes, the smallest of those as near; else the leaf of the triangle that is seen. */
function nodeAt(app: App, pane: number, origin: Vec, direction: Vec): number {
  const { tree, shown } = app.panes[pane];
  if (!tree) return -1;
  let best = -1;
  let bestEntry = Infinity;
  for (const node of shown.nodes) {
    const box = tree.boxes.subarray(6 * node, 6 * node + 6);
    const entry = entryOf(origin, direction, box);
    if (entry === Infinity || entry > bestEntry) continue;
    if (entry === bestEntry && best >= 0 && volume(box) >= volume(tree.boxes.subarray(6 * best, 6 * best + 6))) continue;
    best = node;
    bestEntry = entry;
  }
  return best >= 0 ? best : leafAt(app, tree, { origin, direction, tmin: 0, tmax: Infinity });
}

function leafAt(app: App, tree: Tree, ray: Ray): number {
  const float: Ray = { ...ray, origin: ray.origin.map(Math.fround) as Vec, direction: ray.direction.map(Math.fround) as Vec };
  const visited: number[] = [];
  const { hit } = search(tree, app.mesh, float, true, (node) => visited.push(node));
  if (!hit) return -1;
  const holds = (node: number): boolean => {
    for (let i = 0; i < tree.count[node]; ++i) if (tree.prims[tree.first[node] + i] === hit.triangle) return true;
    return false;
  };
  return visited.find((node) => tree.count[node] > 0 && holds(node)) ?? -1;
}

function cellAt(app: App, origin: Vec, direction: Vec): number {
  let best = -1;
  let bestEntry = Infinity;
  app.top.leaves.forEach((cell, i) => {
    if (cell.areas.length === 0) return;
    const flat = (box: Box): number[] => [...box.lo, ...box.hi];
    const entry = entryOf(origin, direction, flat(cell.box));
    if (entry >= bestEntry) return;
    best = i;
    bestEntry = entry;
  });
  return best;
}

function pick(app: App, x: number, y: number): void {
  const { pane, origin, direction } = app.stage.rayAt(x, y);
  if (app.state.top !== 'none' && app.state.show === 'none') app.store.set({ cell: cellAt(app, origin, direction) });
  else app.choose(pane, nodeAt(app, pane, origin, direction));
}

const NEAR = 9; // pixels

/** The drawn ray that passes nearest to a place of the page, or -1. */
function rayNear(app: App, x: number, y: number): number {
  const { pane } = app.stage.rayAt(x, y);
  let best = -1;
  let bestDistance = NEAR;
  for (let i = 0; i < app.rays.length; ++i) {
    const { from, to } = app.raySegment(i);
    const a = app.stage.project(from, pane);
    const b = app.stage.project(to, pane);
    if (!a || !b) continue;
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const t = Math.min(Math.max(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy || 1), 0), 1);
    const distance = Math.hypot(a[0] + dx * t - x, a[1] + dy * t - y);
    if (distance >= bestDistance) continue;
    best = i;
    bestDistance = distance;
  }
  return best;
}

/** Clicks choose, hovering lights up rays. `told` hears which ray, and how many boxes it visits. */
export function listen(app: App, told: (ray: number, visited: number[]) => void): void {
  const canvas = app.stage.canvas;
  let down: [number, number] | null = null;
  let lit = -1;
  canvas.addEventListener('pointerdown', (event) => (down = [event.clientX, event.clientY]));
  canvas.addEventListener('pointerup', (event) => {
    if (down && event.button === 0 && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5) pick(app, event.clientX, event.clientY);
    down = null;
  });
  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0 || app.rays.length === 0) return;
    const ray = rayNear(app, event.clientX, event.clientY);
    if (ray === lit) return;
    lit = ray;
    told(ray, app.highlightRay(ray));
  });
}
