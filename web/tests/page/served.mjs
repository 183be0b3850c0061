// SPDX-License-Identifier: Apache-2.0
// One browser and one server of the shipped example for all tests of a file.
import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { example, launch, open, serve } from './browser.mjs';

/**
 * @param input what is served
 * Returns an object that has `browser`, `server` and the server's `report` when the tests run. */
export function served(input = example) {
  const shared = { browser: null, server: null, report: null };
  before(async () => {
    [shared.browser, shared.server] = await Promise.all([launch(), serve(input)]);
    shared.report = await (await fetch(new URL('/api/report', shared.server.url))).json();
  });
  after(async () => {
    await shared.browser?.close();
    await shared.server?.stop();
  });

  /** @param address path and hash */
  shared.withPage = async (address, options, use) => {
    const url = new URL(address, shared.server.url).href;
    const shown = await open(shared.browser, url, options);
    try {
      await use(shown.page, shown);
      assert.deepEqual(shown.faults, []);
    } finally {
      await shown.close();
    }
  };
  return shared;
}

export const frameShown = async (page) => Number(await page.locator('#frame-number').textContent());
