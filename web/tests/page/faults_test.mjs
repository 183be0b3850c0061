// SPDX-License-Identifier: Apache-2.0
// Unknown values look unknown, and failures give their reason.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cp, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import {
  desktop,
  drawn,
  example,
  launch,
  open,
  phone,
  program,
  serve,
  showsFrame,
  showsWithout,
} from './browser.mjs';
import { changedFraction } from './pictures.mjs';

let browser, server, folder;

/** The example without joint positions in frame 2, depth in frame 4 and colour in frame 5. */
before(async () => {
  folder = await mkdtemp(path.join(os.tmpdir(), 'penumbra-page-'));
  await cp(example, folder, { recursive: true });
  const joints = path.join(folder, 'joint_states.csv');
  const lines = (await readFile(joints, 'utf8')).split('\n');
  await writeFile(joints, lines.filter((line) => !line.startsWith('2,')).join('\n'));
  await rm(path.join(folder, 'depth/4.png'));
  await rm(path.join(folder, 'color/5.png'));
  [browser, server] = await Promise.all([launch(), serve(folder)]);
});
after(async () => {
  await server?.stop();
  await rm(folder, { recursive: true });
});

test('a frame without a pose shows no robot, and says why; its targets are unknown', async () => {
  const shown = await open(browser, `${server.url}#frame=1`, desktop);
  const { page } = shown;
  await showsFrame(page, 1);
  for (const part of ['cloud', 'camera', 'targets']) await page.click(`[data-part=${part}]`);
  await showsWithout(page, 'cloud');
  const canvas = page.locator('#scene-canvas');
  const robot = await canvas.screenshot();
  assert.ok(await page.locator('#scene-note').isHidden());
  await page.keyboard.press('ArrowRight');
  await showsFrame(page, 2);
  assert.match(await page.locator('#scene-note').textContent(), /No robot in this frame.*joint/i);
  assert.match(await page.locator('#frame-status').textContent(), /missing_joints/);
  assert.match(await page.locator('#frame-details .fault').textContent(), /missing_joints/);
  await page.mouse.move(5, 5);
  const empty = await canvas.screenshot();
  assert.ok((await changedFraction(page, robot, empty)) > 0.01, 'the robot is gone');
  await page.click('[data-part=robot]');
  await drawn(page);
  await page.click('[data-part=robot]');
  await page.mouse.move(5, 5);
  await drawn(page);
  assert.ok(
    (await changedFraction(page, empty, await canvas.screenshot())) < 0.002,
    'and stays hidden',
  );
  assert.equal(await page.locator('.row-head.frames .scale').textContent(), '2 bad');
  await page.click('[data-target=cube]');
  assert.match(await page.locator('#target-details [data-key=verdict]').textContent(), /unknown$/);
  assert.equal(await page.locator('[data-key=occluded_fraction]').textContent(), '–');
  assert.deepEqual(shown.faults, []);
  await shown.close();
});

test('a frame without a colour image shows its depth in grey', async () => {
  const { page, close } = await open(browser, `${server.url}#frame=5`, desktop);
  await showsFrame(page, 5);
  assert.match(await page.locator('#image-note').textContent(), /no colour image.*depth/);
  const greys = await page.evaluate(() => {
    const canvas = document.getElementById('image-below');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return [new Set(data.filter((_, i) => i % 4 === 0)).size, canvas.width];
  });
  assert.ok(greys[0] > 20 && greys[1] === 640, `${greys}`);
  await close();
});

test('an unreachable server is reported, with a button to try again', async () => {
  const own = await serve(example);
  const { page, close } = await open(browser, own.url, desktop);
  await own.stop();
  await page.keyboard.press('ArrowRight');
  await page.locator('#cover .fault').waitFor();
  assert.match(await page.locator('#cover').textContent(), /does not respond/);
  assert.ok(await page.locator('#cover button').first().isVisible());
  await close();
});

/**
 * Opens the recording and shows frame 1, whose packet `damage` changes. The route is set before the
 * page loads: a busy browser sends a loaded page's next request past a new route.
 */
async function openDamaged(damage) {
  const shown = await open(browser, server.url, desktop, (page) =>
    page.route('**/api/frames/1/packet*', async (route) =>
      route.fulfill({ body: damage(await (await route.fetch()).body()) }),
    ),
  );
  await shown.page.keyboard.press('ArrowRight');
  await shown.page.locator('#cover .fault').waitFor();
  return shown;
}

async function goesBack(page) {
  await page.getByText('Back to the previous frame').click();
  await showsFrame(page, 0);
  await page.locator('#cover').waitFor({ state: 'hidden' });
}

test('a damaged packet is reported and not displayed', async () => {
  const { page, close } = await openDamaged((body) => body.subarray(0, body.length - 5));
  assert.match(await page.locator('#cover').textContent(), /packet: part .* exceeds/);
  assert.equal(await page.locator('#frame-number').textContent(), '0');
  await goesBack(page);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  await showsFrame(page, 2);
  await close();
});

test('a frame whose image cannot be decoded is reported and not displayed', async () => {
  const { page, close } = await openDamaged((body) => {
    const start = body.indexOf(Buffer.from([0xff, 0xd8, 0xff])); // start of the JPEG
    assert.ok(start > 0);
    return body.fill(0, start, start + 64);
  });
  const inked = await page.evaluate(() =>
    ['image-below', 'image-above'].map((id) => {
      const canvas = document.getElementById(id);
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return data.some((value) => value > 0);
    }),
  );
  assert.deepEqual(inked, [false, false], 'no labels over another frame’s image');
  await goesBack(page);
  await close();
});

