// SPDX-License-Identifier: Apache-2.0
// The live page with simulated frames: old, late, damaged, or none.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { desktop, drawn, overflow, phone, stopTime } from './browser.mjs';
import { playLive } from './live_server.mjs';
import { served } from './served.mjs';

const shared = served();

/** Opens a live page whose time stands still; `window.states` collects its states. */
async function live(options, use) {
  const context = await shared.browser.newContext({ deviceScaleFactor: 1, ...options });
  await stopTime(context);
  const page = await context.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  const camera = await playLive(page, shared.server.url);
  await page.addInitScript(() => {
    window.states = [];
    const note = () => {
      const text = document.getElementById('state')?.textContent;
      if (text && text !== window.states.at(-1)?.text)
        window.states.push({
          text,
          stale: document.documentElement.classList.contains('stale'),
        });
    };
    new MutationObserver(note).observe(document, { subtree: true, childList: true });
  });
  await page.goto(shared.server.url);
  try {
    await use(page, camera);
    assert.deepEqual(faults, []);
  } finally {
    await context.close();
  }
}

const slow = 0.3; // Hz: these frames are up to date for 8 s

const says = (page, pattern) =>
  page.waitForFunction(
    (source) => new RegExp(source).test(document.getElementById('state').textContent),
    pattern.source,
  );
const statesOf = (page) => page.evaluate(() => window.states);
const showsNumber = (page, number) =>
  page.waitForFunction(
    (expected) => document.getElementById('main').dataset.shown?.split(' ')[0] === String(expected),
    number,
  );

test('an old first frame is not live', () =>
  live(desktop, async (page, camera) => {
    await showsNumber(page, await camera.send({ age: 32_000 }));
    await says(page, /no new frame for 3[2-9] s/);
    await page.clock.runFor(1500);
    const states = await statesOf(page);
    assert.deepEqual(
      states.filter(({ text }) => text.startsWith('live')),
      [],
    );
    assert.ok(states.at(-1).stale);
    await camera.send({ rate: slow });
    await says(page, /^live .* lag \d+ ms/);
    assert.ok(!(await statesOf(page)).at(-1).stale);
  }));

test('after a network failure the page opens a new connection, because the old one may be half open', () =>
  live(desktop, async (page, camera) => {
    await camera.send();
    await says(page, /^live/);
    camera.answers = false; // the old connection is silent, but open
    await page.clock.runFor(1500);
    await says(page, /^no new frame/);
    await page.waitForFunction(() => document.getElementById('notes').textContent !== '');
    assert.equal(camera.connections, 1);
    camera.answers = true;
    await page.clock.runFor(1500);
    await camera.connected(2);
    await showsNumber(page, await camera.send({ rate: slow }));
    await says(page, /^live/);
    assert.equal(camera.connections, 2);
  }));

test('regular frames with stamps of another clock are live', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ age: 3_600_000 });
    await says(page, /no new frame for 3600 s/); // unclear from one frame
    for (let i = 0; i < 5; ++i)
      await showsNumber(page, await camera.send({ age: 3_600_000, rate: slow }));
    await says(page, /^live/);
    assert.ok(!(await statesOf(page)).at(-1).stale);
  }));

test('frames of a slow camera stay live longer', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ rate: 0.4 });
    await says(page, /^live · 0.4 Hz/);
    await page.clock.runFor(6000);
    assert.match(await page.locator('#state').textContent(), /^live/);
    await page.clock.runFor(500);
    await says(page, /^no new frame/);
  }));

test('a paused page keeps its frame, the last one that it requested', () =>
  live(desktop, async (page, camera) => {
    await showsNumber(page, await camera.send({ rate: slow }));
    await camera.isAsked();
    await page.click('#play');
    await says(page, /^paused/);
    const last = await camera.send({ rate: slow });
    await showsNumber(page, last);
    await page.clock.runFor(3000);
    assert.equal(await page.locator('#frame-number').textContent(), String(last));
    assert.equal(camera.requested, last);
    await page.click('#play');
    await showsNumber(page, await camera.send({ rate: slow }));
  }));

/** Returns the number of coloured pixels of a screenshot. */
async function colored(page, selector) {
  const screenshot = (await page.locator(selector).screenshot()).toString('base64');
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const rgb = data.subarray(i, i + 3);
      if (Math.max(...rgb) - Math.min(...rgb) > 60) ++count;
    }
    return count;
  }, screenshot);
}

test('old frames are grey: no old verdict looks like a new one', () =>
  live(desktop, async (page, camera) => {
    for (let i = 0; i < 3; ++i)
      await showsNumber(page, await camera.send({ verdict: 'visible', rate: slow }));
    await page.clock.runFor(700); // numbers and timeline follow
    const panels = ['#target-list', '#target-details', '#timeline', '#image-frame'];
    for (const panel of panels)
      assert.ok((await colored(page, panel)) > 30, `${panel} has colours`);
    await page.clock.runFor(9000);
    await says(page, /^no new frame/);
    await drawn(page);
    for (const panel of panels) assert.equal(await colored(page, panel), 0, panel);
  }));

