// The viewer in headless Chromium, as a reader has it: node test/viewer_test.mjs PROGRAM FOLDER [--smoke | --quick]. First the page's
// arithmetic against the program, then every feature; fails with the first thing that is not as it should be; leaves pictures in FOLDER.
// --smoke: nodes and rays alone; --quick: all but the large scenes.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { WITHOUT_GPU } from '../../scripts/browser.mjs';
import { choose, desktop, folder, here, makePage, program, rayNumbers, redrawn, run, settled, shot, textOf, visit } from './helpers.mjs';
import { checkCompare, checkCost, checkRays, checkRest, checkTop } from './ray_checks.mjs';
import { checkAreas, checkNode, checkScene, checkTrees } from './scene_checks.mjs';

const smoke = process.argv.includes('--smoke');
const quick = smoke || process.argv.includes('--quick');
const shared = process.env.RAYGRAIN_SCENES ?? join(here, '../../../shared/scenes');
const SUN = ['--sun', '0.35,-0.8,0.48'];

function checkPageItself() {
  const unit = spawnSync(process.execPath, [join(here, 'unit.mjs'), program, folder], { stdio: ['ignore', 'pipe', 'inherit'], encoding: 'utf8' });
  assert.equal(unit.status, 0, unit.stdout);
}

/** Trees of a whole scene: rays and costs are those of the view. */
async function checkWithoutAreas() {
  const mesh = join(folder, 'mesh.ply');
  run('scene', 'generate', 'procedural:city?size=2', '-o', mesh);
  await visit(makePage('whole.html', mesh), {}, async (tab) => {
    await tab.keyboard.press('r');
    await tab.waitForFunction(() => document.querySelector('#ray-numbers data[data-name=rays]')?.value === '200');
    assert.ok((await rayNumbers(tab)).hits[0] > 10, 'rays of the view hit the scene');
    await tab.keyboard.press('h');
    await tab.waitForFunction(() => document.querySelector('.cost').dataset.ready === 'true', null, { timeout: 60_000 });
    await shot(tab, 'whole-cost');
    await tab.keyboard.press('Escape');
    await choose(tab, 'Coloured by', 'overlap');
    assert.match(await textOf(tab, '#panel-tree .legend'), /overlap needs an area/);
    await tab.getByRole('button', { name: 'the root' }).click();
    assert.equal(await tab.locator('.hulls').count(), 0, 'no area sees it');
    await settled(tab);
    await shot(tab, 'whole');
  });
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
    const silent = connect(Number(new URL(address).port), '127.0.0.1');  // as browsers' spare connections are
    const asked = performance.now();
    const page = await fetch(address);
    assert.ok(performance.now() - asked < 5000, 'a silent connection keeps nobody waiting');
    silent.destroy();
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
      await redrawn(tab, () => tab.mouse.move(480 + 20 * i, 450));
      await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      redraws.push(Date.now() - began);
    }
    await tab.mouse.up();
    await settled(tab);
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
const spatial = makePage('spatial.html', 'procedural:random100', '--recipes', 'SAH+LSPH,SAH+ALL@spatial', ...SUN);
await visit(spatial, {}, async (tab) => assert.match(await tab.locator('.pane-names').innerText(), /SAH\+LSPH/));
await checkWithoutAreas();
await checkServe();
if (!quick) {
  await checkLarge('sponza', 25, 5);
  await checkLarge('crowd_large', 200, 20);
}
console.log(`viewer: every feature works, costs are the analyzer's; pictures in ${folder}`);
