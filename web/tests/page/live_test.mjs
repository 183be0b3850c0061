// SPDX-License-Identifier: Apache-2.0
// The page of penumbra live, with a recording that is played back.
// PENUMBRA_FULL=1: five minutes of 1280x720 at 30 Hz, on an idle machine: checks lag and rates, too.
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
const full = Boolean(process.env.PENUMBRA_FULL);
const seconds = 300; // of the full run
const leastFrames = 20; // that the page draws in the short run, however long this takes
const rate = full ? '30' : '10'; // times one image a second
const maxLag = 300; // milliseconds, median
const minShownFraction = 0.1; // of the published frames
const minShownRate = 2.5; // Hz
const maxHeapGrowth = 8 * 2 ** 20; // bytes, after a garbage collection
const maxServerGrowth = 64 * 2 ** 20; // the program keeps so much freed memory for later images
const skip = existsSync(bag) ? false : `${bag} does not exist`;

const domain = String(100 + (process.pid % 100));
const running = [];
let browser;

function start(...options) {
  const child = spawn(program, [...options, '--domain', domain], {
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

/** Starts penumbra live and waits for its page. */
async function serveLive(port = '0') {
  const child = start('live', '--package', meshes, '--port', port);
  const [line] = await once(createInterface({ input: child.stdout }), 'line');
  return { child, url: line.match(/http:.*/)[0] };
}

before(async () => {
  if (!skip) browser = await launch();
});
after(async () => {
  await Promise.all(running.map(stop));
});

const showsLive = (page) =>
  page.waitForFunction(() => /lag \d+ ms/.test(document.getElementById('state').textContent));

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** Waits until the page has drawn some frames. */
const draws = (page, count) =>
  page.evaluate(
    (wanted) =>
      new Promise((done) => {
        let drawn = 0;
        new MutationObserver((_, observer) => {
          if (++drawn < wanted) return;
          observer.disconnect();
          done();
        }).observe(document.getElementById('main'), { attributeFilter: ['data-shown'] });
      }),
    count,
  );

/** Watches the page's lag and rates for the full run's duration. */
async function watch(page) {
  const start = await page.evaluate(() => {
    const main = document.getElementById('main');
    window.framesDrawn = 0;
    const count = () => ++window.framesDrawn;
    new MutationObserver(count).observe(main, { attributeFilter: ['data-shown'] });
    return performance.now();
  });
  const samples = [];
  for (let second = 0; second < seconds; ++second) {
    await page.waitForTimeout(1000);
    const text = await page.locator('#state').textContent();
    const match = text.match(/^live · ([\d.]+) Hz · lag (\d+) ms/);
    if (match) samples.push({ rate: match[1], lag: match[2] });
  }
  const shown = await page.evaluate((since) => {
    return (1000 * window.framesDrawn) / (performance.now() - since);
  }, start);
  const of = (key) => samples.map((sample) => Number(sample[key]));
  const [lag, published] = [median(of('lag')), median(of('rate'))];
  console.log(
    `${seconds} s: lag median ${lag} ms, most ${Math.max(...of('lag'))} ms; ` +
      `published ${published.toFixed(1)} Hz, shown ${shown.toFixed(1)} Hz`,
  );
  assert.ok(lag < maxLag, `lag of ${lag} ms`);
  assert.ok(shown > minShownRate, `${shown} Hz shown`);
  assert.ok(shown > minShownFraction * published, `${shown} of ${published} Hz shown`);
}

const mebibytes = (bytes) => (bytes / 2 ** 20).toFixed(1);

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

test('shows frames, keeps its memory, and reconnects to a restarted server', { skip }, async () => {
  const view = await serveLive();
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
  await draws(page, 10); // buffers grow to the size of a frame
  const [heap, resident] = [await heapOf(page), await residentOf(view.child)];
  await (full ? watch(page) : draws(page, leastFrames));
  const growth = (await heapOf(page)) - heap;
  const served = (await residentOf(view.child)) - resident;
  console.log(`page's heap ${mebibytes(growth)} MiB more, server ${mebibytes(served)} MiB more`);
  assert.ok(growth < maxHeapGrowth, `${growth} bytes`);
  assert.ok(served < maxServerGrowth, `${served} bytes`);

  await stop(camera);
  await page.locator('#state', { hasText: /no new frame for \d+ s/ }).waitFor();
  await page.locator('#notes-button.fault').waitFor();
  await page.locator('#notes', { hasText: 'no publisher of' }).waitFor({ state: 'attached' });
  await page.locator('html.stale').waitFor(); // also after the last frames arrived
  playing();
  await showsLive(page);
  await page.locator('html:not(.stale)').waitFor();

  await stop(view.child);
  await page.locator('#state', { hasText: 'no connection: trying again' }).waitFor();
  const fetched = page.waitForRequest((request) => request.url().includes('/api/scene.bin'));
  await serveLive(new URL(view.url).port);
  await showsLive(page);
  await fetched; // the robot may come after the first frame
  assert.equal(scenes, 2, 'the new server’s robot is fetched, although its version is the same');
  assert.deepEqual(faults, []);
  await context.close();
});
