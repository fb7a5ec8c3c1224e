// From a panel to a Vega-Lite specification. Charts are always drawn for white paper; the page's style sheet recolours
// text, rules and published marks for dark screens, so that saved pictures and prints need nothing.
import type { TopLevelSpec } from 'vega-lite';
import { matrixParts } from './matrix_spec';
import { shortNumber, type Panel, type Point } from './report';

export const INK = '#212529';
export const PUBLISHED = 'Dark marks: published values.';
const SOFT = '#5f6770';
const BAR = 13; // pixels of a bar that lies down

export interface SpecOptions {
  narrow: boolean; // a small screen: bars lie down
  zoom: boolean; // wheel and drag change the scales
  width: number; // pixels that there are
  alone?: boolean; // a picture to be saved: of this width, with its title
  height?: number;
}

export type Row = Record<string, string | number | null>;

export function rowOf(point: Point, source: string): Row {
  const range =
    (point.count ?? 1) > 1
      ? `mean of ${point.count}, from ${shortNumber(point.low)} to ${shortNumber(point.high)}`
      : '';
  return {
    series: point.series,
    group: point.group ?? '',
    x: point.x ?? null,
    y: point.y,
    source,
    value: shortNumber(point.y),
    at: point.x === undefined ? '' : shortNumber(point.x),
    about: [point.label, range].filter(Boolean).join('; ') || 'one value',
  };
}

export function tooltip(panel: Panel): object[] {
  const number = panel.kind === 'points' || panel.kind === 'lines';
  return [
    { field: 'series', title: 'series' },
    ...(panel.groups.length > 0 ? [{ field: 'group', title: 'group' }] : []),
    { field: 'value', title: 'value' },
    ...(number ? [{ field: 'at', title: panel.x.title || 'at' }] : []),
    { field: 'source', title: 'source' },
    { field: 'about', title: 'about' },
  ];
}

/** SI prefixes where plain numbers would be long. */
function axisFormat(values: (number | null | undefined)[]): object {
  const sizes = values.filter((v): v is number => typeof v === 'number' && v > 0);
  return Math.max(...sizes) >= 1e5 || Math.min(...sizes) < 1e-2 ? { format: '.3~s' } : {};
}

/** Ticks at the values themselves, where these are few and the axis is logarithmic. */
function numberTicks(panel: Panel): object {
  const places = [...new Set(panel.measured.map((point) => point.x))].filter((x): x is number => x !== undefined);
  return panel.x.logarithmic && places.length <= 12 ? { values: places } : { tickCount: 8 };
}

/** Along which screen axis the values lie, and how groups and numbers are spread across the other. */
function channels(panel: Panel, options: SpecOptions) {
  const lying = panel.kind === 'ranking' || panel.kind === 'dots' || (panel.kind === 'bars' && options.narrow);
  const fromZero = panel.kind === 'bars' || panel.kind === 'ranking';
  const value = {
    field: 'y',
    type: 'quantitative',
    title: panel.y.title,
    stack: null,
    scale: panel.y.logarithmic ? { type: 'log', nice: false, padding: 8 } : { zero: fromZero, nice: true },
    axis: {
      tickCount: lying ? 6 : 5,
      ...(panel.y.logarithmic ? { labelOverlap: true, ...axisFormat(panel.measured.map((p) => p.y)) } : {}),
      ...(lying ? {} : { titleAngle: 0, titleAlign: 'left', titleAnchor: 'end', titleX: 0, titleY: -14 }),
    },
  };
  if (panel.kind === 'points' || panel.kind === 'lines') {
    const x = {
      field: 'x',
      type: 'quantitative',
      title: panel.x.title,
      scale: panel.x.logarithmic ? { type: 'log', nice: false, padding: 8 } : { zero: false, nice: true },
      axis: { grid: false, labelOverlap: true, ...numberTicks(panel), ...axisFormat(panel.measured.map((p) => p.x)) },
    };
    return { lying, position: { x, y: value } };
  }
  const twoWords = panel.groups.every((group) => /^\S+ \S+$/.test(group));
  const group = {
    field: 'group',
    type: 'nominal',
    title: panel.x.title || null,
    sort: panel.groups,
    scale:
      panel.kind === 'dots'
        ? { domain: panel.groups, padding: 0.5 }
        : { domain: panel.groups, paddingInner: 0.25, paddingOuter: 0.12 },
    axis: {
      labelAngle: 0,
      domain: !lying,
      ticks: false,
      labelPadding: 6,
      grid: panel.kind === 'dots',
      labelLimit: options.narrow ? 120 : 320,
      ...(twoWords && !lying ? { labelExpr: "split(datum.label, ' ')" } : {}),
    },
  };
  const names = panel.series.map((series) => series.name);
  const offset = { field: 'series', type: 'nominal', sort: names, scale: { domain: names } };
  const side = panel.kind === 'dots' ? {} : { [lying ? 'yOffset' : 'xOffset']: offset };
  return { lying, position: lying ? { x: value, y: group, ...side } : { x: group, y: value, ...side } };
}

/** As many legend entries in a row as there is room for. */
function legendColumns(panel: Panel, width: number): number {
  const longest = Math.max(...panel.series.map((series) => series.name.length), 1);
  return Math.max(1, Math.min(panel.series.length, Math.floor((width - 70) / (longest * 7.4 + 32))));
}

