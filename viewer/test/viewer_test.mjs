// The viewer in headless Chromium, as a reader has it: node test/viewer_test.mjs PROGRAM FOLDER [--smoke | --quick]. First the page's
// arithmetic against the program, then every feature; fails with the first thing that is not as it should be; leaves pictures in FOLDER.
// --smoke: nodes and rays alone; --quick: all but the large scenes.
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { SOFTWARE_GL, visit as visitPage, WITHOUT_GPU } from '../../scripts/browser.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const program = resolve(process.argv[2] ?? join(here, '../../build/release/bin/raygrain'));
const folder = resolve(process.argv[3] ?? join(here, '../../build/viewer-test'));
const smoke = process.argv.includes('--smoke');
const quick = smoke || process.argv.includes('--quick');
const shared = join(here, '../../../shared/scenes');
const desktop = { width: 1300, height: 850 };
const SUN = ['--sun', '0.35,-0.8,0.48'];

const visit = (page, options, look) => visitPage(chromium, `file://${page}`, { flags: SOFTWARE_GL, ready: 'ready', viewport: desktop, ...options }, look);
const run = (...words) => execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

function makePage(name, ...words) {
  const page = join(folder, name);
  run('view', ...words, '--out', page, '--quiet');
  return page;
}

const shot = (tab, name) => tab.screenshot({ path: join(folder, `${name}.png`) });
const textOf = (tab, selector) => tab.locator(selector).innerText();
const frames = (tab) => tab.evaluate(() => Number(document.querySelector('.stage canvas').dataset.frames));

/** Does something and waits until it is drawn. */
async function drawn(tab, act) {
  const before = await frames(tab);
  await act();
  await tab.waitForFunction((n) => Number(document.querySelector('.stage canvas').dataset.frames) > n, before, { timeout: 20_000 });
}

/** How many pixels of the picture are near a colour. */
function pixelsOf(tab, colour) {
  return tab.evaluate(async ([r, g, b]) => {
    const stage = document.querySelector('.stage canvas');
    const copy = document.createElement('canvas');
    copy.width = stage.width;
    copy.height = stage.height;
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(stage, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 40) count += 1;
    return count;
  }, colour);
}

/** The share of pixels in which the picture differs from an earlier one. */
function changedShare(tab, earlier) {
  return tab.evaluate(async (address) => {
    const stage = document.querySelector('.stage canvas');
    const image = new Image();
    image.src = address;
    await image.decode();
    const [now, before] = [stage, image].map((source) => {
      const copy = document.createElement('canvas');
      copy.width = stage.width;
      copy.height = stage.height;
      const context = copy.getContext('2d', { willReadFrequently: true });
      context.drawImage(source, 0, 0);
      return context.getImageData(0, 0, copy.width, copy.height).data;
    });
    let changed = 0;
    for (let i = 0; i < now.length; i += 4) if (now[i] !== before[i] || now[i + 1] !== before[i + 1] || now[i + 2] !== before[i + 2]) changed += 1;
    return (4 * changed) / now.length;
  }, earlier);
}

const numbers = (tab, selector) =>
  tab.evaluate((name) => Object.fromEntries([...document.querySelectorAll(`${name} tbody tr`)].map((row) => [row.children[0].textContent, [...row.children].slice(1).map((cell) => cell.textContent)])), selector);
const rayNumbers = (tab) =>
  tab.evaluate(() => {
    const result = {};
    for (const item of document.querySelectorAll('#ray-numbers data')) (result[item.dataset.name] ??= []).push(Number(item.value));
    return result;
  });
const panel = (tab, name) => tab.locator(`#panel-${name}`);
const choose = (tab, label, value) => tab.getByLabel(label, { exact: true }).selectOption(value);

