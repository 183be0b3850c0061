// SPDX-License-Identifier: Apache-2.0
// The page of a stored recording: what its image and its scene show.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { desktop, drawn, showsFrame, showsLayer, showsWithout } from './browser.mjs';
import { changedShare } from './pictures.mjs';
import { frameShown, served } from './served.mjs';

const shared = served();
const { withPage } = shared;

test('the divider compares the colour image with the layer', () =>
  withPage('/#frame=6', desktop, async (page) => {
    await showsFrame(page, 6);
    const stage = page.locator('#picture-stage');
    const overlay = await stage.screenshot();
    const box = await page.locator('#picture-handle').boundingBox();
    const frame = await page.locator('#picture-frame').boundingBox();
    await page.mouse.move(Math.max(box.x, frame.x) + 12, box.y + 30);
    await page.mouse.down();
    await page.mouse.move(frame.x + frame.width / 2, box.y + 30, { steps: 3 });
    await page.mouse.up();
    const handle = page.locator('#picture-handle');
    assert.ok(Math.abs(Number(await handle.getAttribute('aria-valuenow')) - 50) <= 2);
    const halved = await stage.screenshot();
    await handle.press('End');
    const color = await stage.screenshot();
    assert.ok((await changedShare(page, overlay, halved)) > 0.02);
    assert.ok((await changedShare(page, halved, color)) > 0.02);
    assert.equal(await frameShown(page), 6, 'keys of the divider do not step');
  }));

test('values under the pointer are the packet’s, in each layer', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    const frame = await page.locator('#picture-frame').boundingBox();
    const layers = ['overlay', 'labels', 'links', 'vdi', 'depth'];
    const names = ['clear', 'front', 'occluded', 'unknown', 'beyond', 'fringe'];
    const pixels = [
      [320, 190],
      [480, 230],
      [30, 30],
      [265, 290],
      [250, 170],
    ];
    const values = await valuesOf(pixels);
    for (const [index, [u, v]] of pixels.entries()) {
      await page.keyboard.press(String(index + 1));
      await showsLayer(page, layers[index]); // its legend may move the image
      const at = (pixel, size, length) => ((pixel + 0.5) / size) * length;
      const box = await page.locator('#picture-frame').boundingBox();
      await page.mouse.move(box.x + at(u, 640, box.width), box.y + at(v, 480, box.height));
      await page.waitForFunction(([wantedU, wantedV]) => {
        const textOf = (name) => document.getElementById(`read-${name}`).textContent;
        const [shownU, shownV] = textOf('pixel').split(', ').map(Number);
        const isThere = Math.abs(shownU - wantedU) <= 1 && Math.abs(shownV - wantedV) <= 1;
        return isThere && textOf('measured') !== '–';
      }, pixels[index]);
      const read = (name) => page.locator(`#read-${name}`).textContent();
      const [shownU, shownV] = (await read('pixel')).split(', ').map(Number);
      const { label, depth } = await valueAt(shownU, shownV);
      assert.equal(await read('label'), names[label]);
      assert.equal(await read('measured'), depth > 0 ? `${depth.toFixed(3)} m` : 'none');
    }
    assert.ok(frame.width > 300 && values.length === pixels.length);
  }));

/** Read from a packet here, after the contract, without the page's code. */
async function packetParts() {
  const query = '/api/frames/3/packet?with=labels,depth,cloud&step=2';
  const address = new URL(query, shared.server.url);
  const bytes = Buffer.from(await (await fetch(address)).arrayBuffer());
  const length = bytes.readUInt32LE(0);
  const head = JSON.parse(bytes.subarray(4, 4 + length).toString());
  let at = 4 + length;
  return Object.fromEntries(
    head.parts.map(({ name, size }) => {
      const part = bytes.subarray(at, at + size);
      at += size;
      return [name, part];
    }),
  );
}
let parts;
async function valueAt(u, v) {
  parts ??= await packetParts();
  const at = v * 640 + u;
  return { label: parts.labels[at], depth: parts.depth.readFloatLE(4 * at) };
}
const valuesOf = (pixels) => Promise.all(pixels.map(([u, v]) => valueAt(u, v)));

