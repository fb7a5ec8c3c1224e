// A page as the program fills it, read without a browser.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { ViewData } from '../../src/data';

const program = process.env.RAYGRAIN as string;
const folder = join(process.env.RAYGRAIN_FOLDER as string, 'unit');

/** A template that holds nothing but the places for data. */
const TEMPLATE = '<script id="view-data">@RAYGRAIN_VIEW@</script><script id="view-blobs">@RAYGRAIN_BLOBS@</script>';

export function runProgram(arguments_: string[]): string {
  return execFileSync(program, arguments_, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'], maxBuffer: 1 << 28 });
}

export function readText(name: string): string {
  return readFileSync(join(folder, name), 'utf8');
}

export const place = (name: string): string => join(folder, name);

/** Runs `raygrain view` and makes its page the document of this process. */
export function openPage(name: string, arguments_: string[]): void {
  mkdirSync(folder, { recursive: true });
  const template = place('template.html');
  writeFileSync(template, TEMPLATE);
  runProgram(['view', ...arguments_, '--template', template, '--out', place(name), '--quiet']);
  const text = readText(name);
  const getElementById = (id: string): { textContent: string } => {
    const start = text.indexOf('>', text.indexOf(`id="${id}"`)) + 1;
    return { textContent: text.slice(start, text.indexOf('</script>', start)) };
  };
  Object.assign(globalThis, { document: { getElementById } });
}

export type { ViewData };
