// The page's own arithmetic against the program: node test/unit.mjs PROGRAM FOLDER. Bundles test/unit/*.ts with esbuild and runs them in Node.
import { build } from 'esbuild';
import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const program = resolve(process.argv[2] ?? join(here, '../../build/release/bin/raygrain'));
const folder = resolve(process.argv[3] ?? join(here, '../../build/viewer-test'));
mkdirSync(folder, { recursive: true });
const names = readdirSync(join(here, 'unit')).filter((name) => name.endsWith('.test.ts'));
await build({
  entryPoints: names.map((name) => join(here, 'unit', name)),
  bundle: true,
  platform: 'node',
  format: 'esm',
  outdir: join(folder, 'unit'),
  outExtension: { '.js': '.mjs' },
  logLevel: 'warning',
});
const files = names.map((name) => join(folder, 'unit', name.replace(/\.ts$/, '.mjs')));
const run = spawnSync(process.execPath, ['--test', ...files], {
  stdio: 'inherit',
  env: { ...process.env, RAYGRAIN: program, RAYGRAIN_FOLDER: folder },
});
process.exit(run.status ?? 1);
