// The page around the charts: what came out, a table of contents, sections.
import { element } from './dom';
import { PanelView } from './panel_view';
import type { Chart, Report, Section, Verdict } from './report';

const SIGNS: Record<Verdict, string> = { confirms: '✓', partly: '≈', contradicts: '✗', extends: '+', incomparable: '?', missing: '–' };

function sign(chart: Chart): HTMLElement {
  return element('span', { class: `sign ${chart.verdict}`, title: chart.verdictText }, SIGNS[chart.verdict]);
}

function badge(chart: Chart): HTMLElement {
  return element('span', { class: `badge ${chart.verdict}` }, `${SIGNS[chart.verdict]} ${chart.verdictText}`);
}

function heading(chart: Chart): string {
  return chart.label ? `${chart.label}. ${chart.title}` : chart.title;
}

function contents(report: Report): HTMLElement {
  const list = element('ul');
  for (const section of report.sections) {
    const charts = element('ul');
    for (const chart of section.charts)
      charts.append(element('li', {}, sign(chart), element('a', { href: `#${chart.id}` }, chart.label || chart.title)));
    list.append(element('li', {}, element('a', { href: `#${section.id}` }, section.title), charts));
  }
  return element('nav', { 'aria-label': 'Contents' }, list);
}

/** How many of the paper's statements hold, and every finding in one line. */
function summary(report: Report): HTMLElement {
  const box = element('section', { class: 'summary', 'aria-label': 'Summary' }, element('h2', {}, 'What came out'));
  for (const section of report.sections) {
    const judged = section.charts.filter((chart) => ['confirms', 'partly', 'contradicts'].includes(chart.verdict));
    const count = (verdict: Verdict) => judged.filter((chart) => chart.verdict === verdict).length;
    const tally =
      judged.length === 0
        ? ''
        : `${count('confirms')} of ${judged.length} confirm the paper, ${count('partly')} in part, ${count('contradicts')} contradict it.`;
    const list = element('ul', { class: 'findings' });
    for (const chart of section.charts)
      list.append(
        element(
          'li',
          {},
          sign(chart),
          element('a', { href: `#${chart.id}` }, chart.label || chart.title),
          ' ',
          chart.finding,
        ),
      );
    box.append(element('h3', {}, section.title, ' ', element('small', {}, tally)), list);
  }
  return box;
}

function tableOf(chart: Chart): HTMLElement | null {
  const { columns, rows } = chart.table;
  if (rows.length === 0) return null;
  const head = element('tr', {}, ...columns.map((column) => element('th', {}, column)));
  const body = rows.map((row) => element('tr', {}, ...row.map((cell) => element('td', {}, cell))));
  return element(
    'div',
    { class: 'table' },
    element('table', {}, element('thead', {}, head), element('tbody', {}, ...body)),
  );
}

function chartNode(chart: Chart, views: PanelView[]): HTMLElement {
  const article = element(
    'article',
    { id: chart.id },
    element('h3', {}, heading(chart)),
    element('p', { class: 'finding' }, badge(chart), ' ', chart.finding),
  );
  const panels = element('div', { class: 'panels' });
  chart.panels.forEach((panel, index) => {
    const view = new PanelView(panel, `${chart.id}-${index + 1}`);
    views.push(view);
    panels.append(view.node);
  });
  article.append(panels);
  const table = tableOf(chart);
  if (table) article.append(table);
  if (chart.notes.length > 0)
    article.append(element('ul', { class: 'notes' }, ...chart.notes.map((note) => element('li', {}, note))));
  return article;
}

function sectionNode(section: Section, views: PanelView[]): HTMLElement {
  return element(
    'section',
    { id: section.id },
    element('h2', {}, section.title),
    element('p', {}, section.text),
    ...section.charts.map((chart) => chartNode(chart, views)),
  );
}

/** Builds the page; the charts are still to be drawn. */
export function buildPage(root: HTMLElement, report: Report, themeButton: HTMLElement): PanelView[] {
  const views: PanelView[] = [];
  document.title = report.title;
  const facts = element('dl', { class: 'facts' });
  for (const fact of report.facts) facts.append(element('dt', {}, fact.name), element('dd', {}, fact.text));
  const links = element('ul', { class: 'links' });
  for (const link of report.links) links.append(element('li', {}, element('a', { href: link.address }, link.name)));
  root.append(
    element('header', {}, element('h1', {}, report.title), themeButton),
    contents(report),
    element(
      'div',
      { class: 'body' },
      summary(report),
      ...report.sections.map((section) => sectionNode(section, views)),
      element('section', { class: 'measured' }, element('h2', {}, 'What was measured'), facts, report.links.length > 0 && links),
    ),
  );
  return views;
}
