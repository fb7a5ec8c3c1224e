// Rays cast in the page, and what they cost.
import type { App } from '../app';
import type { RayStats } from '../cost';
import { button, element, numberText, table } from '../dom';
import { OWN_RAYS_EXAMPLE, parseRays } from '../own_rays';

const NUMBERS: [keyof RayStats & string, string][] = [
  ['rays', 'Rays'],
  ['hits', 'Hits'],
  ['pruned_cost', 'Pruned cost'],
  ['real_cost', 'Real cost'],
  ['hit_ratio', 'Hit ratio'],
  ['inner_hits', 'Inner boxes met'],
  ['leaf_hits', 'Leaves met'],
  ['leaf_triangles', 'Triangles in them'],
];

function results(app: App): HTMLElement {
  const shown = app.panes.filter((pane) => pane.tree && pane.stats);
  if (shown.length === 0) return element('p', { class: 'note' }, 'No rays are cast.');
  const rows = NUMBERS.map(([name, label]) => [
    label,
    ...shown.map((pane) => {
      const value = pane.stats![name] as number;
      return element('data', { value, 'data-name': name }, numberText(value));
    }),
  ]);
  const result = table(['per ray', ...shown.map((pane) => pane.tree!.info.recipe)], rows);
  result.id = 'ray-numbers';
  return result;
}

/** Text or a file of the reader's own rays. */
function ownRays(app: App, recast: () => void): HTMLElement {
  const text = element('textarea', { rows: 3, 'aria-label': 'rays as JSON', placeholder: OWN_RAYS_EXAMPLE });
  const said = element('p', { class: 'note', id: 'own-rays-said' });
  const use = (): void => {
    try {
      app.ownRays = parseRays(text.value);
      said.textContent = `${app.ownRays.length} rays of your own.`;
    } catch (error) {
      app.ownRays = null;
      said.textContent = `These are no rays: ${(error as Error).message}.`;
      return;
    }
    recast();
  };
  const back = button("the area's own", "Cast the area's own rays again", () => {
    app.ownRays = null;
    said.textContent = '';
    recast();
  });
  const file = element('input', { type: 'file', accept: '.json,application/json', 'aria-label': 'a file of rays', onchange: () => void read() });
  const read = async (): Promise<void> => {
    const chosen = file.files?.[0];
    if (!chosen) return;
    text.value = await chosen.text();
    use();
  };
  const body = element('div', {}, text, element('div', { class: 'row' }, button('cast these', 'Cast the rays of this text', use), back), file, said);
  return element('details', {}, element('summary', {}, 'Rays of your own (JSON)'), body);
}

export function rayPanel(app: App): { element: HTMLElement; tell: (ray: number, visited: number[]) => void } {
  const count = element('input', { type: 'number', min: 1, max: 5000, step: 1, 'aria-label': 'rays' });
  const seed = element('input', { type: 'text', inputmode: 'numeric', pattern: '\\d{1,20}', 'aria-label': 'seed' });
  const recast = (): void => {
    app.store.set({ cast: false });
    const rays = Math.min(Math.max(Math.round(Number(count.value)) || 1, 1), 5000);
    const legal = /^\d{1,20}$/.test(seed.value) && BigInt(seed.value) < 1n << 64n;
    app.store.set({ cast: true, rays, seed: legal ? seed.value : app.state.seed });
  };
  const clear = button('clear', 'Cast none', () => app.store.set({ cast: false }));
  const numbers = element('div');
  const pointed = element('p', { class: 'note', id: 'ray-pointed' });
  app.onChange(() => {
    if (document.activeElement !== count) count.value = String(app.state.rays);
    if (document.activeElement !== seed) seed.value = app.state.seed;
    numbers.replaceChildren(results(app));
    pointed.textContent = app.rays.length > 0 ? 'Point at a ray to see the boxes that it visits.' : '';
  });
  const tell = (ray: number, visited: number[]): void => {
    const stats = app.panes[0].stats;
    pointed.textContent =
      ray < 0 || !stats
        ? 'Point at a ray to see the boxes that it visits.'
        : `Ray ${ray} visits ${visited.join(' and ')} boxes; pruned cost ${numberText(stats.prunedCosts[ray])}, ${stats.nearest[ray] ? `hits triangle ${stats.nearest[ray]!.triangle}` : 'misses'}.`;
  };
  const form = element('div', { class: 'row' }, count, 'rays, seed', seed, button('cast', 'Cast rays of the area (r)', recast), clear);
  return { element: element('div', {}, form, numbers, pointed, ownRays(app, recast)), tell };
}
