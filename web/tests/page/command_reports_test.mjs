// SPDX-License-Identifier: Apache-2.0
// The reports of calibrate, look-ahead, view-planning and a run with several cameras, of an input whose
// names are foreign text.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cp, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { makeCell } from './cell.mjs';
import {
  desktop,
  example,
  launch,
  openFile,
  overflow,
  phone,
  program,
  root,
  smallButtons,
} from './browser.mjs';

const hostile = `<img src=x onerror=alert(1)>&"'</script>`;
const names = {
  visible: 'visible',
  partial: 'partly hidden',
  hidden: 'hidden',
  unknown: 'unknown',
  out_of_view: 'out of view',
  held: 'carried',
};
let browser, folder, input;

before(async () => {
  folder = await mkdtemp(path.join(os.tmpdir(), 'penumbra-reports-'));
  input = path.join(folder, `a <b> & "c" 'd'\n`);
  await cp(example, input, { recursive: true });
  browser = await launch();
});
after(() => rm(folder, { recursive: true }));

/** Copies targets of the repository's examples, with a target's name replaced. */
async function renamed(file, name) {
  const copy = path.join(input, `renamed_${path.dirname(file)}.yaml`);
  const text = await readFile(path.join(root, 'examples', file), 'utf8');
  await writeFile(copy, text.replaceAll(`name: ${name}`, `name: ${JSON.stringify(hostile)}`));
  return copy;
}

/** Runs a command; returns its JSON and its report. */
async function resultOf(json, command, ...options) {
  const out = path.join(folder, json);
  execFileSync(program, [command, ...options, '-o', out], { stdio: 'ignore' });
  const result = JSON.parse(await readFile(path.join(out, json), 'utf8'));
  return { result, file: path.join(out, 'report.html') };
}

/** Opens the report on a desktop and on a phone; `use` gets what it shows there. */
async function look(file, title, use) {
  for (const options of [desktop, { ...desktop, colorScheme: 'dark' }, phone]) {
    const { page, faults, close } = await openFile(browser, file, options);
    const tables = await page
      .locator('table')
      .evaluateAll((all) =>
        all.map((one) =>
          [...one.rows].map((row) => [...row.cells].map((cell) => cell.textContent)),
        ),
      );
    const bars = await page
      .locator('.verdict-bar')
      .evaluateAll((all) =>
        all.map((bar) => [
          bar.previousSibling.textContent,
          [...bar.children].map((part) => `${part.style.flexGrow} ${part.title}`).join(),
        ]),
      );
    const images = page.locator('img');
    const widths = await images.evaluateAll(async (all) => {
      await Promise.all(all.map((one) => one.decode()));
      return all.map((one) => one.naturalWidth);
    });
    await use({ page, tables, bars, widths });
    assert.ok((await page.title()).startsWith(`${title}: `));
    assert.ok((await page.locator('header .input').textContent()).endsWith(path.basename(input)));
    assert.equal(await page.locator('img:not([src^="data:image/jpeg"])').count(), 0);
    assert.equal(await overflow(page), 0);
    assert.deepEqual(await smallButtons(page), []);
    assert.deepEqual(faults, []);
    await close();
  }
}

const percent = (share, digits = 1) => `${(100 * share).toFixed(digits)} %`;
const plusMinus = ({ value, sigma }, scale, digits) =>
  `${(scale * value).toFixed(digits)} ± ${(2 * scale * sigma).toFixed(digits)}`;

test('calibrate: estimates, residuals and pictures', async () => {
  const { result, file } = await resultOf('calibration.json', 'calibrate', input);
  await look(file, 'Calibration', async ({ page, tables: [estimates, frames, links], widths }) => {
    const found = Object.fromEntries(estimates);
    assert.equal(found['depth offset'], `${plusMinus(result.depth_offset_m, 1000, 1)} mm`);
    assert.equal(found['depth scale'], `${plusMinus(result.depth_scale, 100, 2)} %`);
    assert.equal(found['outline is larger by'], `${plusMinus(result.outline_px, 1, 1)} px`);
    const at = result.T_parent_camera.slice(0, 3).map((row) => row[3].toFixed(5));
    assert.equal(found['camera’s position in base_link'], `${at.join(', ')} m`);
    const region = `${(1000 * result.position_error_95_m).toFixed(1)} mm, `;
    assert.ok(found['95 % region'].startsWith(region));
    assert.deepEqual(
      frames.slice(1).map(([index, agreeing]) => [index, agreeing]),
      result.frames.map(({ index, agreeing }) => [String(index), percent(agreeing, 0)]),
    );
    assert.deepEqual(
      links.slice(1),
      Object.entries(result.link_residuals_m).map(([link, residual]) => [
        link,
        `${(1000 * residual).toFixed(1)} mm`,
      ]),
    );
    assert.ok((await page.locator('.notes').textContent()).includes(result.advice));
    assert.ok(widths.length === 20 && widths.every((width) => width === 640), `${widths}`);
    const captions = await page.locator('figcaption').allTextContents();
    assert.deepEqual(captions.slice(0, 2), ['frame 0, first guess', 'frame 0, result']);
    assert.ok(await page.getByText('white where the measured point is').isVisible());
  });
});

