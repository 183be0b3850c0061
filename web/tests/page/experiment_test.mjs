// SPDX-License-Identifier: Apache-2.0
// An experiment's page, one file: its numbers are metrics.json's, its frames the first seed's.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { desktop, launch, openFile, phone, program } from './browser.mjs';

const seconds = 8; // the robot hides the wrist meanwhile
let browser, folder, html, metrics;
let missing = process.env.PENUMBRA_FULL ? undefined : 'set PENUMBRA_FULL';

before(async () => {
  if (missing) return;
  folder = await mkdtemp(path.join(os.tmpdir(), 'penumbra-experiment-'));
  const options = ['--seeds', '0:2', '--duration', String(seconds)];
  const run = spawnSync(program, ['experiment', 'handover', '-o', folder, ...options]);
  const said = String(run.stderr);
  const required = (process.env.PENUMBRA_REQUIRE ?? '').split(',').includes('simulation');
  if (!required && said.includes('this build has no experiments')) missing = 'no simulation';
  if (missing) return;
  assert.equal(run.status, 0, said);
  html = await readFile(path.join(folder, 'report.html'), 'utf8');
  metrics = JSON.parse(await readFile(path.join(folder, 'metrics.json'), 'utf8'));
  browser = await launch();
});
after(async () => {
  await browser?.close();
  if (folder) await rm(folder, { recursive: true });
});

/** JSON that the page holds. */
const held = (id) => JSON.parse(html.match(new RegExp(`id="${id}">([^]*?)</script`))[1]);

/** Opens a page and fails for whatever it complains of or asks for. */
async function visit(options, file = path.join(folder, 'report.html')) {
  const { page, faults, close: closePage } = await openFile(browser, file, options);
  const close = async () => {
    assert.deepEqual(faults, []);
    await closePage();
  };
  return { page, close };
}

const shows = (name, body) => test(name, async (t) => (missing ? t.skip(missing) : await body()));

shows('every number of every method is metrics.json’s', async () => {
  const { page, close } = await visit(desktop);
  const { measures, methods } = held('penumbra-experiment');
  assert.deepEqual(held('penumbra-report'), metrics);
  for (const [lane, { name, methods: measured }] of Object.entries(metrics.detections)) {
    const body = page.locator(`[data-lane=${lane}]`);
    assert.equal(await body.locator('h3').textContent(), name);
    assert.equal(await body.locator('tr[data-method]').count(), methods.length);
    for (const [method, { summary }] of Object.entries(measured)) {
      const cells = await body
        .locator(`tr[data-method=${method}] td[data-key]`)
        .evaluateAll((all) =>
          all.map(({ dataset, textContent }) => [dataset.key, dataset.value, textContent]),
        );
      assert.equal(cells.length, Object.keys(summary).length);
      for (const [key, value, text] of cells) {
        assert.deepEqual(JSON.parse(value), summary[key], `${method} ${key}`);
        const { digits } = measures.find((measure) => measure.key === key);
        const [low, high] = (summary[key].ci95 ?? []).map((end) => end.toFixed(digits));
        const spread = low === undefined ? '–' : `${low} to ${high}`;
        const known = summary[key].value !== null;
        assert.equal(text, known ? `${summary[key].value.toFixed(digits)}${spread}` : '–');
      }
    }
    assert.equal(await body.locator('svg.interval').count(), methods.length);
  }
  await close();
});

shows('frames and methods are chosen, and told as the first seed has them', async () => {
  const { page, close } = await visit(desktop);
  const { run, methods } = held('penumbra-experiment');
  const pictures = held('penumbra-frames');
  const [lane] = Object.values(run.lanes);
  const sizes = page.locator('figure img');
  assert.ok((await sizes.evaluateAll((all) => all.map((one) => one.naturalWidth))).every((w) => w));
  const told = async (frame) => {
    const details = page.locator('.report-details');
    assert.match(await details.textContent(), new RegExp(`frame ${frame} `));
    const verdict = await details.locator('h3.verdict').getAttribute('data-value');
    assert.equal(JSON.parse(verdict), lane.verdicts[frame]);
    const errors = await details
      .locator('td[data-value]')
      .evaluateAll((all) => all.map(({ dataset }) => JSON.parse(dataset.value)));
    const expected = methods.map(({ key }) => lane.errors[key].translation_mm[frame]);
    assert.deepEqual(errors, expected);
  };
  for (const [i, { index }] of pictures.entries()) {
    await page.locator('button.picture').nth(i).click();
    await told(index);
  }
  const last = pictures.at(-1).index;
  await page.keyboard.press('ArrowLeft');
  await told(last - 1);
  const row = page.locator('.row-body.errors').first();
  const { width } = await row.boundingBox();
  await row.click({ position: { x: (width * 100.5) / run.time_s.length, y: 20 } });
  await told(100);
  await row.hover();
  assert.match(await page.locator('.tip').textContent(), /Penumbra: /);
  await page.locator('button[data-method=raw]').click();
  assert.equal(await page.locator('.error-chart .m-raw.chosen').count(), 1);
  assert.equal(await page.locator('.error-chart .method-line').count(), methods.length);
  assert.ok((await page.locator('.error-chart .hidden-span').count()) > 0);
  assert.ok((await page.pdf({ printBackground: true })).length > 20_000, 'it prints');
  await close();
});

shows('a phone in the dark shows it all, and scrolls tables alone', async () => {
  const { page, close } = await visit(phone);
  const [scroll, width, theme] = await page.evaluate(() => {
    const { scrollWidth, clientWidth, dataset } = document.documentElement;
    return [scrollWidth, clientWidth, dataset.theme];
  });
  assert.ok(scroll <= width, `${scroll} > ${width}`);
  assert.equal(theme, 'dark');
  await close();
});

shows('names are text, whatever they are', async () => {
  const hostile = '<img src=x onerror=alert(1)>\\u003c/script>';
  const file = path.join(folder, 'hostile.html');
  await writeFile(
    file,
    html
      .replaceAll('"No handling"', JSON.stringify(hostile).replaceAll('<', '\\u003c'))
      .replaceAll('"Seen"', JSON.stringify(hostile).replaceAll('<', '\\u003c')),
  );
  const { page, close } = await visit(desktop, file);
  assert.ok((await page.getByText(hostile).count()) > 3);
  assert.equal(await page.locator('img:not([src^="data:image/jpeg"])').count(), 0);
  await close();
});
