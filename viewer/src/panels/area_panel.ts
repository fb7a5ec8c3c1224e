// The influence areas: show, hide, isolate, and look as their rays do.
import type { App } from '../app';
import { button, element, numberText } from '../dom';
import { areaColour } from '../layers/line_layer';

export function areaPanel(app: App): HTMLElement {
  const { areas } = app.data;
  if (areas.length === 0) return element('p', { class: 'note' }, 'This scene has no influence areas: its trees are those of the whole scene.');
  const hide = (hidden: number[]): void => app.store.set({ hidden });
  const boxes = areas.map((area, i) => {
    const box = element('input', { type: 'checkbox', 'aria-label': `show ${area.name}`, onchange: () => toggle(i) });
    return box;
  });
  const toggle = (i: number): void => {
    const { hidden } = app.state;
    hide(hidden.includes(i) ? hidden.filter((k) => k !== i) : [...hidden, i]);
  };
  const rows = areas.map((area, i) => {
    const only = button('only', 'Hide all others, and show a tree of this area', () => {
      const tree = app.data.trees.findIndex((info) => info.area === i);
      const other = app.data.trees.findLastIndex((info) => info.area === i);
      app.store.set({ hidden: areas.map((_, k) => k).filter((k) => k !== i), tree, other, costFrom: i, node: -1, otherNode: -1 });
    });
    const see = button('see from it', 'Look as its rays do (l); Fit goes back', () => app.see(i));
    const swatch = element('i', { class: 'swatch', style: `background:${areaColour(i)}` });
    const size = area.kind === 'plane' ? `${numberText(2 * area.half[0])} × ${numberText(2 * area.half[1])}` : `${numberText((2 * Math.atan(area.half[0]) * 180) / Math.PI)}°`;
    return element('li', {}, boxes[i], swatch, element('span', { class: 'name', title: `${area.kind} area, ${size}` }, area.name), only, see);
  });
  const all = button('all', 'Show all areas', () => hide([]));
  const none = button('none', 'Hide all areas', () => hide(areas.map((_, i) => i)));
  const back = button('back', 'Back to the free view', () => app.see(-1));
  app.onChange(() => {
    boxes.forEach((box, i) => (box.checked = !app.state.hidden.includes(i)));
    back.disabled = app.state.light < 0;
  });
  return element('div', {}, element('ul', { class: 'areas' }, ...rows), element('div', { class: 'row' }, all, none, back));
}
