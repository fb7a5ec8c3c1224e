// Scene, areas, trees and nodes.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { changedShare, choose, drawn, folder, numbers, panel, pixelsOf, settled, shot, textOf } from './helpers.mjs';

export async function checkScene(tab) {
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
  await settled(tab);
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
  await settled(tab);
  await moved(first, 'another axis is up');
  await drawn(tab, () => choose(tab, 'Up axis', '1'));
  await drawn(tab, () => tab.getByLabel('shaded', { exact: true }).uncheck());
  assert.ok((await pixelsOf(tab, [160, 165, 172])) < 200, 'surfaces can be left out');
  await drawn(tab, () => tab.getByLabel('shaded', { exact: true }).check());
}

export async function checkAreas(tab) {
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

export async function checkTrees(tab) {
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
  await settled(tab);
  assert.equal(await count(), value('leaves'), 'the leaves');
  await choose(tab, 'Coloured by', 'random');
  await tab.getByLabel('opaque boxes').check();
  await settled(tab);
  await shot(tab, 'leaves');
  await tab.getByLabel('opaque boxes').uncheck();
  await choose(tab, 'Boxes', 'level');
  await tab.getByLabel('Level', { exact: true }).fill('3');
  await settled(tab);
  assert.equal(await count(), 8, 'a level');
  for (const colour of ['depth', 'measure', 'overlap', 'visits']) {
    await choose(tab, 'Coloured by', colour);
    await settled(tab);
    assert.ok((await tab.locator('.legend .bar').count()) >= 1, `${colour} has a scale`);
    await shot(tab, `colour-${colour}`);
  }
  await tab.getByLabel("only this tree's triangles").check();
  await tab.getByLabel("only this tree's triangles").uncheck();
}

export async function checkNode(tab) {
  await choose(tab, 'Boxes', 'none');
  await tab.locator('.stage canvas').click({ position: { x: 350, y: 490 } });
  await tab.locator('#node-numbers').waitFor();
  const leaf = await numbers(tab, '#node-numbers');
  assert.equal(leaf['Triangles'].length, 1, 'a click on a surface chooses its leaf');
  await settled(tab);
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
  await settled(tab);
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
