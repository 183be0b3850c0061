// SPDX-License-Identifier: Apache-2.0
// Compares screenshots of the pages with reviewed baselines.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import {
  desktop,
  example,
  open,
  openFile,
  phone,
  program,
  showsFrame,
  showsLayer,
} from './browser.mjs';
import { againstBaseline } from './pictures.mjs';
import { served } from './served.mjs';

// Selectors of the panels, and the fraction of their blocks that may differ: other fonts and versions of
// Chromium move texts by one pixel, which changes up to half of this. Missing content changes more.
const pagePanels = {
  scene: ['#scene', 0.018],
  image: ['#image', 0.035],
  targets: ['#targets', 0.15],
  details: ['#details', 0.07],
  player: ['#transport', 0.03],
  timeline: ['#timeline-panel', 0.065],
};
const reportPanels = {
  targets: ['.tiles', 0.07],
  numbers: ['.tiles + .tiles', 0.07],
  timeline: ['#timeline', 0.065],
  details: ['.report-details', 0.07],
};
const shared = served();

/** Hides times and paths, which differ from run to run. */
const hideTimes = (page) =>
  page.evaluate(() => {
    const times = [
      '.row-body.stages',
      '.row-head.stages .scale',
      '.tiles:not(.targets) .tile:last-child strong',
      'table',
      'header p',
    ];
    for (const name of ['kinematics', 'render', 'classify', 'targets'])
      times.push(`[data-key=${name}]`);
    for (const node of document.querySelectorAll(times.join())) node.style.visibility = 'hidden';
  });

/** Returns the panels that differ from the baseline. */
async function faultyPanels(page, name, panels) {
  const fractions = await againstBaseline(page, name, panels);
  for (const [panel, fraction] of Object.entries(fractions))
    console.log(`${name}: ${(100 * fraction).toFixed(2)} % of ${panel} differ`);
  return Object.keys(fractions).filter((panel) => fractions[panel] > panels[panel][1]);
}

const views = [
  ['desktop-light', desktop, '#frame=3&target=cylinder', 'overlay', () => {}],
  [
    'desktop-dark',
    { ...desktop, colorScheme: 'dark' },
    '#frame=8&target=lid',
    'labels',
    (page) => page.keyboard.press('2'),
  ],
  ['phone-scene', phone, '#frame=2&target=lid', 'overlay', () => {}],
  [
    'phone-image',
    phone,
    '#frame=6&target=wrist',
    'overlay',
    (page) => page.tap('#view-tabs label:has([value=image])'),
  ],
];

for (const [name, options, hash, layer, prepare] of views)
  test(`the page: ${name}`, async () => {
    const { page, faults, close } = await open(shared.browser, shared.server.url + hash, options);
    await showsFrame(page, Number(hash.match(/\d+/)[0]));
    await prepare(page);
    await showsLayer(page, layer);
    await hideTimes(page);
    const faulty = await faultyPanels(page, name, pagePanels);
    assert.deepEqual(faulty, [], `see web/tests/page/failed/${name}.png`);
    assert.deepEqual(faults, []);
    await close();
  });

test('the report is one file without requests', async () => {
  const folder = await mkdtemp(path.join(os.tmpdir(), 'penumbra-report-'));
  execFileSync(program, ['run', example, '-o', folder, '--report'], { stdio: 'ignore' });
  const file = path.join(folder, 'report.html');
  const options = { viewport: { width: 1280, height: 900 }, colorScheme: 'light' };
  const { page, faults, close } = await openFile(shared.browser, file, options);
  assert.equal(await page.locator('.row-body.target-row svg').count(), 4);
  const loaded = await page
    .locator('figure img')
    .evaluateAll((images) => images.map((one) => one.naturalWidth));
  assert.ok(loaded.length > 3 && loaded.every((width) => width > 100));
  await page.locator('figure button').nth(1).click();
  assert.match(await page.locator('.report-details').textContent(), /Frame 2/);
  await hideTimes(page);
  await page.evaluate(() => scrollTo(0, 0));
  assert.deepEqual(await faultyPanels(page, 'report', reportPanels), []);
  const pdf = await page.pdf({ printBackground: true });
  assert.ok(pdf.length > 20_000, 'it prints');
  assert.deepEqual(faults, []);
  await close();
  await rm(folder, { recursive: true });
});
