// The function that decides hits, as the program defines it: a filter in double precision with a proven error, and
// exact integers where it cannot tell. src/geometry/triangle.cpp has the derivation of the bounds.
import { intersectExact } from './triangle_exact';
import { cross, dot, largestComponent, sub, type Ray, type Vec } from './vec';

export interface Hit {
  t: number;
  u: number;
  v: number;
}

const ROUNDOFF = 2 ** -53;
const DETERMINANT_ERROR = 64 * ROUNDOFF;
const WEIGHT_ERROR = 128 * ROUNDOFF;

/** A float32 that is surely the rounded quotient, or NaN. */
function roundQuotient(value: number, error: number, sum: number, sumError: number): number {
  const inverse = 1 / sum;
  const quotient = value * inverse;
  const size = Math.abs(quotient);
  const radius = 2 * (error + size * sumError) * Math.abs(inverse) + 8 * ROUNDOFF * size;
  const low = Math.fround(quotient - radius) + 0;
  return low === Math.fround(quotient + radius) ? low : NaN;
}

/** The hit, or null. */
export function intersectTriangle(ray: Ray, a: Vec, b: Vec, c: Vec): Hit | null {
  const toA = sub(a, ray.origin);
  const ab = sub(b, a);
  const ac = sub(c, a);
  const moment = cross(ray.direction, toA);
  const normal = cross(ab, ac);
  const sum = dot(ray.direction, normal);
  const weightB = -dot(moment, ac);
  const weightC = dot(moment, ab);
  const weightA = sum - weightB - weightC;
  const span = largestComponent(ray.direction);
  const distance = largestComponent(toA);
  const size = Math.max(largestComponent(ab), largestComponent(ac));
  const error = WEIGHT_ERROR * span * size * (distance + size);
  const lowest = Math.min(weightA, weightB, weightC);
  const highest = Math.max(weightA, weightB, weightC);
  if (lowest < -error && highest > error) return null;
  const sumError = DETERMINANT_ERROR * span * size * size;
  const isSure = (lowest > error || highest < -error) && Math.abs(sum) > 4 * sumError;
  if (isSure) {
    const t = roundQuotient(dot(toA, normal), DETERMINANT_ERROR * distance * size * size, sum, sumError);
    if (!Number.isNaN(t) && !(ray.tmin <= t && t <= ray.tmax)) return null;
    const u = roundQuotient(weightB, error, sum, sumError);
    const v = roundQuotient(weightC, error, sum, sumError);
    if (!Number.isNaN(t) && !Number.isNaN(u) && !Number.isNaN(v)) return { t, u, v };
  }
  return intersectExact(ray, a, b, c);
}
