// What the checks of the viewer share: the program, pages and pictures, and what a page shows.
import { execFileSync } from 'node:child_process';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { SOFTWARE_GL, visit as visitPage } from '../../scripts/browser.mjs';

export const here = dirname(fileURLToPath(import.meta.url));
export const program = resolve(process.argv[2] ?? join(here, '../../build/release/bin/raygrain'));
export const folder = resolve(process.argv[3] ?? join(here, '../../build/viewer-test'));
export const desktop = { width: 1300, height: 850 };

export const visit = (page, options, look) => visitPage(chromium, `file://${page}`, { flags: SOFTWARE_GL, ready: 'ready', viewport: desktop, ...options }, look);
export const run = (...words) => execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

export function makePage(name, ...words) {
  const page = join(folder, name);
  run('view', ...words, '--out', page, '--quiet');
  return page;
}

export const shot = (tab, name) => tab.screenshot({ path: join(folder, `${name}.png`) });
export const textOf = (tab, selector) => tab.locator(selector).innerText();
export const frames = (tab) => tab.evaluate(() => Number(document.querySelector('.stage canvas').dataset.frames));

/** Waits until everything that was asked for is done and drawn. */
export async function settled(tab) {
  await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await tab.waitForFunction(() => document.documentElement.dataset.busy === 'false', null, { timeout: 30_000 });
}

/** Does something and waits until it is drawn. */
export async function drawn(tab, act) {
  await act();
  await settled(tab);
}

/** Does something and waits for the next picture, whatever it shows. */
export async function redrawn(tab, act) {
  const before = await frames(tab);
  await act();
  await tab.waitForFunction((n) => Number(document.querySelector('.stage canvas').dataset.frames) > n, before, { timeout: 20_000 });
}

/** How many pixels of the picture are near a colour. */
export function pixelsOf(tab, colour) {
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
export function changedShare(tab, earlier) {
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

export const numbers = (tab, selector) =>
  tab.evaluate((name) => Object.fromEntries([...document.querySelectorAll(`${name} tbody tr`)].map((row) => [row.children[0].textContent, [...row.children].slice(1).map((cell) => cell.textContent)])), selector);
export const rayNumbers = (tab) =>
  tab.evaluate(() => {
    const result = {};
    for (const item of document.querySelectorAll('#ray-numbers data')) (result[item.dataset.name] ??= []).push(Number(item.value));
    return result;
  });
export const panel = (tab, name) => tab.locator(`#panel-${name}`);
export const choose = (tab, label, value) => tab.getByLabel(label, { exact: true }).selectOption(value);
