// SPDX-License-Identifier: Apache-2.0
// node build.mjs [FOLDER]: builds the pages, by default in dist/.
import { readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { build } from 'vite';

const outDir = path.resolve(process.argv[2] ?? 'dist');

for (const mode of ['production', 'report'])
  await build({ mode, logLevel: 'warn', build: { outDir } });

// The licences of bundled libraries.
const { dependencies } = JSON.parse(await readFile('package.json', 'utf8'));
const notices = await Promise.all(
  Object.entries(dependencies).map(async ([name, version]) => {
    const text = await readFile(`node_modules/${name}/LICENSE`, 'utf8');
    return `${name} ${version}\n\n${text.trim()}\n`;
  }),
);
await writeFile(path.join(outDir, 'licences.txt'), notices.join('\n'));
