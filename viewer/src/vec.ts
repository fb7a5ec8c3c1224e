// Vectors and boxes in double precision, with the same order of operations as the program's.

export type Vec = [number, number, number];
export type Vec2 = [number, number];

export const add = (a: Vec, b: Vec): Vec => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a: Vec, s: number): Vec => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec, b: Vec): Vec => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vec): number => Math.sqrt(dot(a, a));
export const normalized = (a: Vec): Vec => {
  const size = length(a);
  return [a[0] / size, a[1] / size, a[2] / size];
};
/** Each component rounded once to the nearest float32. */
export const toFloat = (a: Vec): Vec => [Math.fround(a[0]), Math.fround(a[1]), Math.fround(a[2])];
export const largestComponent = (a: Vec): number => Math.max(Math.abs(a[0]), Math.abs(a[1]), Math.abs(a[2]));

export interface Box {
  lo: Vec;
  hi: Vec;
}

export const emptyBox = (): Box => ({ lo: [Infinity, Infinity, Infinity], hi: [-Infinity, -Infinity, -Infinity] });
export const center = (box: Box): Vec => scaled(add(box.lo, box.hi), 0.5);
export const diagonal = (box: Box): number => length(sub(box.hi, box.lo));
export function surfaceArea(box: Box): number {
  const [x, y, z] = sub(box.hi, box.lo);
  return 2 * (x * y + y * z + z * x);
}

/** A ray with its limits; the numbers are float32. */
export interface Ray {
  origin: Vec;
  direction: Vec;
  tmin: number;
  tmax: number;
}

export function isValidRay(ray: Ray): boolean {
  const finite = [...ray.origin, ...ray.direction].every(Number.isFinite);
  return finite && ray.direction.some((x) => x !== 0) && !Number.isNaN(ray.tmin) && !Number.isNaN(ray.tmax);
}
