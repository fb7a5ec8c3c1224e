// The scene: what it holds, and how it is drawn.
import type { App } from '../app';
import { button, checkbox, element, numberText, select, slider, table } from '../dom';
import type { State } from '../state';
import { sub } from '../vec';

export function scenePanel(app: App): HTMLElement {
  const { data, mesh, store } = app;
  const set = (patch: Partial<State>): void => store.set(patch);
  const shaded = checkbox('shaded', (on) => set({ mesh: on }));
  const wire = checkbox('wireframe', (on) => set({ wireframe: on }));
  const members = checkbox("only this tree's triangles", (on) => set({ members: on }));
  const axes = ['none', 'x', 'y', 'z'].map((label, i) => ({ value: String(i), label }));
  const section = select('Section across', axes, (value) => set({ section: Number(value) }));
  const at = slider('at', { min: 0, max: 100, step: 1 }, (value) => set({ sectionAt: value }));
  const up = select('Up axis', axes.slice(1).map(({ label }, i) => ({ value: String(i), label })), (value) => {
    app.stage.setUp(Number(value));
    set({ up: Number(value), light: -1, camera: app.stage.cameraNumbers() });
  });
  app.onChange(() => {
    const { state } = app;
    shaded.set(state.mesh);
    wire.set(state.wireframe);
    members.set(state.members);
    section.set(String(state.section));
    at.set(state.sectionAt);
    at.row.hidden = state.section === 0;
    up.set(String(state.up));
  });
  const size = sub(mesh.box.hi, mesh.box.lo).map(numberText).join(' × ');
  const facts = table([], [
    ['Triangles', numberText(data.triangles)],
    ['Vertices', numberText(data.vertices)],
    ['Size', size],
    ['From', mesh.box.lo.map(numberText).join(', ')],
    ['Areas', numberText(data.areas.length)],
    ['Trees', numberText(data.trees.length)],
  ]);
  facts.id = 'scene-facts';
  const fit = button('Fit', 'Show the whole scene (f)', () => app.see(-1));
  return element('div', {}, facts, element('div', { class: 'row' }, shaded.row, wire.row, fit), members.row, section.row, at.row, up.row);
}
