// What the browser tests of all pages share: a page from disk in a headless Chromium of its own, offline, whose console stays silent.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const executable = process.env.CHROMIUM ?? '/usr/bin/chromium';

const FLAGS = [
  '--headless',
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
export const WITHOUT_GPU = ['--disable-gpu'];
/** WebGL by software. */
export const SOFTWARE_GL = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];

/**
 * Opens `address`, waits until the page says that it is `ready` (an attribute data-READY of the document), lets `look` look at it, and
 * demands that nothing was complained about. `chromium` is playwright-core's, `flags` are more of Chromium's own.
 */
export async function visit(chromium, address, { flags, ready, ...options }, look) {
  const profile = mkdtempSync(join(tmpdir(), 'raygrain-browser-'));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: executable,
    args: [...FLAGS, ...flags],
    offline: true,
    acceptDownloads: true,
    ...options,
  });
  try {
    const tab = await browser.newPage();
    const complaints = [];
    tab.on('console', (message) => {
      // Chromium itself remarks on reading pixels back from its software renderer.
      if (['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels/.test(message.text())) complaints.push(message.text());
    });
    tab.on('pageerror', (error) => complaints.push(error.message));
    tab.on('request', (request) => {
      if (/^https?:/.test(request.url()) && !request.url().startsWith(address)) complaints.push(`network: ${request.url()}`);
    });
    await tab.goto(address);
    await tab.waitForFunction((name) => document.documentElement.dataset[name], ready, { timeout: 120_000 });
    await look(tab);
    assert.deepEqual(complaints, [], 'the console stays silent');
  } finally {
    await browser.close();
    rmSync(profile, { recursive: true, force: true });
  }
}
