// Rays of the reader's own, as JSON.
import { isValidRay, type Ray, type Vec } from './vec';

export const OWN_RAYS_EXAMPLE = '[{"origin": [0, 9, 0], "direction": [0, -1, 0]}]';
const MOST = 5000;

function floats(values: unknown, what: string): Vec {
  if (!Array.isArray(values) || values.length !== 3 || !values.every((x) => typeof x === 'number'))
    throw new Error(`${what} is not three numbers`);
  return values.map(Math.fround) as Vec;
}

function limit(value: unknown, otherwise: number, what: string): number {
  if (value === undefined || value === null) return otherwise;
  if (typeof value !== 'number') throw new Error(`${what} is no number`);
  return Math.fround(value);
}

function toRay(item: unknown, index: number): Ray {
  const where = `ray ${index}`;
  if (Array.isArray(item) && item.length >= 6)
    item = { origin: item.slice(0, 3), direction: item.slice(3, 6), tmin: item[6], tmax: item[7] };
  if (typeof item !== 'object' || item === null) throw new Error(`${where} is neither an object nor six numbers`);
  const { origin, direction, tmin, tmax } = item as Record<string, unknown>;
  const ray: Ray = {
    origin: floats(origin, `${where}: origin`),
    direction: floats(direction, `${where}: direction`),
    tmin: limit(tmin, 0, `${where}: tmin`),
    tmax: limit(tmax, Infinity, `${where}: tmax`),
  };
  if (!isValidRay(ray)) throw new Error(`${where} has no direction or is not finite`);
  return ray;
}

function listOf(json: unknown): unknown[] | null {
  if (Array.isArray(json)) return json;
  const rays = (json as { rays?: unknown } | null)?.rays;
  return Array.isArray(rays) ? rays : null;
}

/**
 * An array, or an object with "rays": objects {origin, direction, tmin, tmax}, arrays of 6 to 8 numbers, or ray sets of
 * a scene.json that list their rays.
 */
export function parseRays(text: string): Ray[] {
  const outer = listOf(JSON.parse(text));
  if (!outer) throw new Error('there is no list of rays');
  const list = outer.flatMap((item) => (Array.isArray(item) ? [item] : (listOf(item) ?? [item])));
  if (list.length === 0) throw new Error('the list of rays is empty');
  if (list.length > MOST) throw new Error(`${list.length} rays are too many: at most ${MOST}`);
  return list.map(toRay);
}
