// Costs that the page counts are the analyzer's, number by number.
import assert from 'node:assert/strict';
import test from 'node:test';
import { castRays, measureRays } from '../../src/cost';
import { culledHull, overlapOf } from '../../src/area';
import { readData } from '../../src/data';
import { loadMesh } from '../../src/mesh';
import { polygonArea } from '../../src/polygon';
import { boxOf, loadTree, probabilityOf, siblingOf, type Tree } from '../../src/tree';
import { openPage, place, readText, runProgram } from './page';

const RAYS = 700;
const NUMBERS = ['real_cost', 'pruned_cost', 'inner_hits', 'leaf_hits', 'leaf_triangles'] as const;

interface Case {
  name: string;
  scene: string[];
  area: string;
  recipe: string;
  seed: string;
}

const SUN = ['--sun', '0.35,-0.8,0.48'];
const CASES: Case[] = [
  { name: 'plane', scene: ['procedural:city?size=4', ...SUN], area: 'sun', recipe: 'SAH+LSPH', seed: '1' },
  { name: 'slanted', scene: ['procedural:forest?size=2', ...SUN], area: 'sun', recipe: 'PAH+ALL', seed: '18446744073709551615' },
  { name: 'straight', scene: ['procedural:terrain?size=40', '--sun', '0,-1,0'], area: 'sun', recipe: 'PAH+SPFH', seed: '7' },
  { name: 'spatial', scene: ['procedural:city?size=3', ...SUN], area: 'sun', recipe: 'PAH+ALL@spatial', seed: '3' },
  { name: 'camera', scene: ['procedural:city?size=4', '--camera', '60,30,80', '0,5,0'], area: 'camera', recipe: 'PAH+SPFH', seed: '5' },
  { name: 'light', scene: ['procedural:city?size=3', '--light', '3,14,5'], area: 'light-y', recipe: 'PAH+ALL', seed: '9' },
];

function analyzed(c: Case): Record<string, number> {
  const options = ['--recipe', c.recipe, '--area', c.area, '--rays', String(RAYS), '--seed', c.seed];
  const json = runProgram(['analyze', ...c.scene, ...options, '--json', '-', '--nodes', place(`${c.name}.csv`)]);
  return JSON.parse(json).rows[0];
}

function near(actual: number, expected: number, what: string, tolerance: number): void {
  assert.ok(Math.abs(actual - expected) <= tolerance * Math.max(Math.abs(expected), 1e-3), `${what}: ${actual}, not ${expected}`);
}

/** Boxes bit for bit; measures and overlaps as they are shown. */
function checkNodes(c: Case, tree: Tree, area: Parameters<typeof overlapOf>[0]): void {
  const [header, ...rows] = readText(`${c.name}.csv`).trim().split('\r\n').map((line) => line.split(','));
  const column = (row: string[], name: string): number => Number(row[header.indexOf(name)]);
  assert.equal(tree.size, rows.length);
  rows.forEach((row, node) => {
    const box = boxOf(tree, node);
    const values = [...box.lo, ...box.hi];
    ['lo_x', 'lo_y', 'lo_z', 'hi_x', 'hi_y', 'hi_z'].forEach((name, i) => assert.equal(values[i], column(row, name), `${c.name} ${node} ${name}`));
    assert.equal(tree.level[node], column(row, 'level'));
    assert.equal(tree.parent[node], column(row, 'parent'));
    near(tree.measure[node], column(row, 'measure'), `${c.name} ${node} measure`, 1e-4);
    near(probabilityOf(tree, node), column(row, 'probability'), `${c.name} ${node} probability`, 1e-4);
    if (node === 0 || node % 7 !== 0) return;
    const sibling = boxOf(tree, siblingOf(tree, node));
    for (const [culled, name] of [[false, 'overlap'], [true, 'overlap_culled']] as const)
      near(overlapOf(area, box, sibling, culled).share, column(row, name), `${c.name} ${node} ${name}`, 1e-5);
    if (c.recipe.startsWith('PAH')) near(polygonArea(culledHull(area, box)), column(row, 'measure'), `${c.name} ${node} hull`, 1e-4);
  });
}

for (const c of CASES) {
  test(`${c.name}: ${c.recipe} counts as the analyzer does`, async () => {
    openPage(`${c.name}.html`, [...c.scene, '--recipes', c.recipe, '--seed', c.seed]);
    const data = readData();
    const mesh = await loadMesh(data);
    const index = data.areas.findIndex((area) => area.name === c.area);
    assert.ok(index >= 0, `there is an area ${c.area}`);
    const info = data.trees.find((tree) => tree.area === index);
    assert.ok(info);
    const tree = await loadTree(info, mesh);
    const area = data.areas[index];
    const rays = castRays(area, BigInt(c.seed), RAYS);
    const stats = measureRays(tree, mesh, rays, data.costs);
    const expected = analyzed(c);
    for (const name of NUMBERS) assert.equal(stats[name], expected[name], `${c.name} ${name}`);
    if ('served_rays' in expected) assert.equal(stats.rays, expected.served_rays);
    checkNodes(c, tree, area);
  });
}
