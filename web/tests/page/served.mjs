// SPDX-License-Identifier: Apache-2.0
// One server and one page for all tests of an input.
import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { example, launch, open, serve } from './browser.mjs';

const all = new Map();

/** Returns an object that has `browser`, `server` and the server's `report` when the tests run. */
export function served(input = example, command = 'view') {
  if (all.has(input)) return all.get(input);
  const shared = { browser: null, server: null, report: null };
  const pages = new Map();
  before(async () => {
    [shared.browser, shared.server] = await Promise.all([launch(), serve(input, '0', command)]);
    shared.report = await (await fetch(new URL('/api/report', shared.server.url))).json();
  });
  after(() => shared.server?.stop());

  /**
   * Loads a page anew. Pages with the same options are one: to open it costs seconds.
   * @param address path and hash
   */
  shared.withPage = async (address, options, use) => {
    const url = new URL(address, shared.server.url).href;
    const key = JSON.stringify(options);
    if (!pages.has(key)) pages.set(key, await open(shared.browser, url, options));
    else await pages.get(key).load(url);
    const shown = pages.get(key);
    await use(shown.page, shown);
    assert.deepEqual(shown.faults, []);
  };
  all.set(input, shared);
  return shared;
}

export const frameShown = async (page) => Number(await page.locator('#frame-number').textContent());
