// SPDX-License-Identifier: Apache-2.0
// The page of several cameras: all of them at one instant, and the verdicts over all of them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { desktop, phone, program, showsFrame } from './browser.mjs';
import { makeCell } from './cell.mjs';
import { served } from './served.mjs';

const cell = mkdtempSync(path.join(tmpdir(), 'cell-'));
makeCell(cell);
execFileSync(program, ['run', cell, '-o', path.join(cell, 'out')]);
after(() => rmSync(cell, { recursive: true }));
const { frames } = JSON.parse(readFileSync(path.join(cell, 'out/views.json'), 'utf8'));
const { withPage } = served(cell);

const fusedWanted = ({ name, verdict, best, reason }) =>
  `${name} over all cameras: ${verdict.replaceAll('_', ' ')}` +
  `${best ? `, best from ${best}` : ''}${reason ? `: ${reason}` : ''}`;

test('all cameras and their common verdict', () =>
  withPage('/', desktop, async (page) => {
    assert.deepEqual(
      await page
        .locator('.camera')
        .evaluateAll((tiles) => tiles.map((tile) => tile.dataset.camera)),
      ['left', 'right'],
    );
    const { name } = frames[0].targets[0];
    await page.locator(`[data-target="${name}"]`).click();
    for (const [index, { targets }] of frames.slice(0, 3).entries()) {
      await showsFrame(page, index);
      const wanted = fusedWanted(targets.find((target) => target.name === name));
      await page.waitForFunction(
        (text) => document.querySelector('#cameras p').textContent.trim().endsWith(text),
        wanted.slice(name.length),
      );
      assert.ok((await page.locator('#cameras p').textContent()).includes(wanted));
      await page.keyboard.press('ArrowRight');
    }
    const drawn = await page.locator('.camera canvas').evaluateAll(
      (canvases) =>
        canvases.filter((canvas) => {
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          return data.some((value) => value > 0);
        }).length,
    );
    assert.equal(drawn, 4, 'an image and labels of each');
  }));

test('a click shows another camera at the same instant', () =>
  withPage('/#frame=4', desktop, async (page) => {
    await showsFrame(page, 4);
    await page.waitForFunction(() =>
      document.querySelector('[data-camera=right]').href.includes('frame=4'),
    );
    await page.locator('[data-camera=right]').click();
    await page.waitForURL('**/camera/right/**');
    await showsFrame(page, 4);
    assert.equal(await page.locator('[aria-current=true]').getAttribute('data-camera'), 'right');
    const session = await page.evaluate(async () =>
      (await fetch('/camera/right/api/session')).json(),
    );
    assert.deepEqual(session.cameras, ['left', 'right']);
  }));

test('fits on a phone', () =>
  withPage('/', phone, async (page) => {
    await page.locator('input[value=image]').check({ force: true });
    const { width } = await page.locator('#cameras').boundingBox();
    assert.ok(width > 300 && width <= 390, `${width} pixels`);
  }));
