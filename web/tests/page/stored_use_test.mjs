// SPDX-License-Identifier: Apache-2.0
// The page of a stored recording: themes, keys, touch, accessibility.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { desktop, drawn, overflow, phone, showsFrame, smallButtons } from './browser.mjs';
import { changedFraction } from './pictures.mjs';
import { frameShown, served } from './served.mjs';

const shared = served();
const { withPage } = shared;

test('the theme is the system’s until the user selects one', async () => {
  const theme = (page) => page.locator('html').getAttribute('data-theme');
  await withPage('/', { ...desktop, colorScheme: 'dark' }, async (page) => {
    assert.equal(await theme(page), 'dark');
    await page.emulateMedia({ colorScheme: 'light' });
    await page.locator('html[data-theme=light]').waitFor();
    const light = await page.screenshot();
    await page.keyboard.press('t');
    assert.equal(await theme(page), 'dark');
    await drawn(page);
    assert.ok((await changedFraction(page, light, await page.screenshot())) > 0.5);
    await page.reload();
    assert.equal(await theme(page), 'dark');
  });
});

test('arrow keys select a layer or step frames', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    const checked = () => page.locator('#layers :checked').inputValue();
    await page.focus('#layers :checked');
    for (const [key, layer] of [
      ['ArrowRight', 'labels'],
      ['ArrowDown', 'links'],
      ['ArrowLeft', 'labels'],
      ['5', 'depth'],
      ['1', 'overlay'],
    ]) {
      await page.keyboard.press(key);
      assert.equal(await checked(), layer, key);
    }
    assert.equal(await frameShown(page), 3, 'steps no frame');
    await page.click('#layers label:has([value=links])'); // by pointer: keys step again
    assert.equal(await checked(), 'links');
    await page.keyboard.press('ArrowRight');
    await showsFrame(page, 4);
    assert.equal(await checked(), 'links');
  }));

test('panes are resized by pointer and keys, and keep their sizes', () =>
  withPage('/', desktop, async (page) => {
    const boxOf = (selector) => page.locator(selector).boundingBox();
    const drag = async (border, dx, dy) => {
      const { x, y, width, height } = await boxOf(border);
      await page.mouse.move(x + width / 2, y + height / 2);
      await page.mouse.down();
      await page.mouse.move(x + width / 2 + dx, y + height / 2 + dy, { steps: 3 });
      await page.mouse.up();
    };
    const near = (value, expected) =>
      assert.ok(Math.abs(value - expected) < 12, `${value}, ${expected}`);
    const sizes = async () => [
      (await boxOf('#scene')).width,
      (await boxOf('#details')).width,
      (await boxOf('#timeline-panel')).height,
    ];
    const [scene, details] = await sizes();
    await drag('#scene-border', -150, 0);
    await drag('#details-border', -80, 0);
    const [, , timeline] = await sizes(); // the legend may wrap
    await drag('#timeline-border', 0, 120);
    const dragged = await sizes();
    near(dragged[0], scene - 150);
    near(dragged[1], details + 80);
    near(dragged[2], timeline - 120);
    const canvas = await boxOf('#scene-canvas');
    near(canvas.width, dragged[0]);
    await page.reload();
    await showsFrame(page, 0);
    assert.deepEqual(await sizes(), dragged, 'also after a reload');
    await page.focus('#scene-border');
    await page.keyboard.press('ArrowRight');
    assert.ok((await sizes())[0] > dragged[0] + 40);
    assert.equal(await frameShown(page), 0, 'steps no frame');
    await page.keyboard.press('End');
    assert.ok((await boxOf('#image')).width > 100, 'panes keep a minimum size');
    assert.equal(await overflow(page), 0);
    for (const border of ['#timeline-border', '#details-border', '#scene-border'])
      await page.dblclick(border);
    near((await sizes())[0], scene);
  }));

