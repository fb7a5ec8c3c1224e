// The octree that finds the areas of a point.
import type { App } from '../app';
import { element, numberText, select, table } from '../dom';
import type { TopShow } from '../state';

export function topPanel(app: App): HTMLElement {
  const { leaves, nodes } = app.top;
  if (nodes === 0) return element('p', { class: 'note' }, 'Without areas there is no top level.');
  const choices = [
    ['none', 'nothing'],
    ['leaves', 'leaves'],
    ['wireframe', 'wireframe'],
    ['both', 'both'],
  ].map(([value, label]) => ({ value, label }));
  const show = select('Cells', choices, (value) => app.store.set({ top: value as TopShow }));
  const cell = element('div', { id: 'cell-facts' });
  const served = leaves.filter((leaf) => leaf.areas.length > 0);
  const facts = table([], [
    ['Nodes', numberText(nodes)],
    ['Leaves', numberText(leaves.length)],
    ['Leaves with areas', numberText(served.length)],
    ['Areas per leaf', numberText(leaves.reduce((sum, leaf) => sum + leaf.areas.length, 0) / leaves.length)],
  ]);
  app.onChange(() => {
    show.set(app.state.top);
    const chosen = leaves[app.state.cell];
    if (!chosen) {
      cell.replaceChildren(element('p', { class: 'note' }, 'With cells shown and no boxes, a click chooses a cell.'));
      return;
    }
    cell.replaceChildren(
      table(['Cell', String(chosen.node)], [
        ['Level', String(chosen.level)],
        ['From', chosen.box.lo.map(numberText).join(', ')],
        ['To', chosen.box.hi.map(numberText).join(', ')],
        ['Areas', chosen.areas.map((area) => app.data.areas[area].name).join(', ') || 'none'],
      ]),
    );
  });
  return element('div', {}, show.row, facts, cell);
}
