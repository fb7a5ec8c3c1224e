// The values of a panel as CSV (RFC 4180), measured and published.
import type { Panel, Point } from './report';

function quoted(cell: string): string {
  return /[",\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell;
}

export function panelCsv(panel: Panel): string {
  const columns = ['source', 'series', 'group', 'x', 'value', 'least', 'greatest', 'count', 'label'];
  const row = (source: string, p: Point) =>
    [source, p.series, p.group, p.x, p.y, p.low, p.high, p.count ?? 1, p.label]
      .map((cell) => quoted(cell === null || cell === undefined ? '' : String(cell)))
      .join(',');
  const rows = [
    columns.join(','),
    ...panel.measured.map((point) => row('measured', point)),
    ...panel.published.map((point) => row('published', point)),
  ];
  return rows.join('\r\n') + '\r\n';
}
