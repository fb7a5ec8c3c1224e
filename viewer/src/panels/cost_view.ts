// Costs of pixels as the area sees the scene: two trees under a wiper, beside each other, or their difference.
import type { App } from '../app';
import type { Area } from '../area';
import { divergingColour, gradient, rampColour, type Colour } from '../colours';
import { button, checkbox, element, numberText, save, select, svg } from '../dom';
import { costImage, highPercentile, histogram, meanOf, type CostImage } from '../heat';
import type { CostMode, CostWhat } from '../state';
import { treeName } from './tree_panel';

const BINS = 48;
const TREE_COLOURS = ['#e8590c', '#1c7ed6'];

function paint(canvas: HTMLCanvasElement, image: CostImage, colour: (i: number) => Colour): void {
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext('2d') as CanvasRenderingContext2D;
  const pixels = context.createImageData(image.width, image.height);
  for (let i = 0; i < image.cost.length; ++i) pixels.data.set([...colour(i), 255], 4 * i);
  context.putImageData(pixels, 0, 0);
}

function histogramPicture(images: CostImage[], end: number): SVGElement {
  const counts = images.map((image) => histogram(image.cost, end, BINS));
  const most = Math.max(1, ...counts.flat());
  const picture = svg('svg', { viewBox: `0 0 ${BINS} 20`, class: 'histogram', preserveAspectRatio: 'none', role: 'img', 'aria-label': 'How many pixels cost how much' });
  counts.forEach((list, k) => {
    const path = list.map((n, i) => `L${i},${20 - (20 * n) / most}L${i + 1},${20 - (20 * n) / most}`).join('');
    picture.append(svg('path', { d: `M0,20${path}L${BINS},20Z`, fill: TREE_COLOURS[k], 'fill-opacity': 0.45 }));
  });
  return picture;
}

export class CostView {
  readonly element: HTMLElement;
  private readonly canvases = [element('canvas', { class: 'left' }), element('canvas', { class: 'right' })];
  private readonly pictures = element('div', { class: 'pictures' }, ...this.canvases);
  private readonly wiper = element('input', { type: 'range', min: 0, max: 100, 'aria-label': 'wiper', oninput: () => this.app.store.set({ wiper: Number(this.wiper.value) }) });
  private readonly said = element('p', { class: 'note', id: 'cost-said' });
  private readonly scale = element('div', { class: 'legend' });
  private readonly names = element('div', { class: 'ends names' });
  private readonly chart = element('div');
  private readonly sizes = select('Pixels', ['96', '192', '320', '512'].map((value) => ({ value, label: value })), (value) => this.app.store.set({ costSize: Number(value) }));
  private readonly modes;
  private readonly what;
  private readonly from;
  private readonly trees;
  private readonly pruned = checkbox('nearest hit prunes', (on) => this.app.store.set({ costPruned: on }));
  private images: CostImage[] = [];
  private key = '';
  private run = 0;

  constructor(private readonly app: App) {
    const modes: [CostMode, string][] = [
      ['wiper', 'under a wiper'],
      ['beside', 'side by side'],
      ['difference', 'difference'],
    ];
    this.modes = select('Show', modes.map(([value, label]) => ({ value, label })), (value) => app.store.set({ costMode: value as CostMode }));
    const whats = [
      { value: 'cost', label: 'cost' },
      { value: 'visits', label: 'visited boxes' },
    ];
    this.what = select('Count', whats, (value) => app.store.set({ costWhat: value as CostWhat }));
    const views = [...app.data.areas.map((area, i) => ({ value: String(i), label: area.name })), { value: '-1', label: 'this view' }];
    this.from = select('Seen from', views, (value) => app.store.set({ costFrom: Number(value) }));
    const choices = app.data.trees.map((_, i) => ({ value: String(i), label: treeName(app, i) }));
    this.trees = [
      select('Left', choices, (value) => app.store.set({ tree: Number(value), node: -1 })),
      select('Right', choices, (value) => app.store.set({ other: Number(value), otherNode: -1 })),
    ];
    const close = button('×', 'Close (Esc)', () => app.store.set({ cost: false }));
    const png = button('PNG', 'Save the pictures', () => void this.download());
    const controls = element('div', { class: 'controls' }, ...this.trees.map((t) => t.row), this.from.row, this.what.row, this.modes.row, this.sizes.row, this.pruned.row, png, close);
    this.element = element('section', { class: 'cost', 'aria-label': 'Cost per pixel' }, controls, this.names, this.pictures, this.wiper, this.scale, this.chart, this.said);
    this.pictures.addEventListener('pointermove', (event) => this.point(event));
    app.onChange(() => void this.update());
  }

  private area(): Area {
    return this.app.data.areas[this.app.state.costFrom] ?? this.app.stage.viewArea();
  }