test('calibrate by masks, and one that fails', async () => {
  const masked = path.join(folder, 'masked', path.basename(input));
  await cp(input, masked, { recursive: true });
  const masks = ['-o', path.join(masked, 'out'), '--save', 'robot_mask'];
  execFileSync(program, ['run', masked, ...masks], { stdio: 'ignore' });
  const yaml = path.join(masked, 'recording.yaml');
  await writeFile(yaml, (await readFile(yaml, 'utf8')).replace('  depth: depth/%d.png', ''));
  const options = [masked, '--masks', 'out/robot_mask/%06d.png'];
  const { result, file } = await resultOf('calibration.json', 'calibrate', ...options);
  await look(file, 'Calibration', async ({ page, tables, widths }) => {
    const [estimates, frames] = tables;
    assert.equal(tables.length, 2, 'no residuals by link');
    const found = Object.fromEntries(estimates);
    assert.equal(found['overlap with the masks'], percent(result.masks.overlap));
    assert.ok(!('depth offset' in found));
    assert.deepEqual(frames[0], ['frame', 'overlap with the mask', 'mask’s edge']);
    assert.equal(widths.length, 20);
    assert.ok(await page.getByText('The masks are grey').isVisible());
  });
  const html = await readFile(file, 'utf8');
  const faults = `"faults": [${JSON.stringify(hostile).replaceAll('<', '\\u003c')}]`;
  const failed = path.join(folder, 'failed.html');
  await writeFile(
    failed,
    html.replace('"faults": []', () => faults),
  );
  await look(failed, 'Calibration', async ({ page }) =>
    assert.ok(await page.getByText(`Not calibrated: ${hostile}`).isVisible()),
  );
});

test('look-ahead: ranking, verdicts over time and pictures', async () => {
  const targets = await renamed('arm_over_table/targets.yaml', 'lid');
  const motions = ['sweep_left.csv', 'over_the_top.csv'].flatMap((file) => [
    '--trajectory',
    path.join(root, 'examples/look_ahead', file),
  ]);
  const options = [input, '--targets', targets, ...motions];
  const { result, file } = await resultOf('look_ahead.json', 'look-ahead', ...options);
  await look(file, 'Look ahead', async ({ page, tables, bars, widths }) => {
    const [ranking, now, ...intervals] = tables.map((table) => table.slice(1));
    assert.deepEqual(
      ranking,
      result.ranking.map(({ motion, seen, reason }) => [
        motion,
        `${percent(seen)} of the time`,
        reason,
      ]),
    );
    assert.deepEqual(
      now.map((row) => row.slice(0, 2)),
      result.now.map(({ name, verdict }) => [name, names[verdict]]),
    );
    assert.ok(now.some(([name]) => name === hostile));
    for (const [i, { targets: all }] of result.motions.entries())
      assert.deepEqual(
        intervals[i],
        all.flatMap(({ name, any_camera }) =>
          any_camera.intervals.map(({ begin_s, end_s, verdict, hidden, by, reason }) => [
            name,
            `${begin_s.toFixed(2)} s`,
            `${end_s.toFixed(2)} s`,
            names[verdict],
            percent(hidden, 0),
            by ?? '',
            reason ?? '',
          ]),
        ),
      );
    const shown = result.motions.flatMap(({ targets: all }) => all);
    assert.deepEqual(
      bars.map(([name]) => name),
      shown.map(({ name }) => name),
    );
    shown.forEach(({ any_camera }, i) => {
      const verdicts = bars[i][1].replaceAll(/\d+ /g, '');
      assert.equal(verdicts, any_camera.intervals.map(({ verdict }) => names[verdict]).join());
      const columns = bars[i][1].split(',').reduce((sum, part) => sum + Number.parseInt(part), 0);
      assert.equal(columns, 500, 'equal parts of the motion');
    });
    assert.ok(widths.length > 2 && widths.every((width) => width === 640), `${widths}`);
    const captions = await page.locator('figcaption').allTextContents();
    assert.ok(captions[0].startsWith(`${hostile} is hidden by`), captions[0]);
    assert.equal(captions.at(-1), 'the end, at 3.00 s');
  });
});

