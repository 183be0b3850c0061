// SPDX-License-Identifier: Apache-2.0
// All tests of the pages, in one browser.
import { readdirSync } from 'node:fs';

for (const name of readdirSync(new URL('.', import.meta.url)))
  if (name.endsWith('_test.mjs')) await import(`./${name}`);
