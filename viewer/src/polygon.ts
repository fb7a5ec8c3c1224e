// Convex polygons, counterclockwise: areas, hulls and clipping.
import type { Vec2 } from './vec';

export type Polygon = Vec2[];

const turn = (a: Vec2, b: Vec2, c: Vec2): number => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** Shoelace area, >= 0. */
export function polygonArea(polygon: Polygon): number {
  let twice = 0;
  for (let i = 1; i + 1 < polygon.length; ++i) twice += turn(polygon[0], polygon[i], polygon[i + 1]);
  return Math.abs(twice) / 2;
}

/** Sutherland and Hodgman, "Reentrant polygon clipping" (1974), one line: keeps the points with height >= 0. */
function clipToLine(polygon: Polygon, height: (p: Vec2) => number): Polygon {
  const result: Polygon = [];
  if (polygon.length === 0) return result;
  let p = polygon[polygon.length - 1];
  let before = height(p);
  for (const q of polygon) {
    const here = height(q);
    if ((before < 0 && here > 0) || (before > 0 && here < 0)) {
      const t = before / (before - here);
      result.push([p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t]);
    }
    if (here >= 0) result.push(q);
    p = q;
    before = here;
  }
  return result;
}

/** The part with |x| <= half[0], |y| <= half[1]. */
export function clipToWindow(polygon: Polygon, half: Vec2): Polygon {
  let result = clipToLine(polygon, (p) => half[0] - p[0]);
  result = clipToLine(result, (p) => p[0] + half[0]);
  result = clipToLine(result, (p) => half[1] - p[1]);
  return clipToLine(result, (p) => p[1] + half[1]);
}

export function intersectConvex(a: Polygon, b: Polygon): Polygon {
  if (polygonArea(b) === 0) return [];
  let result = a;
  for (let i = 0; i < b.length; ++i) {
    const from = b[i];
    const to = b[(i + 1) % b.length];
    if (from[0] === to[0] && from[1] === to[1]) continue;
    result = clipToLine(result, (p) => turn(from, to, p));
  }
  return result;
}

/** Andrew, "Another efficient algorithm for convex hulls in two dimensions" (1979). */
export function convexHull(points: Vec2[]): Polygon {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  if (sorted.length < 3) return sorted;
  const half = (from: Vec2[]): Vec2[] => {
    const chain: Vec2[] = [];
    for (const p of from) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) chain.pop();
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return [...half(sorted), ...half([...sorted].reverse())];
}
