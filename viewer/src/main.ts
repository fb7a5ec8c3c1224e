// Reads the page's data and puts everything together.
import { App } from './app';
import { readData, type ViewData } from './data';
import { button, element, numberText, save, table } from './dom';
import { following, listenToKeys } from './keys';
import { loadMesh } from './mesh';
import { areaPanel } from './panels/area_panel';
import { CostView } from './panels/cost_view';
import { nodePanel } from './panels/node_panel';
import { rayPanel } from './panels/ray_panel';
import { scenePanel } from './panels/scene_panel';
import { topPanel } from './panels/top_panel';
import { treePanel } from './panels/tree_panel';
import { listen } from './pick';
import { canUseWebGL, Stage } from './stage';
import { DEFAULTS, fromHash, Store, type State } from './state';
import './style.css';
import { loadTopLevel } from './top_level';

const root = document.getElementById('app') as HTMLElement;

function firstState(data: ViewData): { state: State; defaults: State } {
  const last = data.trees.findLastIndex((tree) => tree.area === data.trees[0].area);
  const defaults: State = { ...DEFAULTS, other: Math.max(last, 0), seed: data.seed, costFrom: data.trees[0].area };
  const state = fromHash(location.hash, defaults);
  const known = (tree: number): number => (data.trees[tree] ? tree : 0);
  return { state: { ...state, tree: known(state.tree), other: known(state.other) }, defaults };
}

function section(title: string, open: boolean, content: HTMLElement): HTMLElement {
  return element('details', { open, id: `panel-${title.toLowerCase().replace(/ .*/, '')}` }, element('summary', {}, title), content);
}

/** What can be said without a picture. */
function withoutWebGL(data: ViewData): void {
  const rows = data.trees.map((tree) => [tree.recipe, data.areas[tree.area]?.name ?? 'whole scene', ...['estimated_cost', 'nodes', 'max_level'].map((name) => numberText(tree.values.find((v) => v.name === name)?.value ?? NaN))]);
  root.append(
    element(
      'main',
      { class: 'message' },
      element('h1', {}, data.scene),
      element('p', { role: 'alert' }, 'This browser cannot use WebGL 2, which draws the picture. Switch on hardware acceleration in its settings, or open the page in another browser.'),
      table(['Tree', 'Area', 'Estimated cost', 'Nodes', 'Levels'], rows),
    ),
  );
  document.documentElement.dataset.ready = 'true';
}

function toolbar(app: App, help: () => void): HTMLElement {
  const copy = button('Copy link', 'Copy a link that restores this view', () => {
    const link = `${location.href.replace(/#.*/, '')}#${app.store.hash()}`;
    history.replaceState(null, '', link);
    navigator.clipboard?.writeText(link).then(
      () => (copy.textContent = 'Copied'),
      () => (copy.textContent = 'It is in the address bar'),
    );
    setTimeout(() => (copy.textContent = 'Copy link'), 2000);
  });
  const png = button('PNG', 'Save the picture', () => void app.stage.picture().then((blob) => blob && save('view.png', blob)));
  const theme = button('Theme', 'Light, dark, or as the system says (d)', () => app.store.set({ theme: following(['auto', 'light', 'dark'], app.state.theme) }));
  const cost = button('Cost map', 'Cost per pixel (h)', () => app.store.set({ cost: !app.state.cost }));
  const panels = button('Panels', 'Show or hide the panels', () => document.body.classList.toggle('no-panels'));
  return element('div', { class: 'toolbar' }, element('h1', {}, app.data.scene), cost, copy, png, theme, button('?', 'Keyboard', help), panels);
}

async function start(): Promise<void> {
  const data = readData();
  document.title = `${data.scene} · raygrain`;
  if (!canUseWebGL()) return withoutWebGL(data);
  const loading = element('p', { class: 'message', role: 'status' }, `${numberText(data.triangles)} triangles are being unpacked …`);
  root.append(loading);
  const [mesh, top] = await Promise.all([loadMesh(data), loadTopLevel(data)]);
  const { state, defaults } = firstState(data);
  document.documentElement.dataset.theme = state.theme;
  const host = element('div', { class: 'stage' });
  const names = element('div', { class: 'pane-names' });
  const side = element('aside', {});
  loading.remove();
  const main = element('main', { class: 'view' }, host, names);
  root.append(main, side);
  const store = new Store(state, defaults);
  const app = new App(data, mesh, top, store, new Stage(host, mesh.box, state.up));
  const rays = rayPanel(app);
  const cost = new CostView(app);
  main.append(cost.element);
  const sections = [
    section('Tree', true, treePanel(app)),
    section('Node', true, nodePanel(app)),
    section('Rays', true, rays.element),
    section('Areas', true, areaPanel(app)),
    section('Scene', true, scenePanel(app)),
    section('Top level', false, topPanel(app)),
  ];
  side.append(toolbar(app, listenToKeys(app)), ...sections);
  listen(app, rays.tell);
  store.on((changed) => {
    if (changed.has('theme')) document.documentElement.dataset.theme = app.state.theme;
  });
  app.onChange(() => {
    const labels = app.panes.flatMap((pane) => (pane.tree ? [element('span', {}, pane.tree.info.recipe + (pane.stats ? `: ${numberText(pane.stats.pruned_cost)} per ray` : ''))] : []));
    names.replaceChildren(...labels);
  });
  window.addEventListener('hashchange', () => {
    if (location.hash.slice(1) !== store.hash()) location.reload();
  });
  await app.start();
  app.stage.draw();
  document.documentElement.dataset.ready = 'true';
}

start().catch((error: unknown) => {
  root.replaceChildren(element('p', { class: 'message', role: 'alert' }, `This page cannot show its scene: ${(error as Error).message}`));
  throw error;
});