async function checkScene(tab) {
  const facts = await numbers(tab, '#scene-facts');
  assert.equal(facts.Areas[0], '8');
  assert.equal(facts.Trees[0], '16');
  assert.ok(Number(facts.Triangles[0].replace(/\s/g, '')) > 3000);
  const stage = await tab.locator('.stage canvas').boundingBox();
  const middle = [stage.x + stage.width / 2, stage.y + stage.height / 2];
  const place = () => tab.evaluate(() => document.querySelector('.stage canvas').toDataURL());
  const moved = async (earlier, what) => {
    const share = await changedShare(tab, earlier);
    assert.ok(share > 0.01, `${what}: ${share} of the picture changed`);
    return place();
  };
  const first = await place();
  await tab.mouse.move(...middle);
  await drawn(tab, async () => {
    await tab.mouse.down();
    await tab.mouse.move(middle[0] + 90, middle[1] + 20, { steps: 3 });
    await tab.mouse.up();
  });
  const orbited = await moved(first, 'dragging orbits');
  await drawn(tab, () => tab.mouse.wheel(0, -300));
  const zoomed = await moved(orbited, 'the wheel zooms');
  await drawn(tab, async () => {
    await tab.mouse.down({ button: 'right' });
    await tab.mouse.move(middle[0] + 40, middle[1] + 60, { steps: 3 });
    await tab.mouse.up({ button: 'right' });
  });
  await moved(zoomed, 'the right button pans');
  await drawn(tab, () => tab.getByRole('button', { name: 'Fit' }).click());
  await tab.waitForTimeout(400);
  assert.ok((await changedShare(tab, first)) < 0.002, 'Fit goes back');
  const edges = await pixelsOf(tab, [40, 44, 52]);
  await drawn(tab, () => tab.getByLabel('wireframe', { exact: true }).check());
  assert.ok((await pixelsOf(tab, [40, 44, 52])) > edges + 1000, 'the wireframe is drawn');
  await shot(tab, 'wireframe');
  await drawn(tab, () => tab.getByLabel('wireframe', { exact: true }).uncheck());
  const grey = await pixelsOf(tab, [160, 165, 172]);
  await drawn(tab, () => choose(tab, 'Section across', '2'));
  await drawn(tab, () => tab.getByLabel('at', { exact: true }).fill('2'));
  assert.ok((await pixelsOf(tab, [160, 165, 172])) < 0.7 * grey || (await pixelsOf(tab, [160, 165, 172])) > 1.3 * grey, 'the section cuts the scene open');
  await shot(tab, 'section');
  await drawn(tab, () => choose(tab, 'Section across', '0'));
  await drawn(tab, () => choose(tab, 'Up axis', '2'));
  await tab.waitForTimeout(400);
  await moved(first, 'another axis is up');
  await drawn(tab, () => choose(tab, 'Up axis', '1'));
  await drawn(tab, () => tab.getByLabel('shaded', { exact: true }).uncheck());
  assert.ok((await pixelsOf(tab, [160, 165, 172])) < 200, 'surfaces can be left out');
  await drawn(tab, () => tab.getByLabel('shaded', { exact: true }).check());
}

async function checkAreas(tab) {
  const items = panel(tab, 'areas').locator('.areas li');
  assert.equal(await items.count(), 8);
  const swatch = await items.nth(0).locator('.swatch').evaluate((i) => getComputedStyle(i).backgroundColor.match(/\d+/g).map(Number));
  await drawn(tab, () => tab.getByRole('button', { name: 'none', exact: true }).click());
  const without = await pixelsOf(tab, swatch);
  await drawn(tab, () => tab.getByLabel('show noon').check());
  assert.ok((await pixelsOf(tab, swatch)) > without + 200, 'the oriented box is drawn');
  await shot(tab, 'areas');
  await drawn(tab, () => items.nth(1).getByRole('button', { name: 'only' }).click());
  assert.equal(await tab.getByLabel('show noon').isChecked(), false);
  assert.equal(await items.locator('input:checked').count(), 1, 'one area is isolated');
  assert.match(await tab.locator('.pane-names').innerText(), /SAH\+LSPH/);
  await drawn(tab, () => items.nth(0).getByRole('button', { name: 'see from it' }).click());
  assert.ok(await tab.getByRole('button', { name: 'back' }).isEnabled());
  const fromPlane = await tab.evaluate(() => document.querySelector('.stage canvas').toDataURL());
  await shot(tab, 'see-from-plane');
  await drawn(tab, () => items.nth(7).getByRole('button', { name: 'see from it' }).click());
  assert.ok((await changedShare(tab, fromPlane)) > 0.05, 'each area sees its own picture');
  await shot(tab, 'see-from-point');
  await drawn(tab, () => tab.getByRole('button', { name: 'back' }).click());
  await drawn(tab, () => tab.getByRole('button', { name: 'all', exact: true }).click());
  assert.equal(await items.locator('input:checked').count(), 8);
}

