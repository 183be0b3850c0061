// SPDX-License-Identifier: Apache-2.0
// Starts Debian's Chromium with software WebGL, and the program under test.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync } from 'node:fs';
import { createInterface } from 'node:readline';
import path from 'node:path';
import { after } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

export const root = fileURLToPath(new URL('../../..', import.meta.url));
export const example = path.join(root, 'examples/arm_over_table');
export const program =
  process.env.PENUMBRA ?? path.join(root, 'build/release/apps/penumbra/penumbra');

const browserPath = process.env.CHROMIUM ?? '/usr/bin/chromium';

const patience = 600_000; // milliseconds until a wait gives up: no test depends on a machine's speed

async function start() {
  for (const file of [browserPath, program])
    if (!existsSync(file)) throw new Error(`${file} does not exist`);
  // Only WebGL uses software OpenGL: with it the page itself takes half as long again to draw.
  const args = [
    '--use-gl=angle',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--disable-gpu-compositing',
  ];
  if (process.getuid?.() === 0) args.push('--no-sandbox'); // Chromium's sandbox refuses root
  const started = await chromium.launch({ executablePath: browserPath, args, timeout: patience });
  const newContext = started.newContext.bind(started);
  started.newContext = async (options) => {
    const context = await newContext(options);
    context.setDefaultTimeout(patience);
    // The page's own limits for answers are the test's patience, too.
    await context.addInitScript(() => {
      AbortSignal.timeout = () => new AbortController().signal;
    });
    return context;
  };
  return started;
}

let browser;
/** Returns the browser of all tests. */
export const launch = () => (browser ??= start());
after(async () => (await browser)?.close());

/**
 * Stops the time of the pages that a context opens later: their timers wait for
 * `page.clock.runFor()`, however slow the machine is. Frames are drawn as always.
 */
export async function stopTime(context) {
  await context.addInitScript(() => {
    window.drawing = [requestAnimationFrame.bind(window), cancelAnimationFrame.bind(window)];
  });
  await context.clock.install({ time: 0 });
  await context.clock.pauseAt(1000);
  await context.addInitScript(() => {
    [window.requestAnimationFrame, window.cancelAnimationFrame] = window.drawing;
  });
}

const children = new Set();
// Those of a test whose hook failed would keep the tests from ending.
after(() => children.forEach((child) => child.kill('SIGKILL')));

/** Starts `penumbra view`, or another command, and waits until all frames are judged. */
export async function serve(input, port = '0', command = 'view', ...options) {
  const child = spawn(program, [command, input, '--port', port, ...options], {
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  children.add(child);
  child.once('exit', () => children.delete(child));
  const lines = createInterface({ input: child.stdout });
  child.stderr.resume();
  let url;
  while (!url) [, url] = /(http\S*)/.exec((await once(lines, 'line'))[0]) ?? [];
  const stop = async () => {
    if (!children.has(child)) return;
    child.kill('SIGINT');
    await once(child, 'exit');
  };
  while (children.has(child)) {
    try {
      const session = await (await fetch(new URL('/api/session', url))).json();
      if (session.complete) return { url, stop };
    } catch (error) {
      // On a busy machine the server may have closed the connection that fetch kept.
      if (!(error instanceof TypeError)) throw error;
    }
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  throw new Error(`penumbra ${command} ended`);
}

export const desktop = { viewport: { width: 1440, height: 900 }, colorScheme: 'light' };
export const phone = {
  viewport: { width: 390, height: 844 },
  colorScheme: 'dark',
  isMobile: true,
  hasTouch: true,
};

/** Opens a page; `faults` collects its errors, and requests to other hosts. */
export async function open(browser, url, options = desktop, beforeLoad = () => {}) {
  const context = await browser.newContext({ deviceScaleFactor: 1, ...options });
  const page = await context.newPage();
  const faults = [];
  page.on('console', (message) => {
    // Software OpenGL always stalls when its image is read.
    if (['error', 'warning'].includes(message.type()) && !message.text().includes('GPU stall'))
      faults.push(message.text());
  });
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('request', (request) => {
    if (!request.url().startsWith(new URL(url).origin) && !/^(blob|data):/.test(request.url()))
      faults.push(`request to another host: ${request.url()}`);
  });
  await beforeLoad(page);
  const shown = { page, faults, close: () => context.close() };
  shown.load = async (address) => {
    const isOpen = page.url() !== 'about:blank';
    if (isOpen)
      await page.evaluate((next) => {
        localStorage.clear();
        history.replaceState(null, '', next); // goto loads nothing where only the hash differs
      }, address);
    faults.length = 0;
    await (isOpen ? page.reload() : page.goto(address));
    await page.locator('#cover').waitFor({ state: 'hidden' });
    await drawn(page);
  };
  await shown.load(url);
  return shown;
}

/** Opens a file; `faults` collects its console messages and all requests. */
export async function openFile(browser, file, options = desktop) {
  const context = await browser.newContext({ deviceScaleFactor: 1, ...options });
  const page = await context.newPage();
  const faults = [];
  const address = pathToFileURL(file).href;
  page.on('console', (message) => faults.push(message.text()));
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('request', (request) => {
    const url = request.url();
    if (url !== address && !url.startsWith('data:')) faults.push(`request of ${url}`);
  });
  await page.goto(address);
  await drawn(page);
  return { page, faults, close: () => context.close() };
}

/** Waits two frames, until changes are on the screen. */
export const drawn = (page) =>
  page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done()))),
  );

/** Waits until the page shows a frame (by its number in the report) with all its values. */
export async function showsFrame(page, number, part = 'labels') {
  await page.waitForFunction(
    (expected) => {
      const [shown, ...parts] = (document.getElementById('main').dataset.shown ?? '').split(' ');
      return shown === expected.number && parts.includes(expected.part);
    },
    { number: String(number), part },
  );
  await drawn(page);
}

/** Waits until the image shows a layer. */
export async function showsLayer(page, layer) {
  await page.waitForFunction(
    (expected) => document.getElementById('main').dataset.layer === expected,
    layer,
  );
  await drawn(page);
}

/** Waits until the page shows a frame that was fetched without a part. */
export async function showsWithout(page, part) {
  await page.waitForFunction((excluded) => {
    const [shown, ...parts] = (document.getElementById('main').dataset.shown ?? '').split(' ');
    return shown !== '' && !parts.includes(excluded);
  }, part);
  await drawn(page);
}

/** Returns by how many pixels the page is wider than the screen. */
export const overflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

/** Returns the visible buttons and choices that are smaller than a finger, 44 pixels. */
export const smallButtons = (page) =>
  page.evaluate(() =>
    // At one moment: a list that is drawn anew has no sizes.
    [...document.querySelectorAll('button, select, label:has(input)')]
      .filter((node) => node.checkVisibility({ checkVisibilityCSS: true }))
      .filter(({ offsetWidth, offsetHeight }) => offsetWidth < 44 || offsetHeight < 44)
      .map((node) => `${node.textContent} ${node.offsetWidth} x ${node.offsetHeight}`),
  );
