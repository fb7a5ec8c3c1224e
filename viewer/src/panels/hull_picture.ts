// A node's boxes as the area's rays see them, with what its children share.
import { overlapOf, projectedHull, type Area } from '../area';
import { css, ROLE_COLOURS } from '../colours';
import { element, svg } from '../dom';
import { polygonArea, type Polygon } from '../polygon';
import { boxOf, isLeaf, type Tree } from '../tree';

interface Outline {
  polygon: Polygon;
  colour: string;
  kind: string;
}

function outlines(area: Area, tree: Tree, node: number): Outline[] {
  const list: Outline[] = [];
  const add = (at: number, role: 'parent' | 'node' | 'left' | 'right'): void => {
    const colour = role === 'node' ? 'currentColor' : css(ROLE_COLOURS[role]);
    list.push({ polygon: projectedHull(area, boxOf(tree, at)), colour, kind: role });
  };
  if (tree.parent[node] >= 0) add(tree.parent[node], 'parent');
  add(node, 'node');
  if (isLeaf(tree, node)) return list;
  add(tree.first[node], 'left');
  add(tree.first[node] + 1, 'right');
  return list;
}

/** `x` runs to the viewer's left in the window's plane. */
const points = (polygon: Polygon): string => polygon.map(([x, y]) => `${-x},${-y}`).join(' ');

export function hullPicture(area: Area, tree: Tree, node: number): HTMLElement {
  const list = outlines(area, tree, node);
  const all = list.flatMap(({ polygon }) => polygon);
  if (all.length === 0) return element('p', { class: 'note' }, 'The area does not see this node.');
  const [xs, ys] = [all.map((p) => -p[0]), all.map((p) => -p[1])];
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const size = Math.max(Math.max(...xs) - left, Math.max(...ys) - top) || 1;
  const pad = size * 0.05;
  const picture = svg('svg', {
    class: 'hulls',
    viewBox: `${left - pad} ${top - pad} ${Math.max(...xs) - left + 2 * pad} ${Math.max(...ys) - top + 2 * pad}`,
    role: 'img',
    'aria-label': 'Projected hulls',
  });
  const stroke = size / 150;
  const [x, y] = area.half;
  picture.append(svg('rect', { x: -x, y: -y, width: 2 * x, height: 2 * y, fill: 'none', stroke: 'gray', 'stroke-width': stroke, 'stroke-dasharray': stroke * 4 }));
  if (!isLeaf(tree, node)) {
    const { common } = overlapOf(area, boxOf(tree, tree.first[node]), boxOf(tree, tree.first[node] + 1), false);
    if (polygonArea(common) > 0) picture.append(svg('polygon', { class: 'common', points: points(common), fill: '#b05cc6', 'fill-opacity': 0.55 }));
  }
  for (const { polygon, colour, kind } of list)
    picture.append(svg('polygon', { class: kind, points: points(polygon), fill: 'none', stroke: colour, 'stroke-width': stroke * 1.6, 'stroke-linejoin': 'round' }));
  return element('figure', {}, picture as unknown as HTMLElement, element('figcaption', {}, `as ${area.name} sees it; dashed: its window`));
}
