// SPDX-License-Identifier: Apache-2.0
// How the pages look, against pictures that were looked at and kept.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import {
  desktop,
  drawn,
  example,
  launch,
  open,
  phone,
  program,
  serve,
  showsFrame,
  showsLayer,
} from './browser.mjs';
import { againstBaseline } from './pictures.mjs';

// Blocks that may differ: other fonts and other versions of Chromium move texts by a pixel.
const mostChanged = 0.06;
let browser, server;

before(async () => {
  [browser, server] = await Promise.all([launch(), serve(example)]);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** Times differ from run to run: they are not in the pictures. */
const hideTimes = (page) =>
  page.evaluate(() => {
    const times = [
      '.row-body.stages',
      '.row-head.stages .scale',
      '.tile:last-child strong',
      'table',
    ];
    for (const name of ['kinematics', 'render', 'classify', 'targets'])
      times.push(`[data-key=${name}]`);
    for (const node of document.querySelectorAll(times.join())) node.style.visibility = 'hidden';
  });

const views = [
  ['desktop-light', desktop, '#frame=3&target=cylinder', 'overlay', async () => undefined],
  [
    'desktop-dark',
    { ...desktop, colorScheme: 'dark' },
    '#frame=8&target=lid',
    'labels',
    (page) => page.keyboard.press('2'),
  ],
  ['phone-scene', phone, '#frame=2&target=lid', 'overlay', async () => undefined],
  [
    'phone-image',
    phone,
    '#frame=6&target=wrist',
    'overlay',
    (page) => page.tap('[data-view=picture]'),
  ],
];
for (const [name, options, hash, layer, prepare] of views)
  test(`the page: ${name}`, async () => {
    const { page, faults, close } = await open(browser, server.url + hash, options);
    await showsFrame(page, Number(hash.match(/\d+/)[0]));
    await prepare(page);
    await showsLayer(page, layer);
    await hideTimes(page);
    const share = await againstBaseline(page, name, await page.screenshot());
    console.log(`${name}: ${(100 * share).toFixed(2)} % of blocks differ`);
    assert.ok(share < mostChanged, `${share}: see web/tests/page/failed/${name}.png`);
    assert.deepEqual(faults, []);
    await close();
  });

test('the report: one file that asks for nothing', async () => {
  const folder = await mkdtemp(path.join(os.tmpdir(), 'penumbra-report-'));
  execFileSync(program, ['run', example, '-o', folder, '--report'], { stdio: 'ignore' });
  const context = await browser.newContext({
    viewport: { width: 1280, height: 900 },
    colorScheme: 'light',
  });
  const page = await context.newPage();
  const faults = [];
  page.on('console', (message) => faults.push(message.text()));
  page.on('pageerror', (error) => faults.push(error.message));
  const address = pathToFileURL(path.join(folder, 'report.html')).href;
  page.on('request', ({ url }) => {
    if (url !== undefined && typeof url === 'string' && url !== address) faults.push(url);
  });
  await page.goto(address);
  await drawn(page);
  assert.equal(await page.locator('.row-body.target-row svg').count(), 4);
  const loaded = await page
    .locator('figure img')
    .evaluateAll((images) => images.map((one) => one.naturalWidth));
  assert.ok(loaded.length > 3 && loaded.every((width) => width > 100));
  await page.locator('figure button').nth(1).click();
  assert.match(await page.locator('.report-details').textContent(), /Frame 2/);
  await hideTimes(page);
  const share = await againstBaseline(page, 'report', await page.screenshot());
  console.log(`report: ${(100 * share).toFixed(2)} % of blocks differ`);
  assert.ok(share < mostChanged, `${share}`);
  const pdf = await page.pdf({ printBackground: true });
  assert.ok(pdf.length > 20_000, 'it prints');
  assert.deepEqual(faults, []);
  await context.close();
  await rm(folder, { recursive: true });
});