const isSurroundings = (label) => label === 0 || label === 1;

/** Runs in the page: alpha of each pixel of a canvas, 0 or 255. */
const alphaOf = (id) => {
  const canvas = document.getElementById(id);
  const context = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  return Array.from({ length: data.length / 4 }, (_, at) => data[4 * at + 3]);
};

test('without the robot, points and pixels that are clear or front are left', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    parts ??= await packetParts();
    const labels = Array.from(
      { length: parts.cloud.length / 16 },
      (_, i) => parts.cloud[16 * i + 12],
    );
    const kept = labels.filter(isSurroundings).length;
    assert.ok(kept > 0 && kept < labels.length && labels.includes(1), 'some front, some robot');
    const shownPoints = (count) =>
      page.locator(`#scene-canvas[data-points="${count}"]`).waitFor({ state: 'attached' });
    const button = page.getByRole('button', { name: 'Without robot' });
    const robot = page.locator('[data-part=robot]');
    await shownPoints(labels.length);
    await page.keyboard.press('w');
    await shownPoints(kept);
    assert.equal(await button.getAttribute('aria-pressed'), 'true');
    assert.equal(await robot.getAttribute('aria-pressed'), 'false', 'its model is gone, too');
    for (const [key, layer] of [
      ['1', 'overlay'],
      ['5', 'depth'],
    ]) {
      await page.keyboard.press(key);
      await showsLayer(page, layer);
      for (const id of ['picture-below', 'picture-above']) {
        const alpha = await page.evaluate(alphaOf, id);
        const isOpaque = id === 'picture-below' || layer === 'depth'; // the overlay is not
        const wrong = alpha.filter((a, at) =>
          isSurroundings(parts.labels[at]) ? isOpaque && a !== 255 : a !== 0,
        );
        assert.deepEqual([alpha.length, wrong.length], [parts.labels.length, 0], `${layer} ${id}`);
      }
    }
    assert.match(await page.locator('#picture-legend').textContent(), /chequered: left out/);
    await page.keyboard.press('ArrowRight');
    await showsFrame(page, 4);
    assert.equal(await button.getAttribute('aria-pressed'), 'true', 'in other frames, too');
    await page.keyboard.press('ArrowLeft');
    await showsFrame(page, 3);
    await shownPoints(kept);
    await button.click();
    await shownPoints(labels.length);
    assert.equal(await robot.getAttribute('aria-pressed'), 'true');
    const alpha = await page.evaluate(alphaOf, 'picture-above');
    assert.ok(alpha.every((a) => a === 255));
  }));

test('targets have outlines and names over the overlay, as text', () =>
  withPage('/#frame=3&target=cube', desktop, async (page) => {
    await showsFrame(page, 3);
    const names = page.locator('#picture-names .target-name');
    const { targets } = shared.report.frames[3];
    const names_ = targets.map(({ name }) => name);
    assert.deepEqual(
      (await names.allTextContents()).map((text) => text.replace('?', '')),
      names_,
    );
    assert.equal(await page.locator('#picture-names .chosen').textContent(), 'cube');
    assert.equal(await page.locator('#picture-lines .outline').count(), targets.length);
    const boxes = await names.evaluateAll((all) =>
      all.map((one) => one.getBoundingClientRect().toJSON()),
    );
    const frame = await page.locator('#picture-frame').boundingBox();
    for (const [i, box] of boxes.entries()) {
      assert.ok(box.left >= frame.x && box.right <= frame.x + frame.width + 1, names_[i]);
      for (const other of boxes.slice(0, i))
        assert.ok(
          box.right <= other.left ||
            other.right <= box.left ||
            box.bottom <= other.top ||
            other.bottom <= box.top,
          `${names_[i]} covers no other name`,
        );
    }
    await page.click('[data-target=lid]');
    assert.equal(await page.locator('#picture-names .chosen').textContent(), '?lid');
    await page.keyboard.press('5');
    await showsLayer(page, 'depth');
    assert.equal(await names.count(), 0, 'the other layers show none');
    const legend = await page.locator('#picture-legend').textContent();
    assert.match(legend, /^\d\.\d{3} m\d\.\d{3} mpercentiles 2–98striped: no measurement$/);
  }));

