// SPDX-License-Identifier: Apache-2.0
// Bundles the TypeScript unit tests and runs them in Node's test runner.
import { spawnSync } from 'node:child_process';
import { mkdtemp, readdir, rm } from 'node:fs/promises';
import path from 'node:path';
import { build } from 'vite';

const folder = path.resolve('tests/unit');
const names = (await readdir(folder)).filter((name) => name.endsWith('_test.ts'));
const outDir = await mkdtemp(path.resolve('node_modules/.unit-'));
await build({
  configFile: false,
  logLevel: 'warn',
  build: {
    ssr: true,
    outDir,
    target: 'node18',
    rollupOptions: {
      input: names.map((name) => path.join(folder, name)),
      output: { entryFileNames: '[name].mjs', chunkFileNames: '[name]-[hash].mjs' },
    },
  },
});
const made = (await readdir(outDir)).filter((name) => /_test\.mjs$/.test(name));
const files = made.map((name) => path.join(outDir, name));
const { status } = spawnSync(process.execPath, ['--test', ...files], { stdio: 'inherit' });
await rm(outDir, { recursive: true });
process.exit(names.length === made.length ? (status ?? 1) : 1);
