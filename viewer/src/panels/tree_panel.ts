// Which trees are drawn, which of their boxes, and in which colours; two of them beside each other.
import type { App } from '../app';
import { boxColour, gradient } from '../colours';
import { checkbox, element, numberText, select, slider, table } from '../dom';
import type { ColourBy, Show, State } from '../state';

export function treeName(app: App, index: number): string {
  const info = app.data.trees[index];
  const area = info.area >= 0 ? app.data.areas[info.area].name : 'whole scene';
  return `${info.recipe}, ${area}`;
}

const SHOWS: [Show, string][] = [
  ['none', 'no boxes'],
  ['level', 'one level'],
  ['leaves', 'leaves'],
  ['all', 'all boxes'],
];
const COLOURS: [ColourBy, string][] = [
  ['depth', 'level'],
  ['measure', 'measure'],
  ['overlap', 'sibling overlap'],
  ['visits', 'visits of the rays'],
  ['random', 'random'],
];
const words = (list: [string, string][]): { value: string; label: string }[] => list.map(([value, label]) => ({ value, label }));

/** The values of both trees beside each other. */
function valueTable(app: App): HTMLElement {
  const shown = app.panes.filter((pane) => pane.tree !== null).map((pane) => pane.tree!.info);
  const rows = shown[0]?.values.map((value) => {
    const cells = shown.map((info) => info.values.find((v) => v.name === value.name)?.value ?? NaN);
    return [element('span', { title: value.meaning }, value.name.replaceAll('_', ' ')), ...cells.map(numberText)];
  });
  const result = table(['', ...shown.map((info) => info.recipe)], rows ?? []);
  result.id = 'tree-values';
  return result;
}

function legend(app: App): HTMLElement {
  const scale = app.panes[0].colours?.scale;
  if (!scale || app.state.show === 'none') return element('div');
  return element(
    'div',
    { class: 'legend' },
    element('div', { class: 'bar', style: `background:${gradient(boxColour, 0, 1)}` }),
    element('div', { class: 'ends' }, element('span', {}, numberText(scale.low)), element('span', {}, scale.title), element('span', {}, numberText(scale.high))),
  );
}

export function treePanel(app: App): HTMLElement {
  const set = (patch: Partial<State>): void => app.store.set(patch);
  const choices = app.data.trees.map((_, i) => ({ value: String(i), label: treeName(app, i) }));
  const tree = select('Tree', choices, (value) => set({ tree: Number(value), node: -1 }));
  const other = select('beside', choices, (value) => set({ other: Number(value), otherNode: -1 }));
  const compare = checkbox('two trees beside each other', (on) => set({ compare: on, focus: 0 }));
  const show = select('Boxes', words(SHOWS), (value) => set({ show: value as Show }));
  const level = slider('Level', { min: 0, max: 100, step: 1 }, (value) => set({ level: value }));
  const colour = select('Coloured by', words(COLOURS), (value) => set({ colour: value as ColourBy }));
  const filled = checkbox('opaque boxes', (on) => set({ filled: on }));
  const shown = element('p', { class: 'note', id: 'boxes-shown' });
  const below = element('div');
  const values = element('div');
  const all = element('details', {}, element('summary', {}, 'All values of the tree'), values);
  app.onChange(() => {
    const { state } = app;
    tree.set(String(state.tree));
    other.set(String(state.other));
    compare.set(state.compare);
    other.row.hidden = !state.compare;
    show.set(state.show);
    colour.set(state.colour);
    filled.set(state.filled);
    const deepest = Math.max(...app.panes.map((pane) => pane.tree?.maxLevel ?? 0));
    level.set(Math.min(state.level, deepest), deepest);
    level.row.hidden = state.show !== 'level';
    const { nodes, total } = app.panes[0].shown;
    shown.textContent = nodes.length < total ? `${numberText(nodes.length)} of ${numberText(total)} boxes are drawn: the largest.` : `${numberText(total)} boxes`;
    below.replaceChildren(legend(app));
    values.replaceChildren(valueTable(app));
    if (state.compare) all.open = true;
  });
  return element('div', {}, tree.row, compare.row, other.row, show.row, level.row, colour.row, filled.row, shown, below, all);
}
