// What `raygrain report` puts into the page: the structures of include/raygrain/chart.h and study_report.h as JSON.

export type PanelKind = 'bars' | 'ranking' | 'dots' | 'points' | 'lines' | 'matrix';
export type Verdict = 'confirms' | 'partly' | 'contradicts' | 'extends' | 'incomparable' | 'missing';

export interface Point {
  series: string;
  group?: string;
  x?: number;
  y: number | null;
  low?: number | null;
  high?: number | null;
  count?: number;
  label?: string;
}

export interface Axis {
  title: string;
  logarithmic: boolean;
}

export interface Panel {
  title: string;
  kind: PanelKind;
  x: Axis;
  y: Axis;
  groups: string[];
  series: { name: string; colour: string }[];
  measured: Point[];
  published: Point[];
  reference: number | null;
}

export interface Chart {
  id: string;
  label: string;
  title: string;
  finding: string;
  verdict: Verdict;
  verdictText: string;
  notes: string[];
  panels: Panel[];
  table: { columns: string[]; rows: string[][] };
}

export interface Section {
  id: string;
  title: string;
  text: string;
  charts: Chart[];
}

export interface Report {
  title: string;
  facts: { name: string; text: string }[];
  /** Pages that show what was measured. */
  links: { name: string; address: string }[];
  sections: Section[];
}

/** The report in this page; null in a page that was built and not filled yet. */
export function readReport(): Report | null {
  const text = document.getElementById('report-data')?.textContent?.trim() ?? '';
  return text.startsWith('{') ? (JSON.parse(text) as Report) : null;
}

/** Three significant digits, as raygrain writes numbers for people. */
export function shortNumber(value: number | null | undefined): string {
  if (value === null || value === undefined) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(2);
  const before = Math.floor(Math.log10(size)) + 1;
  return value.toFixed(Math.min(Math.max(3 - before, 0), 6));
}