function height(panel: Panel, lying: boolean, options: SpecOptions): number {
  if (options.height) return options.height;
  if (!lying) return 270;
  const row = panel.kind === 'dots' ? 30 : BAR * panel.series.length + 14;
  return Math.max(80, row * panel.groups.length);
}

/** A dark mark with a light edge, to be seen on any colour: a line across a bar, a diamond elsewhere. */
function publishedLayers(panel: Panel, position: object, lying: boolean, clip: boolean, rows: Row[]): object[] {
  if (rows.length === 0) return [];
  const onBars = panel.kind === 'bars' || panel.kind === 'ranking';
  const layer = (name: string, colour: string, size: number) => ({
    name,
    data: { values: rows },
    mark: onBars
      ? {
          type: 'tick',
          orient: lying ? 'vertical' : 'horizontal',
          thickness: size,
          color: colour,
          clip,
          bandSize: { band: 1.08 },
        }
      : { type: 'point', shape: 'diamond', filled: true, size: size * 30, color: colour, opacity: 1, clip },
    encoding: {
      ...position,
      tooltip: tooltip(panel),
      opacity: { condition: { param: 'picked', value: 1 }, value: 0.1 },
    },
  });
  return [layer('published_edge', '#ffffff', 6), layer('published', INK, 3)];
}

function markOf(panel: Panel, clip: boolean): object {
  switch (panel.kind) {
    case 'bars':
    case 'ranking':
      return { type: 'bar', clip };
    case 'lines':
      return { type: 'line', point: { filled: true, size: 60 }, clip };
    default:
      return { type: 'point', filled: true, size: panel.kind === 'dots' ? 90 : 50, clip };
  }
}

const CONFIG = {
  font: 'system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif',
  title: {
    anchor: 'start',
    frame: 'group',
    fontSize: 15,
    fontWeight: 600,
    color: INK,
    subtitleColor: SOFT,
    subtitleFontSize: 12,
    offset: 12,
  },
  axis: {
    labelFontSize: 12,
    titleFontSize: 12,
    titleFontWeight: 'normal',
    labelColor: INK,
    titleColor: SOFT,
    gridColor: '#e3e6ea',
    domainColor: '#adb5bd',
    tickColor: '#adb5bd',
  },
  legend: { labelFontSize: 13, labelColor: INK, symbolSize: 130 },
  view: { stroke: null },
};

/** What is drawn in the axes of all kinds but the matrix. */
function chartParts(panel: Panel, options: SpecOptions): { height: number; layer: object[] } {
  const { lying, position } = channels(panel, options);
  const shown = (point: Point) => point.y !== null && (point.y > 0 || !panel.y.logarithmic);
  const measured = panel.measured.filter(shown).map((point) => rowOf(point, 'measured here'));
  const published = panel.published.filter(shown).map((point) => rowOf(point, 'published'));
  const names = panel.series.map((series) => series.name);
  const zoomed = panel.groups.length > 0 ? [lying ? 'x' : 'y'] : ['x', 'y'];
  const legend = {
    title: null,
    orient: 'top',
    offset: lying ? 8 : 26,
    columns: legendColumns(panel, options.width),
    labelLimit: 400,
    symbolOpacity: 1,
    symbolType: 'square',
  };
  const marks = {
    name: 'measured',
    params: [
      { name: 'picked', select: { type: 'point', fields: ['series'] }, bind: 'legend' },
      ...(options.zoom ? [{ name: 'zoom', select: { type: 'interval', encodings: zoomed }, bind: 'scales' }] : []),
    ],
    data: { values: measured },
    mark: markOf(panel, options.zoom),
    encoding: {
      ...position,
      color: {
        field: 'series',
        type: 'nominal',
        sort: names,
        scale: { domain: names, range: panel.series.map((series) => series.colour) },
        legend,
      },
      opacity: { condition: { param: 'picked', value: panel.kind === 'points' ? 0.8 : 1 }, value: 0.1 },
      tooltip: tooltip(panel),
    },
  };
  const reference = {
    name: 'reference',
    data: { values: [{}] },
    mark: { type: 'rule', color: SOFT, strokeDash: [4, 3] },
    encoding: { [lying ? 'x' : 'y']: { datum: panel.reference } },
  };
  return {
    height: height(panel, lying, options),
    layer: [
      marks,
      ...(panel.reference === null ? [] : [reference]),
      ...publishedLayers(panel, position, lying, options.zoom, published),
    ],
  };
}

export function panelSpec(panel: Panel, options: SpecOptions): TopLevelSpec {
  const subtitle = panel.published.length > 0 ? { subtitle: PUBLISHED } : {};
  const spec = {
    $schema: 'https://vega.github.io/schema/vega-lite/v6.json',
    width: options.alone ? options.width : 'container',
    autosize: { type: options.alone ? 'pad' : 'fit-x', contains: 'padding' },
    ...(options.alone ? { title: { text: panel.title, ...subtitle } } : {}),
    ...(panel.kind === 'matrix' ? matrixParts(panel, options) : chartParts(panel, options)),
    config: { ...CONFIG, background: options.alone ? 'white' : null },
  };
  return spec as unknown as TopLevelSpec;
}
