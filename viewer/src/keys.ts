// What the keyboard does, and a page that says so.
import type { App } from './app';
import { button, element, table } from './dom';
import type { Show, State, TopShow } from './state';

interface Shortcut {
  keys: string[];
  says: string;
  does: () => void;
}

const SHOWS: Show[] = ['none', 'level', 'leaves', 'all'];
const TOPS: TopShow[] = ['none', 'leaves', 'wireframe', 'both'];
const THEMES: State['theme'][] = ['auto', 'light', 'dark'];
export const following = <T>(list: T[], now: T): T => list[(list.indexOf(now) + 1) % list.length];

function shortcuts(app: App, help: () => void): Shortcut[] {
  const { store } = app;
  const flip = (key: 'wireframe' | 'mesh' | 'compare' | 'cost' | 'cast' | 'filled') => (): void => store.set({ [key]: !app.state[key] });
  const level = (by: number) => (): void => store.set({ show: 'level', level: Math.min(Math.max(app.state.level + by, 0), app.panes[0].tree?.maxLevel ?? 0) });
  return [
    { keys: ['ArrowUp', 'p'], says: 'to the parent', does: () => app.step('parent') },
    { keys: ['ArrowLeft'], says: 'to the left child', does: () => app.step('left') },
    { keys: ['ArrowRight'], says: 'to the right child', does: () => app.step('right') },
    { keys: ['s'], says: 'to the sibling', does: () => app.step('sibling') },
    { keys: ['b'], says: 'boxes: none, a level, leaves, all', does: () => store.set({ show: following(SHOWS, app.state.show) }) },
    { keys: ['+', '='], says: 'one level down', does: level(1) },
    { keys: ['-'], says: 'one level up', does: level(-1) },
    { keys: ['o'], says: 'opaque boxes', does: flip('filled') },
    { keys: ['f'], says: 'fit the scene', does: () => app.see(-1) },
    { keys: ['l'], says: "see from the tree's area, and back", does: () => app.see(app.state.light >= 0 ? -1 : (app.panes[0].tree?.info.area ?? -1)) },
    { keys: ['w'], says: 'wireframe', does: flip('wireframe') },
    { keys: ['m'], says: 'shaded surfaces', does: flip('mesh') },
    { keys: ['t'], says: 'top level: nothing, leaves, wireframe, both', does: () => store.set({ top: following(TOPS, app.state.top) }) },
    { keys: ['r'], says: 'cast rays, or none', does: flip('cast') },
    { keys: ['c'], says: 'two trees beside each other', does: flip('compare') },
    { keys: ['h'], says: 'cost per pixel', does: flip('cost') },
    { keys: ['d'], says: 'light, dark, or as the system says', does: () => store.set({ theme: following(THEMES, app.state.theme) }) },
    { keys: ['Escape'], says: 'close, or choose nothing', does: () => (app.state.cost ? store.set({ cost: false }) : store.set({ node: -1, otherNode: -1, cell: -1 })) },
    { keys: ['?'], says: 'this list', does: help },
  ];
}

const KEY_NAMES: Record<string, string> = { ArrowUp: '↑', ArrowLeft: '←', ArrowRight: '→', Escape: 'Esc' };

/** Listens to the keyboard; returns what shows the list. */
export function listenToKeys(app: App): () => void {
  const dialog = element('dialog', { 'aria-label': 'Keyboard' });
  const help = (): void => (dialog.open ? dialog.close() : dialog.showModal());
  const list = shortcuts(app, help);
  const rows = list.map(({ keys, says }) => [element('span', {}, ...keys.flatMap((key, i) => [i ? ' ' : '', element('kbd', {}, KEY_NAMES[key] ?? key)])), says]);
  const mouse = element('p', { class: 'note' }, 'Drag: orbit. Right button or two fingers: pan. Wheel or pinch: zoom. Click: choose a box, a surface or a cell. Point at a ray: its boxes.');
  dialog.append(element('h2', {}, 'Keyboard'), table([], rows), mouse, button('Close', 'Close (Esc)', () => dialog.close()));
  document.body.append(dialog);
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target as HTMLElement;
    if (target.closest('input:not([type=checkbox]), textarea, select') || (dialog.open && event.key !== '?')) return;
    const found = list.find(({ keys }) => keys.includes(event.key));
    if (!found) return;
    event.preventDefault();
    found.does();
  });
  return help;
}