async function checkTrees(tab) {
  await choose(tab, 'Tree', '0');
  await choose(tab, 'Boxes', 'none');
  await tab.waitForFunction(() => document.getElementById('boxes-shown').textContent.startsWith('0 boxes'));
  await choose(tab, 'Boxes', 'all');
  await tab.waitForFunction(() => !document.getElementById('boxes-shown').textContent.startsWith('0 boxes'));
  const count = async () => Number((await textOf(tab, '#boxes-shown')).replace(/\D/g, ''));
  const values = await numbers(tab, '#tree-values');
  const value = (name) => Number(values[name][0].replace(/\s/g, ''));
  await panel(tab, 'tree').locator('details summary').click();
  assert.equal(await count(), value('nodes'), 'all boxes');
  await choose(tab, 'Boxes', 'leaves');
  await tab.waitForTimeout(200);
  assert.equal(await count(), value('leaves'), 'the leaves');
  await choose(tab, 'Coloured by', 'random');
  await tab.getByLabel('opaque boxes').check();
  await tab.waitForTimeout(500);
  await shot(tab, 'leaves');
  await tab.getByLabel('opaque boxes').uncheck();
  await choose(tab, 'Boxes', 'level');
  await tab.getByLabel('Level', { exact: true }).fill('3');
  await tab.waitForTimeout(200);
  assert.equal(await count(), 8, 'a level');
  for (const colour of ['depth', 'measure', 'overlap', 'visits']) {
    await choose(tab, 'Coloured by', colour);
    await tab.waitForTimeout(300);
    assert.ok((await tab.locator('.legend .bar').count()) >= 1, `${colour} has a scale`);
    await shot(tab, `colour-${colour}`);
  }
  await tab.getByLabel("only this tree's triangles").check();
  await tab.getByLabel("only this tree's triangles").uncheck();
}

