// The report in headless Chromium, as a reader has it: node test/page_test.mjs PROGRAM FOLDER. Fails with the first thing
// that is not as it should be; leaves pictures of everything in FOLDER.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { chromium } from 'playwright-core';
import { visit as visitPage, WITHOUT_GPU } from '../../scripts/browser.mjs';
import { areaResults, paperResults } from './paper_results.mjs';

const program = resolve(process.argv[2] ?? '../build/release/bin/raygrain');
const folder = resolve(process.argv[3] ?? '../build/report-page-test');
const OWN = 'MY-OWN+ALL';

function makeReport() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const results = {
    'paper.csv': paperResults(OWN),
    'corrected.csv': paperResults(OWN, 'B', 'C', 'D'),
    'areas.csv': areaResults(),
  };
  for (const [name, text] of Object.entries(results)) writeFileSync(join(folder, name), text);
  const page = join(folder, 'report.html');
  const template = join(program, '../../share/raygrain/report-page.html');
  const files = Object.keys(results).map((name) => join(folder, name));
  const view = join(folder, 'my view.html');
  writeFileSync(view, '<!doctype html><title>view</title><script type="application/json">{"format":"raygrain-view","version":1}</script>');
  execFileSync(program, ['report', ...files, '--out', page, '--template', template, '--views', view], {
    stdio: ['ignore', 'ignore', 'inherit'],
  });
  return page;
}

const visit = (page, options, look) => visitPage(chromium, `file://${page}`, { flags: WITHOUT_GPU, ready: 'drawn', ...options }, look);

/** What is in the charts, panel by panel. */
function charts(tab) {
  return tab.evaluate(() =>
    [...document.querySelectorAll('article')].map((article) => ({
      id: article.id,
      finding: article.querySelector('.finding').textContent,
      panels: [...article.querySelectorAll('.panel')].map((panel) => {
        const box = panel.querySelector('.chart svg')?.getBoundingClientRect();
        return {
          title: panel.querySelector('strong').textContent,
          drawn: panel.querySelector('.chart').dataset.drawn === 'true',
          width: box?.width ?? 0,
          room: panel.getBoundingClientRect().width,
          height: box?.height ?? 0,
          marks: panel.querySelectorAll('.measured_marks path, .measured_layer_1_marks path').length,
          numbers: panel.querySelectorAll('.numbers_marks text').length,
          published: panel.querySelectorAll('.published_marks path').length,
          legend: [...panel.querySelectorAll('.role-legend-label text')].map((text) => text.textContent),
        };
      }),
    })),
  );
}

function checkCharts(all) {
  const figures = all.map((chart) => chart.id);
  for (const number of [14, 16, 17, 18, 19, 20, 22])
    assert.ok(figures.includes(`paper-figure-${number}`), `figure ${number}`);
  assert.ok(figures.includes('table-1'), 'table 1');
  assert.ok(figures.includes('table-2'), 'table 2, published values alone');
  assert.ok(figures.includes('missing-charts'), 'what is missing is listed');
  assert.ok(figures.includes('areas-list-and-octrees-over-many-areas-city'), 'lines');
  for (const chart of all) {
    assert.match(chart.finding, /confirms|contradicts|beyond the paper|not measured/, chart.id);
    assert.match(chart.finding, /\.$/, `${chart.id} says something`);
    for (const panel of chart.panels) {
      const name = `${chart.id}: ${panel.title}`;
      assert.ok(panel.drawn && panel.width > 100 && panel.height > 60, `${name} is drawn`);
      assert.ok(panel.width <= panel.room + 1, `${name} fits into its place`);
      assert.ok(panel.marks > 0 || panel.published > 0, `${name} has marks`);
    }
  }
  const scenes = all.find((chart) => chart.id === 'corrected-by-scene').panels[0];
  assert.equal(scenes.numbers, 8 * 8, 'eight recipes in eight scenes as numbers');
  const panels = (id) => all.find((chart) => chart.id === `paper-figure-${id}`).panels;
  for (const id of [16, 17, 18, 20, 22])
    for (const panel of panels(id)) assert.ok(panel.legend.includes(OWN), `figure ${id} shows ${OWN}: ${panel.title}`);
  assert.equal(
    panels(16).find((panel) => panel.title.startsWith('As in the paper')).published,
    16,
    'published marks of figure 16',
  );
  assert.match(panels(16)[0].title, /users pay/, 'what users pay comes first');
}

/** Points at the first bar of figure 16 and reads what the page says about it. */
async function checkHover(tab) {
  await tab.locator('#paper-figure-16').scrollIntoViewIfNeeded();
  await tab.locator('#paper-figure-16 .measured_marks path').first().hover();
  const tip = tab.locator('#vg-tooltip-element.visible');
  await tip.waitFor({ state: 'visible', timeout: 5000 });
  const text = await tip.innerText();
  assert.match(text, /PAH\+SPFH/);
  assert.match(text, /plane parallel/);
  assert.match(text, /mean of 8/);
}

