// A panel on the page: its chart, buttons to save and enlarge it, and its values as a table.
import { parse, View } from 'vega';
import { expressionInterpreter } from 'vega-interpreter';
import { compile } from 'vega-lite';
import { Handler } from 'vega-tooltip';
import { panelCsv } from './csv';
import { button, download, element } from './dom';
import { panelSpec, PUBLISHED, type SpecOptions } from './panel_spec';
import { shortNumber, type Panel } from './report';

const PICTURE_WIDTH = 900; // pixels
const NARROW = 640; // pixels
const SAME_WIDTH = 30; // pixels: the chart follows by itself
const tooltips = new Handler({ theme: 'custom', sanitize: escaped });

function escaped(value: unknown): string {
  return String(value).replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');
}

/** Draws a panel into a box. Vega's expressions are interpreted, so that pages without the right to eval show it. */
async function draw(box: HTMLElement, panel: Panel, options: SpecOptions): Promise<View> {
  const { spec } = compile(panelSpec(panel, options));
  const view = new View(parse(spec, undefined, { ast: true }), {
    expr: expressionInterpreter,
    renderer: 'svg',
    container: box,
    hover: true,
    tooltip: tooltips.call,
  });
  return view.runAsync();
}

/** The panel as a picture of its own: with its title, on white, whatever the page looks like. */
function picture(panel: Panel): View {
  const { spec } = compile(panelSpec(panel, { narrow: false, zoom: false, width: PICTURE_WIDTH, alone: true }));
  return new View(parse(spec, undefined, { ast: true }), { expr: expressionInterpreter, renderer: 'none' });
}

async function savePng(panel: Panel, name: string): Promise<void> {
  const url = await picture(panel).toImageURL('png', 2);
  download(name, await (await fetch(url)).blob());
}

async function saveSvg(panel: Panel, name: string): Promise<void> {
  download(name, new Blob([await picture(panel).toSVG()], { type: 'image/svg+xml' }));
}

/** The whole window for one chart; wheel and drag zoom into its scales. */
function enlarge(panel: Panel): void {
  const box = element('div', { class: 'chart' });
  const close = button('Close', 'Back to the report (Esc)', () => dialog.close());
  const dialog = element(
    'dialog',
    { class: 'enlarged', 'aria-label': panel.title },
    element(
      'div',
      { class: 'bar' },
      element('strong', {}, panel.title),
      element('span', {}, 'Wheel zooms, drag moves, double click resets.'),
      close,
    ),
    box,
  );
  let view: View | undefined;
  dialog.addEventListener('close', () => {
    view?.finalize();
    dialog.remove();
  });
  document.body.append(dialog);
  dialog.showModal();
  const height = Math.max(240, window.innerHeight - 240);
  void draw(box, panel, { narrow: false, zoom: true, width: window.innerWidth * 0.9, height }).then((drawn) => {
    view = drawn;
    box.dataset.drawn = 'true';
  });
}

function valuesTable(panel: Panel): HTMLElement {
  const published = panel.published.length > 0;
  const spread = panel.measured.some((point) => (point.count ?? 1) > 1);
  const columns = [
    'series',
    panel.groups.length > 0 ? 'group' : panel.x.title,
    'value',
    ...(spread ? ['least', 'greatest', 'count'] : []),
  ];
  const body = element('tbody');
  const rows = [
    ...panel.measured.map((p) => ({ p, source: 'measured' })),
    ...panel.published.map((p) => ({ p, source: 'published' })),
  ];
  for (const { p, source } of rows) {
    const cells = [p.series, p.group ?? shortNumber(p.x), shortNumber(p.y)];
    if (spread) cells.push(shortNumber(p.low), shortNumber(p.high), String(p.count ?? 1));
    if (published) cells.push(source);
    body.append(element('tr', {}, ...cells.map((cell) => element('td', {}, cell))));
  }
  const head = element('tr', {}, ...[...columns, ...(published ? ['source'] : [])].map((c) => element('th', {}, c)));
  return element('table', {}, element('thead', {}, head), body);
}

export class PanelView {
  readonly node: HTMLElement;
  private readonly box = element('div', { class: 'chart' });
  private view: View | undefined;
  private narrow = false;
  private width = 0;

  constructor(
    private readonly panel: Panel,
    private readonly name: string,
  ) {
    const values = element('details', { class: 'values' }, element('summary', {}, 'Values'));
    values.addEventListener('toggle', () => {
      if (values.open && values.children.length === 1) values.append(valuesTable(panel));
    });
    const buttons = element(
      'div',
      { class: 'buttons' },
      button('Zoom', 'Enlarge this chart and zoom into it', () => enlarge(panel)),
      button('SVG', 'Save this chart as SVG', () => void saveSvg(panel, `${name}.svg`)),
      button('PNG', 'Save this chart as PNG', () => void savePng(panel, `${name}.png`)),
      button('CSV', 'Save the values of this chart', () =>
        download(`${name}.csv`, new Blob([panelCsv(panel)], { type: 'text/csv' })),
      ),
    );
    const caption = element(
      'figcaption',
      {},
      element('strong', {}, panel.title),
      panel.published.length > 0 && element('small', {}, PUBLISHED),
      buttons,
    );
    this.node = element(
      'figure',
      { class: panel.kind === 'matrix' ? 'panel wide' : 'panel' },
      caption,
      this.box,
      values,
    );
  }

  /** Draws it, again where the width asks for another form. */
  async draw(): Promise<void> {
    const width = this.box.clientWidth;
    const narrow = window.innerWidth < NARROW;
    if (this.view && narrow === this.narrow && Math.abs(width - this.width) < SAME_WIDTH) return;
    this.view?.finalize();
    this.narrow = narrow;
    this.width = width;
    try {
      this.view = await draw(this.box, this.panel, { narrow, zoom: false, width });
      this.box.dataset.drawn = 'true';
    } catch (error) {
      this.box.textContent = `This chart could not be drawn: ${String(error)}`;
      console.error(this.name, error);
    }
  }
}
