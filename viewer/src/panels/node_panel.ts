// One node: its numbers beside its children's, its place in the tree, its outlines.
import type { App } from '../app';
import { culledHull, overlapOf, projectedHull, windowArea, type Area } from '../area';
import { button, element, numberText, table } from '../dom';
import { polygonArea } from '../polygon';
import { boxOf, isLeaf, probabilityOf, siblingOf, trianglesBelow, type Tree } from '../tree';
import { surfaceArea } from '../vec';
import { hullPicture } from './hull_picture';

type Row = [string, (node: number) => string];

function rowsOf(app: App, tree: Tree, area: Area | null): Row[] {
  const { costs } = app.data;
  const price = (node: number): number => (isLeaf(tree, node) ? costs.triangle * tree.count[node] : costs.inner);
  const rootArea = surfaceArea(boxOf(tree, 0));
  const box = (node: number): ReturnType<typeof boxOf> => boxOf(tree, node);
  const rows: Row[] = [
    ['Level', (node) => String(tree.level[node])],
    ['Triangles', (node) => numberText(trianglesBelow(tree, node).length)],
    ['Surface area', (node) => numberText(surfaceArea(box(node)))],
    ['P (surface area)', (node) => numberText(rootArea > 0 ? surfaceArea(box(node)) / rootArea : 0)],
  ];
  if (area)
    rows.push(
      ['Projected area', (node) => numberText(polygonArea(projectedHull(area, box(node))))],
      ['… in the window', (node) => numberText(polygonArea(culledHull(area, box(node))))],
      ['P (projected area)', (node) => numberText(Math.min(1, polygonArea(culledHull(area, box(node))) / windowArea(area)))],
    );
  rows.push(
    [`Measure of ${tree.info.recipe}`, (node) => numberText(tree.measure[node])],
    ['P (its own measure)', (node) => numberText(probabilityOf(tree, node))],
    ['Cost when met', (node) => numberText(price(node))],
    ['Expected cost', (node) => numberText(probabilityOf(tree, node) * price(node))],
  );
  if (area)
    rows.push(
      ['Overlap with sibling', (node) => overlapText(area, tree, node, false)],
      ['… in the window', (node) => overlapText(area, tree, node, true)],
    );
  const { axis, quality } = tree;
  if (axis && quality)
    rows.push(
      ['Split across', (node) => ['x', 'y', 'z', '-'][axis[node] & 3] + (axis[node] & 4 ? ' (fallback)' : '') + (axis[node] & 8 ? ' (forced)' : '')],
      ['Quality of the axis', (node) => (isLeaf(tree, node) ? '-' : numberText(Number(quality[node].toFixed(4))))],
    );
  rows.push(['Visits of the rays', (node) => numberText(app.panes[app.state.focus].visits?.[node] ?? NaN)]);
  return rows;
}

function overlapText(area: Area, tree: Tree, node: number, culled: boolean): string {
  const sibling = siblingOf(tree, node);
  return sibling < 0 ? '-' : numberText(overlapOf(area, boxOf(tree, node), boxOf(tree, sibling), culled).share);
}

/** The way from the root to the node, with both children of each node on it. */
function outline(app: App, tree: Tree, node: number): HTMLElement {
  const path = new Set<number>();
  for (let at = node; at >= 0; at = tree.parent[at]) path.add(at);
  const list = element('ul', { class: 'outline', role: 'tree', 'aria-label': 'Nodes' });
  const add = (at: number, side: string): void => {
    const text = `${side} ${at}` + (isLeaf(tree, at) ? ` · ${tree.count[at]} tri` : '');
    const chosen = at === node;
    const row = element(
      'li',
      { role: 'treeitem', 'aria-selected': String(chosen), 'aria-level': tree.level[at] + 1, tabindex: chosen ? 0 : -1, style: `padding-left:${Math.min(tree.level[at], 24) * 0.55 + 0.3}rem`, onclick: () => app.choose(app.state.focus, at) },
      text,
    );
    list.append(row);
    if (!path.has(at) || isLeaf(tree, at)) return;
    add(tree.first[at], 'left');
    add(tree.first[at] + 1, 'right');
  };
  add(0, 'root');
  return list;
}

function numbers(app: App, tree: Tree, area: Area | null, node: number): HTMLElement {
  const nodes = isLeaf(tree, node) ? [node] : [node, tree.first[node], tree.first[node] + 1];
  const head = ['', `node ${node}`, ...(nodes.length > 1 ? ['left', 'right'] : [])];
  const result = table(head, rowsOf(app, tree, area).map(([name, value]) => [name, ...nodes.map(value)]));
  result.id = 'node-numbers';
  return result;
}

export function nodePanel(app: App): HTMLElement {
  const content = element('div');
  const steps = element(
    'div',
    { class: 'row' },
    button('parent ↑', 'To the parent (↑)', () => app.step('parent')),
    button('← left', 'To the left child (←)', () => app.step('left')),
    button('right →', 'To the right child (→)', () => app.step('right')),
    button('sibling ⇄', 'To the sibling (s)', () => app.step('sibling')),
  );
  app.onChange(() => {
    const pane = app.state.focus;
    const tree = app.panes[pane].tree;
    const node = app.nodeOf(pane);
    if (!tree || node < 0) {
      content.replaceChildren(element('p', { class: 'note' }, 'Click a box or a surface, or take '), button('the root', 'Choose the root', () => app.choose(app.state.focus, 0)));
      return;
    }
    const area = app.areaOf(pane);
    content.replaceChildren(steps, numbers(app, tree, area, node), ...(area ? [hullPicture(area, tree, node)] : []), outline(app, tree, node));
    const chosen = content.querySelector<HTMLElement>('[aria-selected=true]');
    if (chosen?.parentElement) chosen.parentElement.scrollTop = chosen.offsetTop - chosen.parentElement.clientHeight / 2;
  });
  return content;
}