test('fringe is in the legend, and among the pixels’ numbers without a share', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    const entry = page.locator('#picture-legend .legend-entry', { hasText: 'fringe' });
    assert.match(await entry.getAttribute('title'), /beside the robot.*not to be trusted/);
    const color = await entry
      .locator('i')
      .evaluate((node) => getComputedStyle(node).backgroundColor);
    assert.equal(color, 'rgb(0, 158, 115)');
    const number = page.locator('#frame-details [data-key=fringe]');
    const { fringe } = shared.report.frames[3].pixels;
    assert.equal(await number.getAttribute('data-value'), String(fringe));
    assert.doesNotMatch(await number.textContent(), /%/);
  }));

test('the scene is drawn, and turns', () =>
  withPage('/#frame=2', desktop, async (page) => {
    await showsFrame(page, 2);
    const scene = page.locator('#scene');
    const first = await scene.screenshot();
    const box = await scene.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 160, box.y + box.height / 2 + 20, { steps: 5 });
    await page.mouse.up();
    await drawn(page);
    const turned = await scene.screenshot();
    assert.ok((await changedShare(page, first, turned)) > 0.2, 'turned');
    for (const part of ['cloud', 'robot', 'camera', 'targets']) {
      const with_ = await scene.screenshot();
      await page.click(`[data-part=${part}]`);
      if (part === 'cloud') await showsWithout(page, part);
      else await drawn(page);
      await page.mouse.move(5, 5);
      const without = await scene.screenshot();
      assert.ok((await changedShare(page, with_, without)) > 0.002, `${part} was there`);
    }
  }));

test('seen from the camera, the robot stands where the renderer draws it', () =>
  withPage('/#frame=2', desktop, async (page) => {
    await showsFrame(page, 2);
    for (const part of ['cloud', 'camera', 'targets']) await page.click(`[data-part=${part}]`);
    await showsWithout(page, 'cloud');
    await page.keyboard.press('c');
    await drawn(page);
    const overlap = await page.evaluate(robotOverlap);
    console.log(
      `robot in the scene and in the link image: intersection over union ${overlap.toFixed(3)}`,
    );
    // The scene's axis is the image's middle, 6 pixels beside the principal point.
    assert.ok(overlap > 0.85, `${overlap}`);
  }));

/** Runs in the page: the scene's robot, on the image's grid, over that of the link image. */
async function robotOverlap() {
  const bytes = await (await fetch('/api/frames/2/packet?with=links&step=4')).arrayBuffer();
  const length = new DataView(bytes).getUint32(0, true);
  const links = new Uint16Array(bytes.slice(4 + length));
  const canvas = document.getElementById('scene-canvas');
  const { clientWidth: width, clientHeight: height } = canvas;
  const focal = Math.min(height / 480, width / 640); // screen pixels for an image pixel
  const flat = new OffscreenCanvas(640, 480);
  const context = flat.getContext('2d');
  document.querySelector('[data-key=c]').click(); // drawn in this very frame
  await new Promise((done) => requestAnimationFrame(done));
  context.drawImage(
    canvas,
    ((width - 640 * focal) / 2) * (canvas.width / width),
    ((height - 480 * focal) / 2) * (canvas.height / height),
    640 * focal * (canvas.width / width),
    480 * focal * (canvas.height / height),
    0,
    0,
    640,
    480,
  );
  const { data } = context.getImageData(0, 0, 640, 480);
  const isRobot = (i) =>
    Math.max(data[i], data[i + 1], data[i + 2]) < 205 || data[i] > data[i + 2] + 25;
  let both = 0;
  let either = 0;
  for (let pixel = 0; pixel < links.length; ++pixel) {
    const u = (pixel % 640) - 6; // the principal point is at 326, 236
    const v = Math.floor(pixel / 640) + 4;
    if (u < 0 || v >= 480) continue;
    const drawn_ = isRobot(4 * (v * 640 + u));
    both += drawn_ && links[pixel] > 0 ? 1 : 0;
    either += drawn_ || links[pixel] > 0 ? 1 : 0;
  }
  return both / either;
}