async function checkNode(tab) {
  await choose(tab, 'Boxes', 'none');
  await tab.locator('.stage canvas').click({ position: { x: 350, y: 490 } });
  await tab.locator('#node-numbers').waitFor();
  const leaf = await numbers(tab, '#node-numbers');
  assert.equal(leaf['Triangles'].length, 1, 'a click on a surface chooses its leaf');
  await tab.waitForTimeout(400);
  assert.ok((await pixelsOf(tab, [230, 230, 0])) > 20, 'its triangle is yellow');
  await shot(tab, 'leaf');
  await choose(tab, 'Boxes', 'level');
  await tab.locator('.stage canvas').click({ position: { x: 480, y: 480 } });
  await tab.waitForFunction(() => document.querySelectorAll('#node-numbers thead th').length === 4);
  const box = await numbers(tab, '#node-numbers');
  assert.equal(box['Level'][0], '3', 'a click on a box chooses it');
  assert.deepEqual(box['Level'].slice(1), ['4', '4']);
  const sum = (cells) => Number(cells[0].replace(/\s/g, '')) - Number(cells[1].replace(/\s/g, '')) - Number(cells[2].replace(/\s/g, ''));
  assert.equal(sum(box['Triangles']), 0);
  for (const name of ['Surface area', 'Projected area', 'P (surface area)', 'P (projected area)', 'Expected cost', 'Overlap with sibling', 'Split across', 'Quality of the axis'])
    assert.match(box[name][0], /^[-\dxyz]/, name);
  await tab.waitForTimeout(300);
  for (const [role, colour] of [['parent', [64, 200, 64]], ['left', [230, 60, 60]], ['right', [70, 110, 255]]]) assert.ok((await pixelsOf(tab, colour)) > 50, `${role} is drawn`);
  assert.equal(await tab.locator('.hulls .left').count(), 1);
  assert.equal(await tab.locator('.hulls .parent').count(), 1);
  await shot(tab, 'node');
  await panel(tab, 'node').screenshot({ path: join(folder, 'node-panel.png') });
  const chosen = () => tab.locator('.outline [aria-selected=true]').innerText();
  const before = await chosen();
  await tab.locator('.outline').click({ position: { x: 150, y: 3 } });
  assert.match(await chosen(), /root 0/, 'a row of the outline chooses its node');
  await tab.keyboard.press('ArrowLeft');
  assert.match(await chosen(), /left 1/);
  await tab.keyboard.press('s');
  assert.match(await chosen(), /right 2/);
  await tab.keyboard.press('ArrowRight');
  assert.equal((await numbers(tab, '#node-numbers')).Level[0], '2');
  await tab.keyboard.press('ArrowUp');
  assert.match(await chosen(), /right 2/);
  assert.notEqual(before, await chosen());
  await tab.keyboard.press('Escape');
  await tab.waitForFunction(() => !document.getElementById('node-numbers'));
  // Boxes of siblings that overlap, as the area sees them.
  await tab.getByRole('button', { name: 'the root' }).click();
  let overlapping = false;
  for (let i = 0; i < 8 && !overlapping; ++i) {
    overlapping = (await tab.locator('.hulls .common').count()) > 0;
    if (!overlapping) await tab.keyboard.press('ArrowLeft');
  }
  assert.ok(overlapping, 'somewhere children overlap, and it is shaded');
  await tab.locator('.hulls').screenshot({ path: join(folder, 'hulls.png') });
}

/** Numbers of the panel are those of `raygrain analyze`. */
async function checkRays(tab, areas, scene) {
  for (const [tree, area] of [[0, 'noon'], [15, 'eye']]) {
    await choose(tab, 'Tree', String(tree));
    await tab.getByLabel('rays', { exact: true }).fill('500');
    await tab.getByLabel('seed', { exact: true }).fill('11');
    await tab.getByRole('button', { name: 'cast', exact: true }).click();
    await tab.waitForFunction((name) => document.querySelector('#ray-numbers data[data-name=rays]')?.value === '500' && document.querySelector('.pane-names').textContent.includes(name), tree ? 'PAH' : 'SAH');
    const page = await rayNumbers(tab);
    const recipe = tree ? 'PAH+ALL' : 'SAH+LSPH';
    const row = JSON.parse(run('analyze', scene, '--areas', areas, '--area', area, '--recipe', recipe, '--rays', '500', '--seed', '11', '--json', '-')).rows[0];
    for (const name of ['real_cost', 'pruned_cost', 'inner_hits', 'leaf_hits', 'leaf_triangles']) assert.equal(page[name][0], row[name], `${area} ${name}`);
    await tab.waitForTimeout(300);
    assert.ok((await pixelsOf(tab, [255, 170, 40])) > 50, 'rays are drawn');
    await shot(tab, `rays-${area}`);
  }
  await choose(tab, 'Tree', '0');
  await choose(tab, 'Coloured by', 'visits');
  await tab.waitForTimeout(300);
  assert.match(await textOf(tab, '.legend .ends'), /^0\s+rays that meet the box\s+\d{2,}$/, 'boxes are coloured by visits');
  await shot(tab, 'visits');
  const stage = await tab.locator('.stage canvas').boundingBox();
  for (let x = 200; x < 900; x += 6) {
    await tab.mouse.move(stage.x + x, stage.y + 300);
    if (/visits/.test(await textOf(tab, '#ray-pointed')) && /Ray \d/.test(await textOf(tab, '#ray-pointed'))) break;
  }
  assert.match(await textOf(tab, '#ray-pointed'), /Ray \d+ visits \d+ boxes; pruned cost/, 'a ray that is pointed at tells of itself');
  await shot(tab, 'ray-hover');
  await panel(tab, 'rays').locator('details summary').click();
  await tab.getByLabel('rays as JSON').fill('[{"origin": [1, 90, 1], "direction": [0, -1, 0]}, [0, 500, 0, 0, 1, 0]]');
  await tab.getByRole('button', { name: 'cast these' }).click();
  await tab.waitForFunction(() => document.querySelector('#ray-numbers data[data-name=rays]')?.value === '2');
  assert.equal((await rayNumbers(tab)).hits[0], 1, 'one of my own rays hits');
  await tab.getByLabel('rays as JSON').fill('[{"origin": [1, 90]}]');
  await tab.getByRole('button', { name: 'cast these' }).click();
  assert.match(await textOf(tab, '#own-rays-said'), /no rays: ray 0: origin/);
  writeFileSync(join(folder, 'rays.json'), '{"rays": [[1, 90, 1, 0, -1, 0]]}');
  await tab.getByLabel('a file of rays').setInputFiles(join(folder, 'rays.json'));
  await tab.waitForFunction(() => document.querySelector('#ray-numbers data[data-name=rays]')?.value === '1');
  await tab.getByRole('button', { name: "the area's own" }).click();
  await tab.waitForFunction(() => document.querySelector('#ray-numbers data[data-name=rays]')?.value === '500');
}

