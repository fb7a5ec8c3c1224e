import './style.css';
import { element } from './dom';
import { buildPage } from './page';
import type { PanelView } from './panel_view';
import { readReport } from './report';
import { themeButton } from './theme';

const RESIZE_PAUSE = 200; // milliseconds

/** One chart after the other, with room for the reader in between. `data-drawn` says when all are there. */
async function drawAll(views: PanelView[]): Promise<void> {
  delete document.documentElement.dataset.drawn;
  for (const view of views) {
    await view.draw();
    await new Promise((resolve) => setTimeout(resolve));
  }
  document.documentElement.dataset.drawn = String(views.length);
}

const root = document.getElementById('report')!;
const report = readReport();
if (report) {
  const views = buildPage(root, report, themeButton());
  document.documentElement.dataset.panels = String(views.length);
  let drawing = drawAll(views);
  let timer = 0;
  window.addEventListener('resize', () => {
    clearTimeout(timer);
    timer = window.setTimeout(() => {
      drawing = drawing.then(() => drawAll(views));
    }, RESIZE_PAUSE);
  });
} else {
  root.append(element('p', {}, 'This page holds no data yet: raygrain report RESULTS --out report.html fills it.'));
}
