// The viewer's pictures of the documents: node test/gallery.mjs PROGRAM FOLDER PICTURES. Each is a link into one page.
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { chromium } from 'playwright-core';
import { SOFTWARE_GL, visit } from '../../scripts/browser.mjs';

const [program, folder, pictures] = process.argv.slice(2).map((path) => resolve(path));
const page = join(folder, 'city.html');
mkdirSync(folder, { recursive: true });
execFileSync(program, ['view', 'procedural:city?size=6', '--recipes', 'SAH+LSPH,PAH+ALL', '--out', page, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });

const VIEWS = {
  'view-node': 'node=1&level=5&theme=dark&hidden=0&show=none',
  'view-compare': 'compare=true&cast=true&rays=60&level=6&colour=visits&theme=dark&hidden=0',
  'view-leaves': 'light=0&show=leaves&colour=random&filled=true&hidden=0',
  'view-cost': 'cost=true&costSize=320&theme=dark',
};
for (const [name, view] of Object.entries(VIEWS)) {
  const options = { flags: SOFTWARE_GL, ready: 'ready', viewport: { width: 1280, height: 760 } };
  await visit(chromium, `file://${page}#${view}`, options, async (tab) => {
    if (view.includes('cost=')) await tab.waitForFunction(() => document.querySelector('.cost').dataset.ready === 'true', null, { timeout: 120_000 });
    await tab.waitForTimeout(1500);
    await tab.screenshot({ path: join(pictures, `${name}.png`) });
  });
}