async function checkTop(tab) {
  await choose(tab, 'Boxes', 'none');
  await panel(tab, 'top').locator('summary').click();
  await choose(tab, 'Cells', 'leaves');
  await tab.waitForTimeout(500);
  await shot(tab, 'top-leaves');
  await drawn(tab, () => choose(tab, 'Cells', 'wireframe'));
  await tab.locator('.stage canvas').click({ position: { x: 480, y: 450 } });
  await tab.waitForFunction(() => /Areas/.test(document.getElementById('cell-facts').textContent));
  const cell = await numbers(tab, '#cell-facts');
  assert.match(cell.Areas[0], /noon|lamp|eye/, 'the cell names its areas');
  await shot(tab, 'top-wireframe');
  await choose(tab, 'Cells', 'none');
}

async function checkCost(tab) {
  await tab.keyboard.press('Escape');
  await tab.getByRole('button', { name: 'Cost map' }).click();
  const ready = () => tab.waitForFunction(() => document.querySelector('.cost').dataset.ready === 'true', null, { timeout: 60_000 });
  await choose(tab, 'Left', '0');
  await choose(tab, 'Right', '1');
  await choose(tab, 'Seen from', '0');
  await tab.waitForTimeout(200);
  await ready();
  const means = (await tab.locator('.cost .names').getAttribute('data-means')).split(',').map(Number);
  assert.ok(means[0] > 2 && means[1] > 2 && means[0] !== means[1], `mean costs ${means}`);
  assert.equal(await tab.locator('.cost .histogram path').count(), 2);
  assert.equal(await tab.locator('.cost .bar').count(), 1, 'one colour bar');
  const clip = () => tab.locator('.cost canvas.right').evaluate((c) => c.style.clipPath);
  await tab.getByLabel('wiper').fill('30');
  await tab.waitForFunction(() => document.querySelector('.cost canvas.right').style.clipPath.includes('30%'));
  assert.match(await clip(), /30%/);
  await tab.locator('.cost .pictures').hover();
  assert.match(await textOf(tab, '#cost-said'), /Pixel \d+, \d+: [\d.]+ and [\d.]+/);
  await shot(tab, 'cost-wiper');
  await choose(tab, 'Show', 'beside');
  await tab.waitForTimeout(200);
  await shot(tab, 'cost-beside');
  await choose(tab, 'Show', 'difference');
  await tab.waitForTimeout(200);
  assert.equal(await tab.locator('.cost canvas.right').isVisible(), false);
  await shot(tab, 'cost-difference');
  await tab.getByLabel('nearest hit prunes').uncheck();
  await tab.waitForTimeout(200);
  await ready();
  const full = (await tab.locator('.cost .names').getAttribute('data-means')).split(',').map(Number);
  assert.ok(full[0] > means[0] && full[1] > means[1], 'without pruning rays pay more');
  await tab.keyboard.press('Escape');
  assert.equal(await tab.locator('.cost').isVisible(), false);
}

