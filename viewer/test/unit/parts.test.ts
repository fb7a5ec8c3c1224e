// Parts of the page that need neither a browser nor the program.
import assert from 'node:assert/strict';
import test from 'node:test';
import { histogram, highPercentile, imageSize } from '../../src/heat';
import { parseRays } from '../../src/own_rays';
import { clipToWindow, convexHull, intersectConvex, polygonArea, type Polygon } from '../../src/polygon';
import { Random } from '../../src/random';
import { DEFAULTS, fromHash, toHash } from '../../src/state';
import { intersectTriangle } from '../../src/triangle';
import { intersectExact, roundedQuotient } from '../../src/triangle_exact';
import type { Ray, Vec } from '../../src/vec';

const square = (x: number, y: number, half: number): Polygon => [
  [x - half, y - half],
  [x + half, y - half],
  [x + half, y + half],
  [x - half, y + half],
];

test('random numbers are those of SplitMix64', () => {
  const random = new Random(1234567n);
  assert.deepEqual([random.next(), random.next(), random.next()], [6457827717110365317n, 3203168211198807973n, 9817491932198370423n]);
});

test('polygons are cut where they should be', () => {
  assert.equal(polygonArea(square(0, 0, 1)), 4);
  assert.equal(polygonArea(intersectConvex(square(0, 0, 1), square(1, 1, 1))), 1);
  assert.equal(polygonArea(intersectConvex(square(0, 0, 1), square(3, 0, 1))), 0);
  assert.equal(polygonArea(clipToWindow(square(0, 0, 5), [1, 2])), 8);
  assert.equal(polygonArea(convexHull([...square(0, 0, 1), [0, 0], [0.5, 0.5]])), 4);
});

test('hits are rounded once, as whole numbers say', () => {
  assert.equal(roundedQuotient(1n, 3n), Math.fround(1 / 3));
  assert.equal(roundedQuotient(-2n, 3n), Math.fround(-2 / 3));
  assert.equal(roundedQuotient((1n << 25n) + 2n, 1n), 2 ** 25); // a tie goes to even
  const random = new Random(5n);
  const float = (): number => Math.fround(random.between(-2, 2));
  const vec = (): Vec => [float(), float(), float()];
  let hits = 0;
  for (let i = 0; i < 3000; ++i) {
    const ray: Ray = { origin: vec(), direction: vec(), tmin: 0, tmax: Infinity };
    const corners: Vec[] = [vec(), vec(), vec()];
    if (i % 3 === 0) ray.direction = corners[0].map((x, k) => Math.fround(x - ray.origin[k])) as Vec; // towards a corner
    const exact = intersectExact(ray, corners[0], corners[1], corners[2]);
    assert.deepEqual(intersectTriangle(ray, corners[0], corners[1], corners[2]), exact, `ray ${i}`);
    hits += exact ? 1 : 0;
  }
  assert.ok(hits > 100 && hits < 2900, `${hits} hits`);
});

test('a link restores the state, and nonsense in it does no harm', () => {
  const state = { ...DEFAULTS, show: 'leaves' as const, node: 17, hidden: [0, 2], compare: true, camera: [1, 2.5, -3, 0, 0, 1e-7], seed: '18446744073709551615' };
  assert.deepEqual(fromHash(`#${toHash(state, DEFAULTS)}`, DEFAULTS), state);
  assert.equal(toHash(DEFAULTS, DEFAULTS), '');
  assert.deepEqual(fromHash('#show=everything&rays=99999&level=x&foo=1&%&seed=-3&colour', DEFAULTS), DEFAULTS);
});

test('rays of the reader are read, or refused with a reason', () => {
  const one = parseRays('[{"origin": [0, 0.1, 0], "direction": [0, -1, 0]}]')[0];
  assert.deepEqual(one, { origin: [0, Math.fround(0.1), 0], direction: [0, -1, 0], tmin: 0, tmax: Infinity });
  assert.equal(parseRays('{"rays": [[0,0,0,1,0,0],[0,0,0,1,0,0,0.5,null]]}')[1].tmin, 0.5);
  assert.equal(parseRays('{"rays": [{"name": "mine", "rays": [[0,0,0,1,0,0],[1,0,0,1,0,0]]}]}').length, 2);
  for (const [text, reason] of [
    ['{}', /no list/],
    ['[]', /empty/],
    ['[{"origin": [0, 0], "direction": [0, 1, 0]}]', /ray 0: origin/],
    ['[[0,0,0,0,0,0]]', /no direction/],
    ['[3]', /neither/],
    ['[{"origin": [0,0,0], "direction": [0,1,0], "tmax": "far"}]', /tmax/],
  ] as const)
    assert.throws(() => parseRays(text), reason, text);
});

test('scales and histograms count every pixel', () => {
  const values = Float32Array.from({ length: 1000 }, (_, i) => i);
  assert.equal(highPercentile([values]), 990);
  assert.deepEqual(histogram(Float32Array.of(0, 1, 2, 9, 10, 50), 10, 5), [2, 1, 0, 0, 3]);
  const area = { half: [2, 1] } as unknown as Parameters<typeof imageSize>[0];
  assert.deepEqual(imageSize(area, 200), { width: 200, height: 100 });
});
