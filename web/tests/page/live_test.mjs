// SPDX-License-Identifier: Apache-2.0
// The page beside penumbra live, on a real recording played as if it were live.
// PENUMBRA_LIVE_SECONDS=300: as long, with memory that has to stay flat.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { once } from 'node:events';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { after, before, test } from 'node:test';
import { desktop, launch, program, root } from './browser.mjs';

const data = process.env.PENUMBRA_DATA ?? path.join(root, '../shared/data');
const bag = path.join(data, 'xarm7_realsense/xarm7.mcap');
const meshes = `xarm_description=${path.join(data, 'robots/xarm7/xarm_description')}`;
const seconds = Number(process.env.PENUMBRA_LIVE_SECONDS ?? 6);
const rate = process.env.PENUMBRA_LIVE_RATE ?? '10'; // times one image a second
const mostHeapGrowth = 8 * 2 ** 20; // bytes, after garbage is collected
const mostServerGrowth = 24 * 2 ** 20;
const patience = 60_000; // milliseconds
const skip = existsSync(bag) ? false : `${bag} is not there`;

const domain = String(100 + (process.pid % 100));
const running = [];
let browser;

function start(...words) {
  const child = spawn(program, [...words, '--domain', domain], {
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  child.stderr.resume();
  running.push(child);
  return child;
}

async function stop(child) {
  if (child.exitCode !== null || child.signalCode !== null) return;
  child.kill('SIGINT');
  await once(child, 'exit');
}

async function viewLive(port = '0') {
  const child = start('view', 'live', '--package', meshes, '--port', port);
  const [url] = await once(createInterface({ input: child.stdout }), 'line');
  return { child, url };
}

before(async () => {
  if (!skip) browser = await launch();
});
after(async () => {
  await browser?.close();
  await Promise.all(running.map(stop));
});

const showsLive = (page) =>
  page.waitForFunction(
    () => /lag \d+ ms/.test(document.getElementById('mode').textContent),
    undefined,
    { timeout: patience },
  );

const frameOf = async (page) => Number(await page.locator('#frame-number').textContent());

async function heapOf(page) {
  const session = await page.context().newCDPSession(page);
  await session.send('HeapProfiler.collectGarbage');
  const { usedSize } = await session.send('Runtime.getHeapUsage');
  await session.detach();
  return usedSize;
}

async function residentOf({ pid }) {
  const status = await readFile(`/proc/${pid}/status`, 'utf8');
  return 1024 * Number(status.match(/VmRSS:\s+(\d+)/)[1]);
}

test('frames flow, memory stays, pause holds, a lost server is found again', { skip }, async () => {
  start('live', '--package', meshes);
  const view = await viewLive();
  const context = await browser.newContext({ ...desktop, deviceScaleFactor: 1 });
  const page = await context.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => {
    if (message.type() === 'error' && !/WebSocket|ERR_CONNECTION/.test(message.text()))
      faults.push(message.text());
  });
  let scenes = 0;
  page.on('request', (request) => (scenes += request.url().includes('/api/scene.bin') ? 1 : 0));
  await page.goto(view.url);
  await page.getByText('Waiting for the first frame').waitFor();
  const playing = () => start('play', bag, '--loop', '--restamp', '--rate', rate);
  const camera = playing();

  await showsLive(page);
  await page.waitForTimeout(3000); // buffers grow to what a frame needs
  const [heap, resident] = [await heapOf(page), await residentOf(view.child)];
  const first = await frameOf(page);
  const lags = [];
  for (let second = 0; second < seconds; ++second) {
    await page.waitForTimeout(1000);
    lags.push(Number(await page.locator('#mode').getAttribute('data-lag')));
  }
  const shown = await page.locator('#mode').textContent();
  assert.ok((await frameOf(page)) > first, 'frames came');
  lags.sort((a, b) => a - b);
  const growth = (await heapOf(page)) - heap;
  const served = (await residentOf(view.child)) - resident;
  console.log(
    `${seconds} s: ${shown}; lag median ${lags[lags.length >> 1]} ms, most ${lags.at(-1)} ms; ` +
      `page's heap ${(growth / 2 ** 20).toFixed(1)} MiB more, server ${(served / 2 ** 20).toFixed(1)} MiB more`,
  );
  assert.ok(growth < mostHeapGrowth, `${growth} bytes`);
  assert.ok(served < mostServerGrowth, `${served} bytes`);

  await page.click('#play');
  await page.waitForTimeout(500);
  const held = await frameOf(page);
  await page.waitForTimeout(1500);
  assert.equal(await frameOf(page), held, 'paused');
  assert.match(await page.locator('#mode').textContent(), /^paused/);
  const drawnFrame = (await page.locator('#main').getAttribute('data-shown')).split(' ')[0];
  assert.equal(drawnFrame, String(held), 'numbers and picture are of one frame');
  await page.click('#play');
  await page.waitForFunction(
    (number) => Number(document.getElementById('frame-number').textContent) > number,
    held,
  );

  await stop(camera);
  await page.getByText(/no new frame for \d s/).waitFor();
  await page.locator('#missing-button.fault').waitFor();
  assert.match(await page.locator('#missing').textContent(), /nobody publishes/);
  assert.match(await page.locator('html').getAttribute('class'), /stale/);
  playing();
  await showsLive(page);
  assert.doesNotMatch(await page.locator('html').getAttribute('class'), /stale/);

  await stop(view.child);
  await page.getByText('no connection: trying again').waitFor();
  await viewLive(new URL(view.url).port);
  await showsLive(page);
  assert.equal(scenes, 2, 'the new program’s robot is fetched, though its version is the same');
  assert.deepEqual(faults, []);
  await context.close();
});