async function checkCompare(tab) {
  await choose(tab, 'Tree', '0');
  await tab.getByLabel('two trees beside each other').check();
  await choose(tab, 'beside', '1');
  await choose(tab, 'Boxes', 'level');
  await tab.waitForFunction(() => document.querySelectorAll('.pane-names span').length === 2 && document.querySelectorAll('#ray-numbers data[data-name=pruned_cost]').length === 2);
  const page = await rayNumbers(tab);
  assert.notEqual(page.pruned_cost[0], page.pruned_cost[1], 'two costs beside each other');
  assert.equal((await numbers(tab, '#tree-values'))['nodes'].length, 2);
  await tab.locator('.stage canvas').click({ position: { x: 700, y: 470 } });
  await tab.locator('#node-numbers').waitFor();
  await tab.waitForTimeout(400);
  await shot(tab, 'compare');
  await tab.keyboard.press('c');
  await tab.waitForFunction(() => document.querySelectorAll('.pane-names span').length === 1);
}

async function checkRest(tab) {
  await tab.keyboard.press('?');
  await tab.getByRole('dialog').waitFor();
  await shot(tab, 'keys');
  await tab.keyboard.press('Escape');
  const [file] = await Promise.all([tab.waitForEvent('download'), tab.getByRole('button', { name: 'PNG' }).last().click()]);
  const bytes = readFileSync(await file.path());
  assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
  assert.ok(bytes.length > 5000, 'a picture with something in it');
  await choose(tab, 'Boxes', 'level');
  await tab.getByLabel('Level', { exact: true }).fill('5');
  await tab.getByRole('button', { name: 'Copy link' }).click();
  const link = tab.url();
  assert.match(link, /level=5/);
  const before = await tab.evaluate(() => document.querySelector('.stage canvas').toDataURL());
  await tab.goto('about:blank');
  await tab.goto(link);
  await tab.waitForFunction(() => document.documentElement.dataset.ready === 'true');
  await tab.waitForTimeout(500);
  assert.equal(await tab.getByLabel('Level', { exact: true }).inputValue(), '5', 'the link restores the level');
  const share = await changedShare(tab, before);
  assert.ok(share < 0.002, `the link restores the picture, but for ${share} of its pixels`);
  const paper = () => tab.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await paper();
  await tab.keyboard.press('d');
  await tab.keyboard.press('d');
  await tab.waitForTimeout(300);
  assert.notEqual(await paper(), light, 'd makes it dark');
  await shot(tab, 'dark');
}

function checkPageItself() {
  const unit = spawnSync(process.execPath, [join(here, 'unit.mjs'), program, folder], { stdio: ['ignore', 'pipe', 'inherit'], encoding: 'utf8' });
  assert.equal(unit.status, 0, unit.stdout);
}

/** The page as `--serve` offers it. */
async function checkServe() {
  const server = spawn(program, ['view', 'procedural:city?size=2', '--serve'], { stdio: ['ignore', 'pipe', 'inherit'] });
  try {
    const address = await new Promise((done, fail) => {
      let said = '';
      server.stdout.on('data', (text) => {
        said += text;
        const found = /http:\/\/127\.0\.0\.1:\d+\//.exec(said);
        if (found) done(found[0]);
      });
      server.on('exit', () => fail(new Error('the server ended')));
    });
    const page = await fetch(address);
    assert.equal(page.status, 200);
    assert.match(await page.text(), /raygrain-view/);
    assert.equal((await fetch(`${address}other`)).status, 404);
  } finally {
    server.removeAllListeners('exit');
    server.kill('SIGINT');
  }
}