test('view-planning: best sets, shares and verdicts over time', async () => {
  const targets = await renamed('view_planning/targets.yaml', 'lid');
  const candidates = path.join(root, 'examples/view_planning/candidates.csv');
  const given = [input, '--targets', targets, '--candidates', candidates, '--cameras', '2'];
  const { result, file } = await resultOf('view_planning.json', 'view-planning', ...given);
  const letters = { v: 'visible', p: 'partial', h: 'hidden', '?': 'unknown', o: 'out_of_view' };
  await look(file, 'View planning', async ({ page, tables, bars }) => {
    const [sets, heat, shares, unknown] = tables.map((table) => table.slice(1));
    assert.deepEqual(
      sets,
      result.best.map(({ cameras, mean_visible, visible }) => [
        String(cameras.length),
        cameras.join(' + '),
        percent(mean_visible),
        ...Object.values(visible).map((share) => percent(share)),
      ]),
    );
    assert.deepEqual(
      heat,
      result.candidates.map((one) => [
        one.name,
        ...one.targets.map(({ visible }) => percent(visible)),
      ]),
    );
    assert.deepEqual(tables[1][0].slice(1), Object.keys(result.best[0].visible));
    assert.ok(tables[1][0].includes(hostile));
    const seen = result.candidates.flatMap(({ name, targets: all }) =>
      all.map((target) => [name, target]),
    );
    assert.deepEqual(
      shares,
      seen.map(([name, target]) => [
        name,
        target.name,
        ...Object.keys(names).map((verdict) => percent(target[verdict])),
      ]),
    );
    assert.deepEqual(
      unknown,
      result.candidates
        .filter(({ first_unknown }) => first_unknown)
        .map(({ name, first_unknown }) => [name, first_unknown]),
    );
    const bold = await page.locator('td b').allTextContents();
    assert.deepEqual(bold.sort(), [...result.best.at(-1).cameras].sort());
    const rows = result.candidates.length + 1;
    Object.keys(result.best[0].visible).forEach((_, t) => {
      assert.equal(bars[t * rows][0], 'best set');
      result.candidates.forEach(({ name, targets: all }, c) => {
        const runs = all[t].by_frame.match(/(.)\1*/g);
        const wanted = runs.map((run) => `${run.length} ${names[letters[run[0]]]}`).join();
        assert.deepEqual(bars[t * rows + c + 1], [name, wanted]);
      });
    });
    assert.equal(bars[0][1], `${result.frames.length} visible`, 'of the best set');
    assert.ok(await page.getByText('Frame 0 to 11').isVisible());
  });
});

test('several cameras: verdicts over time, with links to the reports of each', async () => {
  const cell = path.join(folder, 'cell', path.basename(input));
  await makeCell(cell, { right: hostile.replaceAll('/', '') });
  const { result, file } = await resultOf('views.json', 'run', cell, '--report');
  const [left, right] = result.cameras;
  const all = result.frames.flatMap(({ targets }) => targets);
  await look(file, 'Targets over 2 cameras', async ({ page, tables: [counts], bars }) => {
    for (const [name, ...numbers] of counts.slice(1)) {
      const samples = all.filter((target) => target.name === name);
      assert.deepEqual(numbers, [
        ...Object.keys(names).map((verdict) =>
          String(samples.filter((one) => one.verdict === verdict).length),
        ),
        String(samples.filter(({ contradiction }) => contradiction).length),
      ]);
    }
    assert.equal(counts.length, 1 + new Set(all.map(({ name }) => name)).size);
    assert.deepEqual(
      bars.slice(0, 3).map(([name]) => name),
      ['all cameras', left, right],
    );
    const first = all.filter(({ name }) => name === counts[1][0]);
    const ofLeft = ({ views }) => views.find(({ camera }) => camera === left) ?? {};
    [first, first.map(ofLeft)].forEach((samples, i) => {
      const shown = bars[i][1].split(',').flatMap((run) => {
        const [, length, name] = /^(\d+) (.*)$/.exec(run);
        return new Array(Number(length)).fill(name);
      });
      const wanted = samples.map(({ verdict = 'unknown' }) => names[verdict]);
      assert.deepEqual(shown, wanted);
    });
  });
  for (const camera of [left, right]) {
    const page = await browser.newPage();
    await page.goto(pathToFileURL(file).href);
    await page.getByRole('link', { name: camera, exact: true }).first().click();
    await page.waitForURL(
      (url) => path.basename(path.dirname(decodeURI(url.pathname))) !== 'views.json',
    );
    assert.equal(await page.locator('h1').textContent(), 'Penumbra report');
    await page.close();
  }
});
