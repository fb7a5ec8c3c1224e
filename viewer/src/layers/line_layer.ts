// Line segments: outlines of areas, and rays.
import * as THREE from 'three';
import type { Area } from '../area';
import { css, randomColour, type Colour } from '../colours';
import type { Vec } from '../vec';

export interface Segment {
  from: Vec;
  to: Vec;
  colour: Colour;
}

export function segments(list: Segment[], onTop: boolean): THREE.LineSegments {
  const places = new Float32Array(6 * list.length);
  const colours = new Uint8Array(6 * list.length);
  list.forEach((segment, i) => {
    places.set([...segment.from, ...segment.to], 6 * i);
    colours.set([...segment.colour, ...segment.colour], 6 * i);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3, true));
  const material = new THREE.LineBasicMaterial({ vertexColors: true, depthTest: !onTop, transparent: onTop });
  const result = new THREE.LineSegments(geometry, material);
  result.frustumCulled = false;
  result.renderOrder = onTop ? 4 : 2;
  return result;
}

const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

/** A few of the area's rays, from its near to its far face. */
function sampleRays(area: Area, colour: Colour): Segment[] {
  const list: Segment[] = [];
  /** A place on a face: corners 0 ... 3 are the near one's, 4 ... 7 the far one's. */
  const at = (face: number, x: number, y: number): Vec =>
    [0, 1, 2].map((k) => {
      const [a, b, c, d] = [0, 1, 2, 3].map((i) => area.corners[4 * face + i][k]);
      return (a * (1 - x) + b * x) * (1 - y) + (c * (1 - x) + d * x) * y;
    }) as Vec;
  for (const x of [0.25, 0.5, 0.75])
    for (const y of [0.25, 0.5, 0.75]) list.push({ from: at(0, x, y), to: at(1, x, y), colour });
  return list;
}

/** The box or frustum of an area, its eye, some of its rays, and an arrow along them. */
export function areaLines(area: Area, index: number): THREE.LineSegments {
  const colour = randomColour(index + 3);
  const list: Segment[] = [];
  for (let i = 0; i < EDGES.length; i += 2) list.push({ from: area.corners[EDGES[i]], to: area.corners[EDGES[i + 1]], colour });
  if (area.kind === 'point') for (let i = 0; i < 4; ++i) list.push({ from: area.origin, to: area.corners[i], colour });
  list.push(...sampleRays(area, colour.map((c) => Math.round(c * 0.6 + 70)) as Colour));
  const start = area.corners.slice(0, 4).reduce<Vec>((sum, c) => [sum[0] + c[0] / 4, sum[1] + c[1] / 4, sum[2] + c[2] / 4], [0, 0, 0]);
  const size = (area.far - area.near) * 0.25;
  const at = (along: number, aside: number, up: number): Vec =>
    start.map((x, i) => x + size * (along * area.forward[i] + aside * area.right[i] + up * area.up[i])) as Vec;
  const tip = at(1, 0, 0);
  list.push({ from: start, to: tip, colour });
  for (const [aside, up] of [
    [0.1, 0],
    [-0.1, 0],
    [0, 0.1],
    [0, -0.1],
  ])
    list.push({ from: tip, to: at(0.8, aside, up), colour });
  return segments(list, false);
}

export const areaColour = (index: number): string => css(randomColour(index + 3));