test('keyboard shortcuts, help, and tab order', () =>
  withPage('/', desktop, async (page) => {
    await page.keyboard.press('?');
    assert.ok(await page.locator('#help').isVisible());
    await page.keyboard.press('Escape');
    assert.ok(!(await page.locator('#help').isVisible()));
    await page.keyboard.press('ArrowDown');
    const selected = page.locator('#target-list [aria-pressed=true]');
    const name = await selected.getAttribute('data-target');
    await page.keyboard.press('ArrowUp');
    assert.notEqual(await selected.getAttribute('data-target'), name);
    const reached = new Set();
    for (let tabs = 0; tabs < 70; ++tabs) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => document.activeElement?.id ?? ''));
    }
    for (const id of ['theme', 'scene-canvas', 'scene-border', 'image-handle', 'play', 'speed'])
      assert.ok(reached.has(id), `${id} has a tab stop`);
  }));

test('controls have a name', () =>
  withPage('/', desktop, async (page) => {
    const nameless = await page
      .locator('button:visible, select:visible, input:visible, [role]:visible, canvas:visible')
      .evaluateAll((nodes) =>
        nodes
          .filter((node) => {
            const label =
              node.getAttribute('aria-label') ?? (node.textContent?.trim() || node.title) ?? '';
            const labelled =
              node.closest('label') !== null || node.getAttribute('role') === 'status';
            return !label.trim() && !labelled;
          })
          .map((node) => node.outerHTML.slice(0, 80)),
      );
    assert.deepEqual(nameless, []);
  }));

test('a phone shows the targets, and then the scene or image, without scrolling', () =>
  withPage('/', phone, async (page) => {
    for (const view of ['scene', 'image']) {
      await page.tap(`#view-tabs label:has([value=${view}])`);
      const [fold, targets, pane] = await page.evaluate(
        (id) => [
          document.getElementById('transport').getBoundingClientRect().top,
          [...document.querySelectorAll('#target-list button')].map(
            (one) => one.getBoundingClientRect().bottom,
          ),
          document.getElementById(id).getBoundingClientRect().bottom,
        ],
        view === 'scene' ? 'scene' : 'image-frame',
      );
      assert.equal(targets.length, 4);
      for (const bottom of [...targets, pane]) assert.ok(bottom <= fold, `${bottom} > ${fold}`);
    }
  }));

for (const width of [360, 390])
  test(`a phone of ${width} pixels, by touch`, () =>
    withPage('/', { ...phone, viewport: { width, height: 780 } }, async (page) => {
      assert.equal(await overflow(page), 0, 'no horizontal overflow');
      const state = await page.locator('#state').evaluate((node) => ({
        whole: node.scrollWidth <= node.clientWidth,
        text: node.textContent,
      }));
      assert.deepEqual(state, { whole: true, text: '12 frames' });
      assert.ok(await page.locator('#scene').isVisible());
      await page.tap('#view-tabs label:has([value=image])');
      assert.ok(!(await page.locator('#scene').isVisible()));
      const without = page.getByRole('button', { name: 'Without robot' });
      for (const pressed of ['true', 'false']) {
        await without.tap();
        assert.equal(await without.getAttribute('aria-pressed'), pressed);
      }
      await page.tap('#image-frame', { position: { x: 200, y: 100 } });
      await page.waitForFunction(() => document.getElementById('read-label').textContent !== '–');
      await page.tap('#step-forward');
      await showsFrame(page, 1);
      for (const view of ['image', 'scene']) {
        await page.tap(`#view-tabs label:has([value=${view}])`);
        assert.deepEqual(await smallButtons(page), [], 'large enough for touch');
      }
      const [end, top] = await page.evaluate(() => {
        const main = document.getElementById('main');
        main.scrollTo(0, main.scrollHeight);
        const boxOf = (id) => document.getElementById(id).getBoundingClientRect();
        return [boxOf('details').bottom, boxOf('transport').top];
      });
      assert.ok(end <= top + 1, `no overlap with the player: ${end}, ${top}`);
    }));
