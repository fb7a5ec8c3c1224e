// The definition of a hit in whole numbers: every float32 is a multiple of 2^-149.
import type { Ray, Vec } from './vec';
import type { Hit } from './triangle';

type Whole = [bigint, bigint, bigint];

const MANTISSA_BITS = 24;
const LOWEST_EXPONENT = -149;
const view = new DataView(new ArrayBuffer(4));

function toWhole(x: number): bigint {
  view.setFloat32(0, x);
  const bits = view.getUint32(0);
  const exponent = (bits >>> 23) & 255;
  const fraction = BigInt(bits & 0x7fffff);
  const size = exponent === 0 ? fraction : (fraction | 0x800000n) << BigInt(exponent - 1);
  return bits >>> 31 ? -size : size;
}

const whole = (v: Vec): Whole => [toWhole(v[0]), toWhole(v[1]), toWhole(v[2])];
const minus = (a: Whole, b: Whole): Whole => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const determinant = (a: Whole, b: Whole, c: Whole): bigint =>
  a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
const magnitude = (a: bigint): bigint => (a < 0n ? -a : a);
const bitLength = (a: bigint): number => a.toString(2).length;

/** floor(log2(a / b)) for positive a and b. */
function exponentOfQuotient(a: bigint, b: bigint): number {
  const exponent = bitLength(a) - bitLength(b);
  const tooHigh = exponent >= 0 ? a < b << BigInt(exponent) : a << BigInt(-exponent) < b;
  return tooHigh ? exponent - 1 : exponent;
}

/** The quotient rounded once to the nearest float32, ties to even; zero is positive. */
export function roundedQuotient(numerator: bigint, denominator: bigint): number {
  if (numerator === 0n) return 0;
  let a = magnitude(numerator);
  let b = magnitude(denominator);
  const unit = Math.max(exponentOfQuotient(a, b) - (MANTISSA_BITS - 1), LOWEST_EXPONENT);
  if (unit >= 0) b <<= BigInt(unit);
  else a <<= BigInt(-unit);
  let mantissa = a / b;
  const twice = (a % b) * 2n;
  if (twice > b || (twice === b && mantissa % 2n === 1n)) mantissa += 1n;
  const size = Math.fround(Number(mantissa) * 2 ** unit);
  return numerator < 0n === denominator < 0n ? size : -size + 0;
}

export function intersectExact(ray: Ray, a: Vec, b: Vec, c: Vec): Hit | null {
  const d = whole(ray.direction);
  const o = whole(ray.origin);
  const [oa, ob, oc] = [minus(whole(a), o), minus(whole(b), o), minus(whole(c), o)];
  const weights = [determinant(d, ob, oc), determinant(d, oc, oa), determinant(d, oa, ob)];
  const positive = weights.some((w) => w > 0n);
  const negative = weights.some((w) => w < 0n);
  if (positive === negative) return null;
  const sum = weights[0] + weights[1] + weights[2];
  const t = roundedQuotient(determinant(oa, ob, oc), sum);
  if (!(ray.tmin <= t && t <= ray.tmax)) return null;
  return { t, u: roundedQuotient(weights[1], sum), v: roundedQuotient(weights[2], sum) };
}
