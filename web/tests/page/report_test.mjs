// SPDX-License-Identifier: Apache-2.0
// Reports of runs with and without targets.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import {
  desktop,
  example,
  launch,
  openFile,
  overflow,
  phone,
  program,
  smallButtons,
} from './browser.mjs';

let browser, folder, judged, frames;

before(async () => {
  folder = await mkdtemp(path.join(os.tmpdir(), 'penumbra-report-'));
  const options = ['run', example, '-o', folder, '--report', '--targets', 'none'];
  execFileSync(program, options, { stdio: 'ignore' });
  judged = path.join(folder, 'judged');
  execFileSync(program, ['run', example, '-o', judged, '--report'], { stdio: 'ignore' });
  frames = JSON.parse(await readFile(path.join(judged, 'report.json'), 'utf8')).frames;
  browser = await launch();
});
after(() => rm(folder, { recursive: true }));

/** Returns the cells of the table of stages by stage, and the texts of the tiles. */
async function stagesOf(file) {
  const page = await browser.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  await page.goto(pathToFileURL(file).href);
  const rows = await page
    .locator('table tr')
    .evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const tiles = await page.locator('.tile').allTextContents();
  await page.close();
  assert.deepEqual(faults, []);
  return { rows: Object.fromEntries(rows.map(([name, ...cells]) => [name, cells])), tiles };
}

test('without targets their time is a dash', async () => {
  const { rows, tiles } = await stagesOf(path.join(folder, 'report.html'));
  assert.deepEqual(rows.targets, ['–', '–', '–']);
  assert.match(rows.render[0], /^[\d.]+ ms$/);
  assert.match(tiles.at(-1), /[\d.]+ ms.*kinematics, render, classify$/);
});

test('keys move the playhead of a report', async () => {
  const { page, faults, close } = await openFile(browser, path.join(folder, 'report.html'));
  const playhead = page.locator('.playhead');
  await playhead.focus();
  for (const [key, frame] of Object.entries({ End: 11, ArrowLeft: 10, Home: 0, ArrowRight: 1 })) {
    await page.keyboard.press(key);
    assert.equal(await playhead.getAttribute('aria-valuenow'), String(frame), key);
  }
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('End');
  assert.equal(await playhead.getAttribute('aria-valuenow'), '1', 'without focus the page scrolls');
  assert.deepEqual(faults, []);
  await close();
});

test('a key frame selects its frame, and names are text', async () => {
  const html = await readFile(path.join(judged, 'report.html'), 'utf8');
  const { name } = frames[0].targets[0];
  const hostile = '<img src=x onerror=alert(1)>\\u003c/script>';
  const file = path.join(judged, 'hostile.html');
  const escaped = JSON.stringify(hostile).replaceAll('<', '\\u003c');
  await writeFile(file, html.replaceAll(JSON.stringify(name), escaped));
  for (const options of [desktop, phone]) {
    const { page, faults, close } = await openFile(browser, file, options);
    assert.ok((await page.getByText(hostile).count()) > 1);
    assert.equal(await page.locator('img:not([src^="data:image/jpeg"])').count(), 0);
    const images = page.locator('button.image');
    await images.last().click();
    const at = await page.locator('.playhead').getAttribute('aria-valuenow');
    assert.equal(at, String(frames.length - 1));
    assert.equal(await overflow(page), 0);
    assert.deepEqual(faults, []);
    await close();
  }
});

test('the first cards of a report are the targets, and its buttons fit a finger', async () => {
  const { page, close } = await openFile(browser, path.join(judged, 'report.html'), phone);
  const tiles = await page.locator('.tile').allTextContents();
  for (const [index, { name }] of frames[0].targets.entries()) {
    const verdicts = frames.map(({ targets }) => targets[index].verdict);
    const visible = verdicts.filter((verdict) => verdict === 'visible').length;
    assert.ok(tiles[index].startsWith(name), tiles[index]);
    assert.ok(tiles[index].includes(`${visible} of ${frames.length}`), tiles[index]);
  }
  assert.match(await page.locator('.report-details .card').first().textContent(), /^Targets/);
  for (const list of await page.locator('details').all()) {
    const rows = await list.locator('tr button').allTextContents();
    const ranges = rows.map((row) => row.split(' to ').map(Number));
    const listed = ranges.reduce((sum, range) => sum + range.at(-1) - range[0] + 1, 0);
    assert.equal(listed, frames.length, await list.textContent());
  }
  assert.deepEqual(await smallButtons(page), []);
  await close();
});

test('unknown pixels and times are dashes', async () => {
  const page = await readFile(path.join(folder, 'report.html'), 'utf8');
  const [, start, json] = page.match(/^([^]*id="penumbra-report">)([^]*?)<\/script>/);
  const report = JSON.parse(json);
  for (const stage of Object.keys(report.summary.timing_ms)) report.summary.timing_ms[stage] = null;
  report.summary.pixels.robot = null;
  const file = path.join(folder, 'unknown.html');
  await writeFile(file, start + JSON.stringify(report) + page.slice(start.length + json.length));
  const { rows, tiles } = await stagesOf(file);
  assert.deepEqual(rows.kinematics, ['–', '–', '–']);
  assert.match(tiles.at(-1), /–not measured$/);
  assert.match(
    tiles.find((tile) => tile.startsWith('robot pixels')),
    /^robot pixels–/,
  );
});
