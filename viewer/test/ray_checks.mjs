// Rays, top level, costs, comparisons, and what belongs to no panel.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { changedShare, choose, drawn, folder, numbers, panel, pixelsOf, rayNumbers, run, settled, shot, textOf } from './helpers.mjs';

/** Numbers of the panel are those of `raygrain analyze`. */
export async function checkRays(tab, areas, scene) {
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
    await settled(tab);
    assert.ok((await pixelsOf(tab, [255, 170, 40])) > 50, 'rays are drawn');
    await shot(tab, `rays-${area}`);
  }
  await choose(tab, 'Tree', '0');
  await choose(tab, 'Coloured by', 'visits');
  await settled(tab);
  assert.match(await textOf(tab, '#panel-tree .legend .ends'), /^0\s+rays that meet the box\s+\d{2,}$/, 'boxes are coloured by visits');
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

export async function checkTop(tab) {
  await choose(tab, 'Boxes', 'none');
  await panel(tab, 'top').locator('summary').click();
  await choose(tab, 'Cells', 'leaves');
  await settled(tab);
  await shot(tab, 'top-leaves');
  await drawn(tab, () => choose(tab, 'Cells', 'wireframe'));
  await tab.locator('.stage canvas').click({ position: { x: 480, y: 450 } });
  await tab.waitForFunction(() => /Areas/.test(document.getElementById('cell-facts').textContent));
  const cell = await numbers(tab, '#cell-facts');
  assert.match(cell.Areas[0], /noon|lamp|eye/, 'the cell names its areas');
  await shot(tab, 'top-wireframe');
  await choose(tab, 'Cells', 'none');
}

export async function checkCost(tab) {
  await tab.keyboard.press('Escape');
  await tab.getByRole('button', { name: 'Cost map' }).click();
  const ready = () => tab.waitForFunction(() => document.querySelector('.cost').dataset.ready === 'true', null, { timeout: 60_000 });
  await choose(tab, 'Left', '0');
  await choose(tab, 'Right', '1');
  await choose(tab, 'Seen from', '0');
  await settled(tab);
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
  await settled(tab);
  await shot(tab, 'cost-beside');
  await choose(tab, 'Show', 'difference');
  await settled(tab);
  assert.equal(await tab.locator('.cost canvas.right').isVisible(), false);
  await shot(tab, 'cost-difference');
  await tab.getByLabel('nearest hit prunes').uncheck();
  await settled(tab);
  await ready();
  const full = (await tab.locator('.cost .names').getAttribute('data-means')).split(',').map(Number);
  assert.ok(full[0] > means[0] && full[1] > means[1], 'without pruning rays pay more');
  await choose(tab, 'Count', 'visits');
  await settled(tab);
  await ready();
  const visits = (await tab.locator('.cost .names').getAttribute('data-means')).split(',').map(Number);
  assert.ok(visits[0] > 1 && visits[0] < full[0], 'boxes can be counted instead of costs');
  await choose(tab, 'Count', 'cost');
  await tab.keyboard.press('Escape');
  assert.equal(await tab.locator('.cost').isVisible(), false);
}

export async function checkCompare(tab) {
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
  await settled(tab);
  await shot(tab, 'compare');
  await tab.keyboard.press('c');
  await tab.waitForFunction(() => document.querySelectorAll('.pane-names span').length === 1);
}

export async function checkRest(tab) {
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
  await settled(tab);
  assert.equal(await tab.getByLabel('Level', { exact: true }).inputValue(), '5', 'the link restores the level');
  const share = await changedShare(tab, before);
  assert.ok(share < 0.002, `the link restores the picture, but for ${share} of its pixels`);
  const paper = () => tab.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await paper();
  await tab.keyboard.press('d');
  await tab.keyboard.press('d');
  await settled(tab);
  assert.notEqual(await paper(), light, 'd makes it dark');
  await shot(tab, 'dark');
}