  private async update(): Promise<void> {
    const { state } = this.app;
    this.element.hidden = !state.cost;
    if (!state.cost) return;
    this.trees[0].set(String(state.tree));
    this.trees[1].set(String(state.other));
    this.from.set(String(state.costFrom));
    this.modes.set(state.costMode);
    this.what.set(state.costWhat);
    this.sizes.set(String(state.costSize));
    this.pruned.set(state.costPruned);
    this.wiper.value = String(state.wiper);
    this.wiper.hidden = state.costMode !== 'wiper';
    const key = [state.tree, state.other, state.costFrom, state.costSize, state.costPruned, state.costWhat, state.costFrom < 0 ? state.camera.join() : ''].join();
    if (key !== this.key) await this.compute(key);
    else this.draw();
  }

  private async compute(key: string): Promise<void> {
    this.key = key;
    const run = ++this.run;
    this.element.dataset.ready = 'false';
    const { state, mesh, data } = this.app;
    const area = this.area();
    const trees = await Promise.all([this.app.tree(state.tree), this.app.tree(state.other)]);
    const images: CostImage[] = [];
    for (const tree of trees) {
      const progress = (done: number): boolean => {
        this.said.textContent = `${Math.round(50 * (images.length + done))} % of the rays are traced …`;
        return run === this.run && this.app.state.cost;
      };
      const image = await costImage(tree, mesh, { area, size: state.costSize, pruned: state.costPruned, visits: state.costWhat === 'visits', costs: data.costs, progress });
      if (!image || run !== this.run) {
        if (run === this.run) this.key = '';
        return;
      }
      images.push(image);
    }
    this.images = images;
    this.said.textContent = 'Point at a pixel to read its costs.';
    this.draw();
    this.element.dataset.ready = 'true';
  }

  private draw(): void {
    if (this.images.length < 2) return;
    const { costMode, wiper } = this.app.state;
    const [a, b] = this.images;
    const end = highPercentile(this.images.map((image) => image.cost)) || 1;
    const difference = costMode === 'difference';
    this.pictures.dataset.mode = costMode;
    if (difference) {
      const changes = a.cost.map((cost, i) => b.cost[i] - cost);
      const most = highPercentile([changes.map(Math.abs)]) || 1;
      paint(this.canvases[0], a, (i) => divergingColour(changes[i] / most));
      this.showScale(-most, most, true);
    } else {
      this.images.forEach((image, k) => paint(this.canvases[k], image, (i) => rampColour(image.cost[i] / end)));
      this.showScale(0, end, false);
    }
    this.canvases[1].style.clipPath = costMode === 'wiper' ? `inset(0 0 0 ${wiper}%)` : '';
    this.pictures.style.setProperty('--wiper', `${wiper}%`);
    const { trees } = this.app.data;
    const label = (index: number, image: CostImage): HTMLElement => element('span', {}, `${trees[index].recipe}: mean ${numberText(meanOf(image.cost))}`);
    this.names.replaceChildren(label(this.app.state.tree, a), label(this.app.state.other, b));
    this.names.dataset.means = this.images.map((image) => meanOf(image.cost)).join();
    this.chart.replaceChildren(histogramPicture(this.images, end));
  }

  private showScale(low: number, high: number, diverging: boolean): void {
    const title = diverging ? 'right minus left, per ray' : `${this.app.state.costWhat === 'cost' ? 'cost' : 'visited boxes'} per ray; the scale ends where 99 % of the pixels lie`;
    const ends = element('div', { class: 'ends' }, element('span', {}, numberText(low)), element('span', {}, title), element('span', {}, numberText(high)));
    this.scale.replaceChildren(element('div', { class: 'bar', style: `background:${diverging ? gradient(divergingColour, -1, 1) : gradient(rampColour, 0, 1)}` }), ends);
  }

  private point(event: PointerEvent): void {
    if (this.images.length < 2) return;
    const canvas = (event.target as HTMLElement).closest('canvas') ?? this.canvases[0];
    const box = canvas.getBoundingClientRect();
    const [a, b] = this.images;
    const scale = Math.min(box.width / a.width, box.height / a.height); // the picture stands in the middle of its place
    const column = Math.floor((event.clientX - box.left - (box.width - scale * a.width) / 2) / scale);
    const row = Math.floor((event.clientY - box.top - (box.height - scale * a.height) / 2) / scale);
    if (column < 0 || row < 0 || column >= a.width || row >= a.height) return;
    const i = row * a.width + column;
    this.said.textContent = `Pixel ${column}, ${row}: ${numberText(a.cost[i])} and ${numberText(b.cost[i])}`;
  }

  private async download(): Promise<void> {
    for (const [k, canvas] of this.canvases.entries()) {
      const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, 'image/png'));
      if (blob) save(`cost-${k + 1}.png`, blob);
    }
  }
}