test('another program on the same port is reported, and its frames are not displayed', async () => {
  const first = await serve(example);
  const { page, close } = await open(browser, first.url, desktop);
  await first.stop();
  const second = await serve(folder, new URL(first.url).port);
  await page.keyboard.press('End');
  await page.getByText('The server now shows another input').waitFor();
  await page.getByRole('button', { name: 'Reload' }).click();
  await page.locator('#cover').waitFor({ state: 'hidden' });
  assert.equal(await page.locator('#input-name').textContent(), path.basename(folder));
  await close();
  await second.stop();
});

test('an incomplete run is reported, with its note', async () => {
  const note = 'frame 3 and later ones are not judged: the device failed';
  const { page, close } = await open(browser, server.url, desktop, (one) =>
    one.route('**/api/report*', async (route) => {
      const report = JSON.parse((await (await route.fetch()).body()).toString());
      const summary = { ...report.summary, notes: [note] };
      await route.fulfill({ json: { ...report, frames: report.frames.slice(0, 3), summary } });
    }),
  );
  await showsFrame(page, 0);
  assert.equal(await page.locator('#state').textContent(), '3 of 12 frames');
  assert.ok(await page.locator('#notes', { hasText: note }).isVisible(), 'without a click');
  await page.click('#notes-button');
  assert.ok(await page.locator('#notes').isHidden());
  await close();
});

test('a wrong setup is said at once, with the frame that shows it', async () => {
  const wrong = await mkdtemp(path.join(os.tmpdir(), 'penumbra-page-'));
  await cp(example, wrong, { recursive: true });
  const pose = path.join(wrong, 'camera_pose.csv');
  const rows = (await readFile(pose, 'utf8')).trim().split('\n');
  const shifted = rows[0].split(',');
  shifted[3] = String(Number(shifted[3]) + 0.06);
  await writeFile(pose, `${[shifted.join(','), ...rows.slice(1)].join('\n')}\n`);
  const own = await serve(wrong);
  const { diagnosis } = (await (await fetch(new URL('/api/report', own.url))).json()).summary;
  for (const options of [desktop, phone]) {
    const { page, faults, close } = await open(browser, own.url, options);
    const shown = page.locator('#diagnosis');
    assert.match(await shown.textContent(), /60 ± \d+ mm/);
    const box = await shown.boundingBox();
    assert.ok(box.y + box.height < options.viewport.height / 2, 'at the top');
    assert.ok(!(await page.locator('#notes').textContent()).includes('mm'), 'and only once');
    await page.click('#diagnosis-frame');
    await showsFrame(page, diagnosis.frame);
    assert.deepEqual(faults, []);
    await close();
  }
  await own.stop();
  await rm(wrong, { recursive: true });
});

test('an empty scene says why: of a run, and of a frame without depth', async () => {
  const out = path.join(folder, 'out');
  execFileSync(program, ['run', example, '-o', out], { stdio: 'ignore' });
  const own = await serve(out);
  const { page, close } = await open(browser, own.url, desktop);
  assert.match(await page.locator('#scene-note').textContent(), /robot.*points/);
  assert.ok(await page.locator('#notes code').first().isVisible(), 'the command that shows them');
  await close();
  await own.stop();
  const { frames } = await (await fetch(new URL('/api/report', server.url))).json();
  const other = await open(browser, `${server.url}#frame=4`, desktop);
  await other.page
    .locator('#scene-note', { hasText: `No points in this frame: ${frames[4].message}` })
    .waitFor();
  await other.close();
});

/** Opens the recording while it is judged: `judged.count` frames so far. */
async function openJudging() {
  const context = await browser.newContext({ ...desktop, deviceScaleFactor: 1 });
  const page = await context.newPage();
  const judged = { count: 0, requested: new Set() };
  await page.route('**/api/report*', async (route) => {
    const from = Number(new URL(route.request().url()).searchParams.get('from'));
    judged.requested.add(from);
    const report = JSON.parse((await (await route.fetch()).body()).toString());
    const frames = report.frames.slice(0, Math.max(0, judged.count - from));
    const summary = judged.count < 12 ? null : report.summary;
    await route.fulfill({ json: { ...report, frames, summary } });
  });
  await page.goto(server.url);
  await page.getByText('Judging the first frame').waitFor();
  return { page, judged, close: () => context.close() };
}

test('frames appear as they are judged', async () => {
  const { page, judged, close } = await openJudging();
  judged.count = 3;
  await showsFrame(page, 0);
  assert.match(await page.locator('#state').textContent(), /judging · 3 of 12 frames/);
  await page.keyboard.press('End');
  await page.waitForFunction(() => document.getElementById('frame-number').textContent === '2');
  judged.count = 12;
  await page.locator('#state').getByText('12 frames', { exact: true }).waitFor();
  await page.keyboard.press('End');
  await showsFrame(page, 11);
  assert.deepEqual([...judged.requested], [0, 3], 'received frames are not fetched again');
  await close();
});

test('a server that stops and returns during a run is reported', async () => {
  const { page, judged, close } = await openJudging();
  const dies = () => page.route('**/api/**', (route) => route.abort());
  const returns = () => page.unroute('**/api/**');
  await dies();
  await page.locator('#cover .fault', { hasText: 'does not respond' }).waitFor();
  await returns();
  judged.count = 3;
  await showsFrame(page, 0);
  assert.match(await page.locator('#state').textContent(), /^judging · 3 of 12 frames$/);
  assert.equal(await page.locator('#state-name').textContent(), 'judging');
  await dies();
  await page.locator('#state.fault', { hasText: 'does not respond · 3 frames so far' }).waitFor();
  assert.match(await page.locator('#state-name').textContent(), /does not respond$/);
  await returns();
  await page.locator('#state:not(.fault)', { hasText: 'judging · 3 of 12 frames' }).waitFor();
  await close();
});
