// SPDX-License-Identifier: Apache-2.0
// What the live page says of frames that are old, late, damaged or do not come; frames are made up.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { desktop, drawn, phone } from './browser.mjs';
import { playLive } from './live_server.mjs';
import { served } from './served.mjs';

const shared = served();

/** A live page, whose every state is noted: text and whether it is stale. */
async function live(options, use) {
  const context = await shared.browser.newContext({ deviceScaleFactor: 1, ...options });
  const page = await context.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  const camera = await playLive(page, shared.server.url);
  await page.addInitScript(() => {
    window.states = [];
    const note = () => {
      const text = document.getElementById('mode')?.textContent;
      if (text && text !== window.states.at(-1)?.text)
        window.states.push({
          text,
          said: document.getElementById('mode-said').textContent,
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

const slow = 0.3; // Hz: these frames are of now for 8 s, which a loaded machine may need to look

const says = (page, pattern) =>
  page.waitForFunction(
    (source) => new RegExp(source).test(document.getElementById('mode').textContent),
    pattern.source,
  );
const statesOf = (page) => page.evaluate(() => window.states);
const showsNumber = (page, number) =>
  page.waitForFunction(
    (wanted) => document.getElementById('main').dataset.shown?.split(' ')[0] === String(wanted),
    number,
  );

test('a frame that is old when the page is opened is never said to be live', () =>
  live(desktop, async (page, camera) => {
    await showsNumber(page, await camera.send({ age: 32_000 }));
    await says(page, /no new frame for 3[2-9] s/);
    await page.waitForTimeout(1500);
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

test('an old frame after a new connection is none of now either', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ rate: slow });
    await says(page, /^live/);
    await camera.socket.close();
    await says(page, /^no connection/);
    camera.asked = camera.sent;
    await page.evaluate(() => (window.states = []));
    await says(page, /^waiting/);
    await camera.send({ age: 32_000 });
    await says(page, /no new frame for 3[2-9] s/);
    assert.ok(!(await statesOf(page)).some(({ text }) => text.startsWith('live')));
  }));

test('a network that is back after a silence gets a new connection: the old one may be half open', () =>
  live(desktop, async (page, camera) => {
    await camera.send();
    await says(page, /^live/);
    camera.answers = false; // no word on the old connection, either, which nobody closed
    await says(page, /^no new frame/);
    await page.waitForFunction(() => document.getElementById('missing').textContent !== '');
    assert.equal(camera.connections, 1);
    const old = camera.socket;
    camera.answers = true;
    for (let tries = 0; camera.socket === old && tries < 100; ++tries)
      await page.waitForTimeout(50);
    assert.equal(camera.connections, 2);
    await showsNumber(page, await camera.send({ rate: slow }));
    await says(page, /^live/);
    assert.equal(camera.connections, 2);
  }));

test('stamps of another clock are no reason to call frames old that keep coming', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ age: 3_600_000 });
    await says(page, /no new frame for 3600 s/); // of one frame alone nobody can tell
    for (let i = 0; i < 5; ++i)
      await showsNumber(page, await camera.send({ age: 3_600_000, rate: slow }));
    await says(page, /^live/);
    assert.ok(!(await statesOf(page)).at(-1).stale);
  }));

test('a slow camera is given the time that it takes', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ rate: 0.4 });
    await says(page, /^live · 0.4 Hz/);
    await page.waitForTimeout(2500);
    assert.match(await page.locator('#mode').textContent(), /^live/);
    await says(page, /^no new frame/);
  }));

/** Pixels of a screenshot that have a colour. */
async function colored(page, selector) {
  const picture = (await page.locator(selector).screenshot()).toString('base64');
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
  }, picture);
}

test('what is not of now has no colours: no verdict of before looks like one of now', () =>
  live(desktop, async (page, camera) => {
    for (let i = 0; i < 3; ++i)
      await showsNumber(page, await camera.send({ verdict: 'visible', rate: slow }));
    await page.waitForTimeout(700); // numbers and timeline follow
    const panels = ['#target-list', '#target-details', '#timeline', '#picture-frame'];
    for (const panel of panels)
      assert.ok((await colored(page, panel)) > 30, `${panel} has colours`);
    await says(page, /^no new frame/);
    await drawn(page);
    for (const panel of panels) assert.equal(await colored(page, panel), 0, panel);
  }));