async function saved(tab, button) {
  const [file] = await Promise.all([
    tab.waitForEvent('download'),
    tab.locator('#paper-figure-16 .panel').nth(1).getByRole('button', { name: button }).click(),
  ]);
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

async function checkDownloads(tab) {
  const svg = await saved(tab, 'SVG');
  assert.equal(svg.name, 'paper-figure-16-2.svg');
  assert.match(svg.bytes.toString(), /^<svg[\s\S]*PAH\+SPFH[\s\S]*<\/svg>\s*$/);
  const png = await saved(tab, 'PNG');
  assert.equal(png.bytes.subarray(1, 4).toString(), 'PNG');
  writeFileSync(join(folder, png.name), png.bytes);
  const csv = (await saved(tab, 'CSV')).bytes.toString().split('\r\n');
  assert.match(csv[0], /^source,series,group,x,value/);
  assert.ok(
    csv.some((line) => line.startsWith('measured,PAH+SPFH,plane parallel,,')),
    'measured values',
  );
  assert.ok(
    csv.some((line) => line.startsWith(`measured,${OWN},`)),
    'own values',
  );
}

/** The enlarged chart: the wheel changes its scale, Esc closes it. */
async function checkZoom(tab) {
  await tab.locator('#paper-figure-16 .panel').first().getByRole('button', { name: 'Zoom' }).click();
  const chart = tab.locator('dialog .chart[data-drawn=true]');
  await chart.waitFor();
  const ticks = () => chart.locator('.role-axis-label text').allTextContents();
  const before = await ticks();
  const box = await chart.boundingBox();
  await tab.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await tab.mouse.wheel(0, -400);
  await tab.waitForFunction(
    (old) => [...document.querySelectorAll('dialog .role-axis-label text')].map((t) => t.textContent).join() !== old,
    before.join(),
    { timeout: 5000 },
  );
  await tab.screenshot({ path: join(folder, 'zoom.png') });
  await tab.keyboard.press('Escape');
  await tab.locator('dialog').waitFor({ state: 'detached' });
}

async function checkValues(tab) {
  const values = tab.locator('#paper-figure-18 details').first();
  await values.locator('summary').click();
  assert.ok((await values.locator('tbody tr').count()) >= 16, 'a table of values');
  await values.locator('summary').click();
}

/** How light the page is behind its text, and the letters of its charts. */
function lightness(tab) {
  return tab.evaluate(() => {
    const sum = (colour) =>
      colour
        .match(/\d+/g)
        .slice(0, 3)
        .reduce((total, part) => total + Number(part), 0) / 765;
    return {
      paper: sum(getComputedStyle(document.querySelector('article')).backgroundColor),
      text: sum(getComputedStyle(document.querySelector('.chart svg .role-axis-label text')).fill),
    };
  });
}

async function everyChart(tab, prefix) {
  for (const article of await tab.locator('article').all())
    await article.screenshot({ path: join(folder, `${prefix}-${await article.getAttribute('id')}.png`) });
}

const report = makeReport();
const desktop = { width: 1400, height: 1000 };

await visit(report, { viewport: desktop, colorScheme: 'light' }, async (tab) => {
  checkCharts(await charts(tab));
  const light = await lightness(tab);
  assert.ok(light.paper > 0.9 && light.text < 0.3, 'dark on light');
  const link = tab.getByRole('link', { name: 'See my view' });
  assert.equal(await link.getAttribute('href'), 'my%20view.html', 'views are linked beside the report');
  await tab.screenshot({ path: join(folder, 'top.png') });
  await checkHover(tab);
  await tab.screenshot({ path: join(folder, 'hover.png') });
  await checkDownloads(tab);
  await checkValues(tab);
  await checkZoom(tab);
  await everyChart(tab, 'light');
});
await visit(report, { viewport: desktop, colorScheme: 'dark' }, async (tab) => {
  const dark = await lightness(tab);
  assert.ok(dark.paper < 0.2 && dark.text > 0.8, 'light on dark');
  await everyChart(tab, 'dark');
  await tab.getByRole('button', { name: /Colours/ }).click();
  await tab.getByRole('button', { name: /Colours/ }).click();
  assert.ok((await lightness(tab)).paper > 0.9, 'the button overrides the system');
  await tab.getByRole('button', { name: /Colours/ }).click();
  await tab.emulateMedia({ media: 'print', colorScheme: 'dark' });
  const print = await lightness(tab);
  assert.ok(print.text < 0.3, 'printed in dark on white, whatever the screen shows');
  assert.equal(await tab.locator('nav').isVisible(), false, 'no contents on paper');
  assert.equal(await tab.getByRole('button', { name: 'CSV' }).first().isVisible(), false, 'no buttons on paper');
  await tab.pdf({ path: join(folder, 'print.pdf'), format: 'A4' });
});
await visit(report, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }, async (tab) => {
  checkCharts(await charts(tab));
  const overflow = await tab.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(overflow <= 1, `nothing hangs over the edge of a small screen (${overflow} pixels)`);
  await tab.locator('#paper-figure-16').screenshot({ path: join(folder, 'phone.png') });
});
console.log(
  `report page: all charts drawn, hover, zoom, downloads, dark, print and phone are good; pictures in ${folder}`,
);
