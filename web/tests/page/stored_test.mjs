// SPDX-License-Identifier: Apache-2.0
// The page of a stored recording: frames, timeline, numbers.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { desktop, open, showsFrame, stopTime } from './browser.mjs';
import { changedFraction } from './pictures.mjs';
import { frameShown, served } from './served.mjs';

const step = process.env.PENUMBRA_FULL ? 1 : 4; // compares the numbers of every step-th frame

const shared = served();
const { withPage } = shared;

test('the numbers of all targets are those of report.json', () =>
  withPage('/', desktop, async (page) => {
    let compared = 0;
    for (const frame of shared.report.frames) {
      if (frame.index % step !== 0) continue;
      await showsFrame(page, frame.index);
      for (const target of frame.targets) {
        await page.locator(`[data-target="${target.name}"]`).click();
        const shown = await page
          .locator('#target-details [data-key]')
          .evaluateAll((nodes) =>
            nodes.map((node) => [node.dataset.key, node.dataset.value, node.textContent]),
          );
        for (const [key, value, text] of shown) {
          const expected = key in target ? target[key] : (target.handled?.[key] ?? null);
          assert.deepEqual(JSON.parse(value), expected, `${frame.index} ${target.name} ${key}`);
          if (key.endsWith('_fraction') && expected !== null)
            assert.ok(
              Math.abs(Number.parseFloat(text) / 100 - expected) <= 0.5001e-4,
              `${key}: ${text}`,
            );
          if (expected === null) assert.equal(text, '–');
          ++compared;
        }
        const blame = await page.locator('#target-details .blame-bars li').allTextContents();
        assert.equal(blame.length, target.blame.length);
        target.blame.forEach(({ link }, index) => assert.ok(blame[index].startsWith(link)));
      }
      for (let i = 0; i < step; ++i) await page.keyboard.press('ArrowRight');
    }
    assert.ok(compared > (12 / step) * 4 * 12, `${compared} numbers`);
  }));

test('steps and jumps', () =>
  withPage('/', desktop, async (page) => {
    await page.click('#step-forward');
    await showsFrame(page, 1);
    await page.keyboard.press('ArrowLeft');
    await showsFrame(page, 0);
    await page.keyboard.press('End');
    await showsFrame(page, 11);
    assert.equal(await page.locator('#position').textContent(), 'frame 11 / 111.100 s');
    await page.keyboard.press('Home');
    await showsFrame(page, 0);
    await page.click('#last');
    await showsFrame(page, 11);
    await page.click('#first');
    await showsFrame(page, 0);
  }));

test('plays at the speed that is selected, until the end or a pause', async () => {
  const { page, faults, close } = await open(shared.browser, shared.server.url, desktop, (one) =>
    stopTime(one.context()),
  );
  const shows = (number) =>
    page.waitForFunction(
      (expected) => document.getElementById('frame-number').textContent === String(expected),
      number,
    );
  await page.selectOption('#speed', '4'); // of 10 Hz
  await page.keyboard.press(' ');
  for (let frame = 1; frame < 12; ++frame) {
    await page.clock.runFor(30);
    await shows(frame);
  }
  await page.locator('html:not(.playing)').waitFor(); // it pauses at the end
  await page.selectOption('#speed', '0.25');
  await page.keyboard.press(' '); // from the start again
  await shows(0);
  await page.clock.runFor(390);
  assert.equal(await frameShown(page), 0);
  await page.clock.runFor(20);
  await shows(1);
  await page.click('#play');
  await page.locator('html:not(.playing)').waitFor();
  await page.clock.runFor(5000);
  await showsFrame(page, 1);
  assert.deepEqual(faults, []);
  await close();
});

test('after many steps at once the last frame is displayed', () =>
  withPage('/#frame=9', desktop, async (page) => {
    await showsFrame(page, 9);
    const expected = await page.locator('#main').screenshot();
    for (let round = 0; round < 3; ++round) {
      for (const key of ['End', 'Home', 'ArrowRight', '2', 'End', '1', 'ArrowLeft', 'ArrowLeft'])
        await page.keyboard.press(key);
      await showsFrame(page, 9);
      const shown = await page.locator('#main').screenshot();
      assert.ok((await changedFraction(page, expected, shown)) < 0.001);
    }
  }));

test('jumps to the next and the previous occlusion', () =>
  withPage('/', desktop, async (page) => {
    await page.keyboard.press(']');
    await showsFrame(page, 2);
    assert.match(await page.locator('#announce').textContent(), /cylinder, lid/);
    await page.click('[data-key="]"]');
    await showsFrame(page, 4);
    await page.keyboard.press(']');
    assert.match(await page.locator('#announce').textContent(), /no later occlusion/);
    await page.keyboard.press('[');
    await showsFrame(page, 2);
  }));

test('a click in the timeline selects a frame', () =>
  withPage('/', desktop, async (page) => {
    const box = await page.locator('.row-body').first().boundingBox();
    const x = (frame) => box.x + ((frame + 0.5) * box.width) / shared.report.frames.length;
    await page.mouse.click(x(7), box.y + 10);
    await showsFrame(page, 7);
    assert.equal(await page.locator('.playhead').getAttribute('aria-valuenow'), '7');
    await page.mouse.down();
    await page.mouse.move(x(4), box.y + 10, { steps: 4 });
    await page.mouse.up();
    await showsFrame(page, 4);
    assert.match(await page.locator('.tooltip').textContent(), /frame 4 .*\ncube: visible/);
  }));

test('the address contains frame and target', () =>
  withPage('/#frame=9&target=lid', desktop, async (page) => {
    await showsFrame(page, 9);
    assert.match(
      await page.locator('#target-details [data-key=verdict]').textContent(),
      /unknown$/,
    );
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => location.hash === '#frame=10&target=lid');
    await page.click('[data-target=cube]');
    await page.waitForFunction(() => location.hash === '#frame=10&target=cube');
  }));

test('the list shows how much is hidden and by what; for unknown targets the known part', () =>
  withPage('/', desktop, async (page) => {
    let others = 0;
    for (const frame of shared.report.frames) {
      await showsFrame(page, frame.index);
      const shown = await page
        .locator('#target-list [data-target]')
        .evaluateAll((all) =>
          all.map((one) => [one.querySelector('.amount').textContent, one.ariaLabel]),
        );
      for (const [i, target] of frame.targets.entries()) {
        const fraction = target.occluded_fraction + (target.hidden_by_other_fraction ?? 0);
        const percent = Math.round(100 * fraction);
        const isKnown = target.verdict !== 'unknown';
        const isShown = target.inside > 0 && (isKnown || percent > 0);
        const text = isShown ? `${isKnown ? '' : '≥ '}${percent} %` : '–';
        assert.ok(
          shown[i][0].startsWith(text),
          `frame ${frame.index}: ${target.name}: ${shown[i]}`,
        );
        assert.ok(shown[i][1].endsWith(shown[i][0].replace('≥', 'at least')), shown[i][1]);
        others += isKnown && shown[i][0].includes('others') ? 1 : 0;
      }
      await page.keyboard.press('ArrowRight');
    }
    assert.ok(others > 0, 'one is hidden by others');
  }));
