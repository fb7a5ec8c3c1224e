// Values as numbers in a grid: blue where less than the reference is paid, orange where more.
import { rowOf, tooltip, type SpecOptions } from './panel_spec';
import type { Panel } from './report';

const ROW = 26; // pixels
const LESS = '#2b7bba';
const MORE = '#d9480f';
const MOST = 1; // doublings at which a colour is full

export function matrixParts(panel: Panel, options: SpecOptions): { height: number; layer: object[] } {
  const reference = panel.reference ?? 1;
  const rows = panel.measured
    .filter((point) => point.y !== null && point.y > 0)
    .map((point) => {
      const doublings = Math.log2(point.y! / reference);
      return { ...rowOf(point, 'measured here'), doublings: Math.max(-MOST, Math.min(MOST, doublings)) };
    });
  const roomy = options.width / Math.max(1, panel.groups.length) > 90;
  const names = panel.series.map((series) => series.name);
  const position = {
    x: {
      field: 'group',
      type: 'nominal',
      title: null,
      sort: panel.groups,
      scale: { domain: panel.groups, padding: 0.04 },
      axis: {
        orient: 'top',
        domain: false,
        ticks: false,
        labelAngle: roomy ? 0 : -60,
        labelOffset: roomy ? 0 : 8,
        labelLimit: 160,
        ...(options.narrow ? { labelFontSize: 9 } : {}),
      },
    },
    y: {
      field: 'series',
      type: 'nominal',
      title: null,
      sort: names,
      scale: { domain: names, padding: 0.04 },
      axis: { domain: false, ticks: false, labelLimit: 260, ...(options.narrow ? { labelFontSize: 9 } : {}) },
    },
  };
  const range = [LESS, '#ffffff', MORE];
  return {
    height: options.height ?? ROW * names.length + 10,
    layer: [
      {
        name: 'measured',
        data: { values: rows },
        mark: { type: 'rect', cornerRadius: 2 },
        encoding: {
          ...position,
          color: {
            field: 'doublings',
            type: 'quantitative',
            legend: null,
            scale: { domain: [-MOST, 0, MOST], range, interpolate: 'rgb' },
          },
          opacity: { value: 0.85 },
          tooltip: tooltip(panel),
        },
      },
      {
        name: 'numbers',
        data: { values: rows },
        mark: { type: 'text', fontSize: options.narrow ? 9 : 11.5, color: '#111418' },
        encoding: {
          ...position,
          text: options.narrow ? { field: 'y', type: 'quantitative', format: '.2f' } : { field: 'value' },
        },
      },
    ],
  };
}