test('damaged packets are reported until a good one comes', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ damage: true });
    await says(page, /cannot be displayed/);
    await page.evaluate(() => (window.states = []));
    for (let i = 0; i < 12; ++i) {
      await camera.send({ damage: true });
      await page.clock.runFor(300);
      assert.match(await page.locator('#notes').textContent(), /packet: .*exceeds/);
      assert.match(await page.locator('#state').textContent(), /cannot be displayed/);
    }
    for (const { text } of await statesOf(page)) assert.match(text, /cannot be displayed/);
    assert.match(await page.locator('#scene-note').textContent(), /cannot be displayed: packet/);
    assert.ok(await page.locator('#notes-button.fault').isVisible());
    await camera.send({ rate: slow });
    await says(page, /^live/);
    assert.ok(await page.locator('#scene-note').isHidden());
  }));

test('screen readers read the state, not its numbers', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ rate: slow });
    await says(page, /^live/);
    assert.equal(await page.locator('#state-name').getAttribute('role'), 'status');
    assert.equal(await page.locator('#state').getAttribute('role'), null);
    await page.evaluate(() => {
      window.spoken = [];
      const said = document.getElementById('state-name');
      new MutationObserver(() => window.spoken.push(said.textContent)).observe(said, {
        childList: true,
        characterData: true,
        subtree: true,
      });
    });
    for (let i = 0; i < 8; ++i)
      await showsNumber(page, await camera.send({ age: 20 + 7 * i, rate: slow }));
    await page.clock.runFor(10_000);
    await says(page, /^no new frame for (9|\d\d)/);
    await page.click('#play');
    assert.deepEqual(await page.evaluate(() => window.spoken), [
      'no new frame',
      'paused: not live',
    ]);
    assert.equal(await page.locator('#play').getAttribute('aria-label'), 'Play');
    await page.click('#play');
    assert.equal(await page.locator('#play').getAttribute('aria-label'), 'Pause');
  }));

test('keys of stored recordings do nothing live, and the help omits them', () =>
  live(desktop, async (page, camera) => {
    await showsNumber(page, await camera.send({ verdict: 'visible' }));
    const selected = () =>
      page.locator('#target-list [aria-pressed=true]').getAttribute('data-target');
    await page.keyboard.press('ArrowDown');
    const before = await selected();
    await showsNumber(page, await camera.send({ verdict: 'hidden' })); // starts an occlusion
    await page.clock.runFor(700);
    for (const key of ['[', ']', 'Home', 'End', 'ArrowLeft', 'ArrowRight', '-', '+'])
      await page.keyboard.press(key);
    assert.equal(await selected(), before);
    assert.equal(await page.locator('#announce').textContent(), '');
    await page.keyboard.press('?');
    const help = await page.locator('#help').innerText();
    assert.match(help, /overlay, labels, links/);
    assert.doesNotMatch(help, /occlusion|slower/);
  }));

test('live, the robot can be removed', () =>
  live(desktop, async (page, camera) => {
    const points = () => page.locator('#scene-canvas').getAttribute('data-points').then(Number);
    await showsNumber(page, await camera.send({ rate: slow }));
    const all = await points();
    await page.keyboard.press('5'); // a layer that needs no labels
    await page.keyboard.press('w');
    await showsNumber(page, await camera.send({ rate: slow }));
    const left = await points();
    assert.ok(left > 0 && left < all, `${left} of ${all} points`);
    assert.ok(camera.parts.includes('labels'), `${camera.parts}`);
    assert.equal(await page.locator('#image-note').textContent(), '');
    await page.keyboard.press('w');
    await showsNumber(page, await camera.send({ rate: slow }));
    assert.equal(await points(), all);
    assert.ok(!camera.parts.includes('labels'), `${camera.parts}`);
  }));

test('a phone shows the state in full', () =>
  live({ ...phone, viewport: { width: 360, height: 780 } }, async (page, camera) => {
    const state = page.locator('#state');
    const isWhole = async () => {
      const more = await state.evaluate((node) => node.scrollWidth - node.clientWidth);
      assert.ok(more <= 0, `${await state.textContent()}: ${more} pixels more`);
      assert.equal(await overflow(page), 0);
    };
    await showsNumber(page, await camera.send({ age: 12_345, rate: 29.97 }));
    await isWhole();
    await camera.send({ age: 12_345, rate: 29.97 });
    await says(page, /^live .*dropped$/);
    await isWhole();
    await page.clock.runFor(1500);
    await says(page, /^no new frame/);
    await isWhole();
    await camera.socket.close();
    await says(page, /^no connection/);
    await isWhole();
  }));