test('a packet that cannot be drawn stays told', () =>
  live(desktop, async (page, camera) => {
    const sending = (async () => {
      for (let i = 0; i < 12; ++i) {
        await camera.send({ damage: true });
        await new Promise((resolve) => setTimeout(resolve, 300));
      }
    })();
    await says(page, /cannot be drawn/);
    const seen = new Set();
    for (let i = 0; i < 12; ++i) {
      await page.waitForTimeout(250);
      seen.add(await page.locator('#missing').textContent());
      assert.match(await page.locator('#mode').textContent(), /cannot be drawn/);
    }
    for (const text of seen) assert.match(text, /packet: .*beyond its end/);
    assert.match(await page.locator('#scene-note').textContent(), /cannot be drawn: packet/);
    assert.ok(await page.locator('#missing-button.fault').isVisible());
    await sending;
    await camera.send({ rate: slow });
    await says(page, /^live/);
    assert.ok(await page.locator('#scene-note').isHidden());
  }));

test('states are read aloud, numbers are not', () =>
  live(desktop, async (page, camera) => {
    await camera.send({ rate: slow });
    await says(page, /^live/);
    const live_ = page.locator('#mode-said');
    assert.equal(await live_.getAttribute('role'), 'status');
    assert.equal(await page.locator('#mode').getAttribute('role'), null);
    await page.evaluate(() => {
      window.spoken = [];
      const said = document.getElementById('mode-said');
      new MutationObserver(() => window.spoken.push(said.textContent)).observe(said, {
        childList: true,
        characterData: true,
        subtree: true,
      });
    });
    for (let i = 0; i < 8; ++i)
      await showsNumber(page, await camera.send({ age: 20 + 7 * i, rate: slow }));
    await says(page, /^no new frame for 9/);
    await page.click('#play');
    assert.deepEqual(await page.evaluate(() => window.spoken), [
      'no new frame',
      'paused: this is not live',
    ]);
    assert.equal(await page.locator('#play').getAttribute('aria-label'), 'Play');
    await page.click('#play');
    assert.equal(await page.locator('#play').getAttribute('aria-label'), 'Pause');
  }));

test('keys of what a live page does not have do nothing, and are not told', () =>
  live(desktop, async (page, camera) => {
    await showsNumber(page, await camera.send({ verdict: 'visible' }));
    const chosen = () =>
      page.locator('#target-list [aria-pressed=true]').getAttribute('data-target');
    await page.keyboard.press('ArrowDown');
    const before = await chosen();
    await camera.send({ verdict: 'hidden' }); // an occlusion of all begins
    await page.waitForTimeout(700);
    for (const key of ['[', ']', 'Home', 'End', 'ArrowLeft', 'ArrowRight', '-', '+'])
      await page.keyboard.press(key);
    assert.equal(await chosen(), before);
    assert.equal(await page.locator('#announce').textContent(), '');
    const layer = () => page.locator('#layers :checked').inputValue();
    for (const [key, name] of [
      ['2', 'labels'],
      ['3', 'links'],
      ['4', 'vdi'],
      ['5', 'depth'],
      ['1', 'overlay'],
    ]) {
      await page.keyboard.press(key);
      assert.equal(await layer(), name, key);
    }
    await page.keyboard.press('?');
    const help = await page.locator('#help').textContent();
    assert.match(help, /12345overlay, labels, links, virtual, measured/);
    assert.doesNotMatch(help, /occlusion|slower/);
  }));

test('without the robot, live too', () =>
  live(desktop, async (page, camera) => {
    const points = () => page.locator('#scene-canvas').getAttribute('data-points').then(Number);
    await showsNumber(page, await camera.send({ rate: slow }));
    const all = await points();
    await page.keyboard.press('5'); // a layer that is drawn without labels
    await page.keyboard.press('w');
    await showsNumber(page, await camera.send({ rate: slow }));
    const left = await points();
    assert.ok(left > 0 && left < all, `${left} of ${all} points`);
    assert.ok(camera.wanted.includes('labels'), `${camera.wanted}`);
    assert.equal(await page.locator('#picture-note').textContent(), '');
    await page.keyboard.press('w');
    await showsNumber(page, await camera.send({ rate: slow }));
    assert.equal(await points(), all);
    assert.ok(!camera.wanted.includes('labels'), `${camera.wanted}`);
  }));

test('a phone shows the whole state', () =>
  live({ ...phone, viewport: { width: 360, height: 780 } }, async (page, camera) => {
    const mode = page.locator('#mode');
    const isWhole = async () => {
      const [scroll, client, page_, width] = await mode.evaluate((node) => [
        node.scrollWidth,
        node.clientWidth,
        document.documentElement.scrollWidth,
        document.documentElement.clientWidth,
      ]);
      assert.ok(scroll <= client, `${await mode.textContent()}: ${scroll} > ${client}`);
      assert.equal(page_, width);
    };
    await showsNumber(page, await camera.send({ age: 12_345, rate: 29.97 }));
    await isWhole();
    await camera.send({ age: 12_345, rate: 29.97 });
    await says(page, /^live .*dropped$/);
    await isWhole();
    await says(page, /^no new frame/);
    await isWhole();
    await camera.socket.close();
    await says(page, /^no connection/);
    await isWhole();
  }));