/** The sizes and times that large scenes are to keep. */
async function checkLarge(name, megabytes, seconds) {
  if (!existsSync(join(shared, `${name}.ply`))) {
    console.log(`skipped: ${name}.ply is not there`);
    return;
  }
  const page = makePage(`${name}.html`, join(shared, `${name}.ply`), ...SUN, '--recipes', 'SAH+LSPH,PAH+ALL');
  const size = statSync(page).size / 1e6;
  assert.ok(size < megabytes, `${name}: ${size} MB`);
  await visit(page, { viewport: desktop }, async (tab) => {
    const time = (await tab.evaluate(() => performance.now())) / 1000;
    await tab.mouse.move(480, 450);
    await tab.mouse.down();
    const redraws = [];
    for (let i = 1; i <= 5; ++i) {
      const began = Date.now();
      await drawn(tab, () => tab.mouse.move(480 + 20 * i, 450));
      await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      redraws.push(Date.now() - began);
    }
    await tab.mouse.up();
    await tab.waitForTimeout(2500);
    await shot(tab, name);
    const redraw = redraws.sort((a, b) => a - b)[2];
    console.log(`${name}: ${size.toFixed(1)} MB, ready after ${time.toFixed(1)} s, a drag is redrawn in ${redraw} ms (median of 5)`);
    assert.ok(time < seconds, `${name} is ready after ${time} s`);
    assert.ok(redraw < 500, `${name}: a drag is redrawn in ${redraws} ms`);
  });
}

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
checkPageItself();
const scene = 'procedural:city?size=4';
const areas = join(folder, 'areas.json');
writeFileSync(
  areas,
  JSON.stringify({
    format: 'raygrain-areas',
    version: 1,
    areas: [
      { name: 'noon', sun: { direction: [0.35, -0.8, 0.48] } },
      { name: 'lamp', light: { position: [3, 40, 5] } },
      { name: 'eye', camera: { eye: [70, 45, 80], target: [0, 5, 0], fov_y: 50, aspect: 1.4 } },
    ],
  }),
);
const city = makePage('city.html', scene, '--areas', areas, '--recipes', 'SAH+LSPH,PAH+ALL');

if (smoke) {
  await visit(city, { colorScheme: 'light' }, async (tab) => {
    await choose(tab, 'Boxes', 'level');
    await tab.getByLabel('Level', { exact: true }).fill('3');
    await checkNode(tab);
    await checkRays(tab, areas, scene);
  });
  console.log("viewer: pages open, nodes are picked, costs are the analyzer's");
  process.exit(0);
}
await visit(city, { colorScheme: 'light' }, async (tab) => {
  await shot(tab, 'first');
  await checkScene(tab);
  await checkAreas(tab);
  await checkTrees(tab);
  await checkNode(tab);
  await checkRays(tab, areas, scene);
  await checkTop(tab);
  await checkCompare(tab);
  await checkCost(tab);
  await checkRest(tab);
});
await visit(city, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, colorScheme: 'dark' }, async (tab) => {
  const overflow = await tab.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(overflow <= 1, `nothing hangs over the edge of a small screen (${overflow} pixels)`);
  const stage = await tab.locator('.stage').boundingBox();
  assert.ok(stage.height > 300 && stage.width > 380, 'the picture has room');
  await shot(tab, 'phone');
});
await visit(city, { flags: [...WITHOUT_GPU, '--disable-3d-apis'] }, async (tab) => {
  assert.match(await tab.getByRole('alert').innerText(), /cannot use WebGL/);
  await shot(tab, 'without-webgl');
});
const plain = makePage('plain.html', 'procedural:random100', '--recipes', 'SAH+LSPH,SAH+ALL@spatial', ...SUN);
await visit(plain, {}, async (tab) => assert.match(await tab.locator('.pane-names').innerText(), /SAH\+LSPH/));
await checkServe();
if (!quick) {
  await checkLarge('sponza', 25, 5);
  await checkLarge('crowd_large', 200, 20);
}
console.log(`viewer: every feature works, costs are the analyzer's; pictures in ${folder}`);
