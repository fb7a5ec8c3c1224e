// Influence areas: frames, windows, the rays that follow them, and how large boxes look to those rays.
import { clipToWindow, convexHull, intersectConvex, polygonArea, type Polygon } from './polygon';
import { rayRandom } from './random';
import { add, dot, length, normalized, scaled, sub, toFloat, largestComponent, type Box, type Ray, type Vec, type Vec2 } from './vec';

/** As the program describes one; `half` is the window's, `planes` are normals with offsets. */
export interface Area {
  name: string;
  kind: 'plane' | 'point';
  origin: Vec;
  right: Vec;
  up: Vec;
  forward: Vec;
  half: Vec2;
  near: number;
  far: number;
  tolerance: number;
  slack: number;
  planes: [number, number, number, number][];
  corners: Vec[];
}

const toWorldDirection = (area: Area, v: Vec): Vec =>
  add(add(scaled(area.right, v[0]), scaled(area.up, v[1])), scaled(area.forward, v[2]));
const toWorld = (area: Area, p: Vec): Vec => add(area.origin, toWorldDirection(area, p));

export function toLocal(area: Area, p: Vec): Vec {
  const v = sub(p, area.origin);
  return [dot(v, area.right), dot(v, area.up), dot(v, area.forward)];
}

/** A place in the window and the start of its ray. */
function windowRay(area: Area, x: number, y: number): { origin: Vec; direction: Vec } {
  if (area.kind === 'plane') return { origin: [x, y, 0], direction: area.forward };
  const through: Vec = [x, y, 1];
  return { origin: scaled(through, area.near), direction: normalized(toWorldDirection(area, through)) };
}

/** Ray `index` of the area's own rays for a seed: bit for bit what the program casts. */
export function areaRay(area: Area, seed: bigint, index: number): Ray {
  const random = rayRandom(seed, index);
  const x = random.between(-1, 1);
  const y = random.between(-1, 1);
  const local = windowRay(area, x * area.half[0], y * area.half[1]);
  return { origin: toFloat(toWorld(area, local.origin)), direction: toFloat(local.direction), tmin: 0, tmax: Infinity };
}

/** The ray through the middle of a pixel of a picture as the area sees it; columns run against `right`. */
export function pixelRay(area: Area, width: number, height: number, column: number, row: number): Ray {
  const x = (1 - (2 * column + 1) / width) * area.half[0];
  const y = (1 - (2 * row + 1) / height) * area.half[1];
  const ray = { tmin: 0, tmax: Infinity };
  if (area.kind === 'plane')
    return { origin: toFloat(toWorld(area, [x, y, 0])), direction: toFloat(area.forward), ...ray };
  const through = toWorldDirection(area, [x, y, 1]);
  return { origin: toFloat(add(area.origin, scaled(through, area.near))), direction: toFloat(normalized(through)), ...ray };
}

export function containsPoint(area: Area, p: Vec): boolean {
  return area.planes.every(([x, y, z, offset]) => x * p[0] + y * p[1] + z * p[2] <= offset + area.slack);
}

function isAffine(area: Area, ray: Ray): boolean {
  let own = area.forward;
  if (area.kind === 'point') {
    own = sub(ray.origin, area.origin);
    if (own.every((x) => x === 0)) return true;
  }
  const a = scaledToOne(ray.direction);
  const b = scaledToOne(own);
  return Math.abs(dot(a, b)) / (length(a) * length(b)) >= 1 - area.tolerance - 2 ** -46;
}

function scaledToOne(v: Vec): Vec {
  const size = largestComponent(v);
  return [v[0] / size, v[1] / size, v[2] / size];
}

/** Does the area's tree answer for this (valid) ray? */
export function serves(area: Area, ray: Ray): boolean {
  return ray.tmin >= 0 && containsPoint(area, ray.origin) && isAffine(area, ray);
}

const boxCorner = (box: Box, i: number): Vec => [
  i & 1 ? box.hi[0] : box.lo[0],
  i & 2 ? box.hi[1] : box.lo[1],
  i & 4 ? box.hi[2] : box.lo[2],
];

/** The outline of a box as the area's rays see it: in the window's plane, of a point area after clipping to z >= near. */
export function projectedHull(area: Area, box: Box): Polygon {
  const corners = Array.from({ length: 8 }, (_, i) => toLocal(area, boxCorner(box, i)));
  if (area.kind === 'plane') return convexHull(corners.map((p) => [p[0], p[1]]));
  const points: Vec2[] = [];
  corners.forEach((p, i) => {
    if (p[2] >= area.near) points.push([p[0] / p[2], p[1] / p[2]]);
    for (const bit of [1, 2, 4]) {
      if (i & bit) continue;
      const q = corners[i | bit];
      if (p[2] < area.near === q[2] < area.near) continue;
      const t = (area.near - p[2]) / (q[2] - p[2]);
      points.push([(p[0] + (q[0] - p[0]) * t) / area.near, (p[1] + (q[1] - p[1]) * t) / area.near]);
    }
  });
  return convexHull(points);
}

export const culledHull = (area: Area, box: Box): Polygon => clipToWindow(projectedHull(area, box), area.half);
export const windowArea = (area: Area): number => 4 * area.half[0] * area.half[1];

export interface Overlap {
  common: Polygon;
  /** Common projected area by the smaller one's. */
  share: number;
}

/** What two boxes share in the area's view. */
export function overlapOf(area: Area, left: Box, right: Box, culled: boolean): Overlap {
  const hull = culled ? culledHull : projectedHull;
  const [a, b] = [hull(area, left), hull(area, right)];
  const smaller = Math.min(polygonArea(a), polygonArea(b));
  if (!(smaller > 0)) return { common: [], share: 0 };
  const common = intersectConvex(a, b);
  return { common, share: Math.min(polygonArea(common), smaller) / smaller };
}
