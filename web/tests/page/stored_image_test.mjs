// SPDX-License-Identifier: Apache-2.0
// The page of a stored recording: image and scene.
import assert from 'node:assert/strict';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import {
  desktop,
  drawn,
  example,
  open,
  root,
  serve,
  showsFrame,
  showsLayer,
  showsWithout,
} from './browser.mjs';
import { headOf } from './live_server.mjs';
import { changedFraction } from './pictures.mjs';
import { frameShown, served } from './served.mjs';

const shared = served();
const { withPage } = shared;

test('the divider compares the colour image with the layer', () =>
  withPage('/#frame=6', desktop, async (page) => {
    await showsFrame(page, 6);
    const stage = page.locator('#image-stage');
    const overlay = await stage.screenshot();
    const box = await page.locator('#image-handle').boundingBox();
    const frame = await page.locator('#image-frame').boundingBox();
    await page.mouse.move(Math.max(box.x, frame.x) + 12, box.y + 30);
    await page.mouse.down();
    await page.mouse.move(frame.x + frame.width / 2, box.y + 30, { steps: 3 });
    await page.mouse.up();
    const handle = page.locator('#image-handle');
    assert.ok(Math.abs(Number(await handle.getAttribute('aria-valuenow')) - 50) <= 2);
    const halved = await stage.screenshot();
    await handle.press('End');
    const color = await stage.screenshot();
    assert.ok((await changedFraction(page, overlay, halved)) > 0.02);
    assert.ok((await changedFraction(page, halved, color)) > 0.02);
    assert.equal(await frameShown(page), 6, 'keys of the divider step no frames');
  }));

test('values under the pointer are those of the packet, in each layer', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    const layers = ['overlay', 'labels', 'links', 'vdi', 'depth'];
    const names = ['clear', 'front', 'occluded', 'unknown', 'beyond', 'fringe'];
    const pixels = [
      [320, 190],
      [480, 230],
      [30, 30],
      [265, 290],
      [250, 170],
    ];
    for (const [index, [u, v]] of pixels.entries()) {
      await page.keyboard.press(String(index + 1));
      await showsLayer(page, layers[index]); // the legend may move the image
      const at = (pixel, size, length) => ((pixel + 0.5) / size) * length;
      const box = await page.locator('#image-frame').boundingBox();
      await page.mouse.move(box.x + at(u, 640, box.width), box.y + at(v, 480, box.height));
      await page.waitForFunction(([expectedU, expectedV]) => {
        const textOf = (name) => document.getElementById(`read-${name}`).textContent;
        const [shownU, shownV] = textOf('px').split(', ').map(Number);
        const isNear = Math.abs(shownU - expectedU) <= 1 && Math.abs(shownV - expectedV) <= 1;
        return isNear && textOf('measured') !== '–';
      }, pixels[index]);
      const read = (name) => page.locator(`#read-${name}`).textContent();
      const [shownU, shownV] = (await read('px')).split(', ').map(Number);
      const { label, depth } = await valueAt(shownU, shownV);
      assert.equal(await read('label'), names[label]);
      assert.equal(await read('measured'), depth > 0 ? `${depth.toFixed(3)} m` : 'none');
    }
  }));

/** Returns the parts of a packet, read without the page's code. */
async function packetParts(names = 'labels,depth,cloud') {
  const address = new URL(`/api/frames/3/packet?with=${names}&step=2`, shared.server.url);
  const packet = headOf(Buffer.from(await (await fetch(address)).arrayBuffer()));
  let at = 0;
  return Object.fromEntries(
    packet.head.parts.map(({ name, size }) => [name, packet.parts.subarray(at, (at += size))]),
  );
}
let parts;
async function valueAt(u, v) {
  parts ??= await packetParts();
  const at = v * 640 + u;
  return { label: parts.labels[at], depth: parts.depth.readFloatLE(4 * at) };
}

test('residuals are blue before the robot, red behind it, striped without measurement', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    await page.keyboard.press('6');
    await showsLayer(page, 'residual');
    const { vdi, depth } = await packetParts('vdi,depth');
    const shown = await pixelsOf(page, 'image-above');
    const fullColor = 0.02; // metres
    let seen = 0;
    for (let at = 0; at < shown.length / 4; ++at) {
      const [r, g, b, alpha] = shown.slice(4 * at, 4 * at + 4);
      const virtual = vdi.readFloatLE(4 * at);
      const measured = depth.readFloatLE(4 * at);
      const residual = measured - virtual;
      if (virtual === 0) assert.equal(alpha, 0);
      else if (measured === 0) assert.ok(r === g && g === b && r < 100);
      else if (Math.abs(residual) > fullColor)
        assert.deepEqual([r, g, b], residual < 0 ? [0, 0, 255] : [255, 0, 0]);
      else assert.ok(residual < 0 ? b === 255 && r === g : r === 255 && g === b);
      seen += virtual > 0 && measured > 0;
    }
    assert.ok(seen > 1000);
    assert.match(await page.locator('#image-legend').textContent(), /20 mm/);
  }));

const isSurroundings = (label) => label === 0 || label === 1;

/** Returns red, green, blue and alpha of each pixel of a canvas. */
async function pixelsOf(page, id) {
  // As text: Playwright takes seconds for a list of a million numbers.
  const text = await page.evaluate((canvasId) => {
    const { width, height } = document.getElementById(canvasId);
    const context = new OffscreenCanvas(width, height).getContext('2d');
    context.drawImage(document.getElementById(canvasId), 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    return btoa(Array.from(data, (value) => String.fromCharCode(value)).join(''));
  }, id);
  return Buffer.from(text, 'base64');
}
const alphaOf = async (page, id) => (await pixelsOf(page, id)).filter((_, at) => at % 4 === 3);

test('without the robot, only clear and front points and pixels remain', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    parts ??= await packetParts();
    const labels = Array.from(
      { length: parts.cloud.length / 16 },
      (_, i) => parts.cloud[16 * i + 12],
    );
    const kept = labels.filter(isSurroundings).length;
    assert.ok(kept > 0 && kept < labels.length && labels.includes(1), 'has front and robot');
    const shownPoints = (count) =>
      page.locator(`#scene-canvas[data-points="${count}"]`).waitFor({ state: 'attached' });
    const button = page.getByRole('button', { name: 'Without robot' });
    const robot = page.locator('[data-part=robot]');
    await shownPoints(labels.length);
    await page.keyboard.press('w');
    await shownPoints(kept);
    assert.equal(await button.getAttribute('aria-pressed'), 'true');
    assert.equal(await robot.getAttribute('aria-pressed'), 'false', 'hides the model, too');
    for (const [key, layer] of Object.entries({ 1: 'overlay', 5: 'depth' })) {
      await page.keyboard.press(key);
      await showsLayer(page, layer);
      for (const id of ['image-below', 'image-above']) {
        const alpha = await alphaOf(page, id);
        const isOpaque = id === 'image-below' || layer === 'depth'; // the overlay is transparent
        const wrong = alpha.filter((a, at) =>
          isSurroundings(parts.labels[at]) ? isOpaque && a !== 255 : a !== 0,
        );
        assert.deepEqual([alpha.length, wrong.length], [parts.labels.length, 0], `${layer} ${id}`);
      }
    }
    assert.match(await page.locator('#image-legend').textContent(), /checkered: removed/);
    await page.keyboard.press('ArrowRight');
    await showsFrame(page, 4);
    assert.equal(await button.getAttribute('aria-pressed'), 'true', 'also in other frames');
    await page.keyboard.press('ArrowLeft');
    await showsFrame(page, 3);
    await shownPoints(kept);
    await button.click();
    await shownPoints(labels.length);
    assert.equal(await robot.getAttribute('aria-pressed'), 'true');
    const alpha = await alphaOf(page, 'image-above');
    assert.ok(alpha.every((a) => a === 255));
  }));

test('the overlay has the outlines of a calibration, also once values are there', async () => {
  const server = await serve(example, '0', 'view', '--calibrate');
  try {
    const packetOf = async (parts) =>
      (await (await fetch(new URL(`/api/frames/3/packet?with=${parts}`, server.url))).arrayBuffer())
        .byteLength;
    const withoutParts = await packetOf('');
    // The pose is found after the frames were judged.
    while ((await packetOf('outlines')) === withoutParts)
      await new Promise((resolve) => setTimeout(resolve, 100));
    const { page, faults, close } = await open(shared.browser, `${server.url}#frame=3`);
    await showsFrame(page, 3);
    const hasOutlines = async () => {
      const legend = await page.locator('#image-legend').textContent();
      assert.match(legend, /pose in use.*found pose/);
    };
    await hasOutlines();
    const box = await page.locator('#image-frame').boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.waitForFunction(() => document.getElementById('read-measured').textContent !== '–');
    await hasOutlines();
    assert.deepEqual(faults, []);
    await close();
  } finally {
    await server.stop();
  }
});

test('the overlay has outlines and names of targets', () =>
  withPage('/#frame=3&target=cube', desktop, async (page) => {
    await showsFrame(page, 3);
    const names = page.locator('#image-names .target-name');
    const { targets } = shared.report.frames[3];
    const names_ = targets.map(({ name }) => name);
    assert.deepEqual(
      (await names.allTextContents()).map((text) => text.replace('?', '')),
      names_,
    );
    assert.equal(await page.locator('#image-names .selected').textContent(), 'cube');
    assert.equal(await page.locator('#image-lines .outline').count(), targets.length);
    const boxes = await names.evaluateAll((all) =>
      all.map((one) => one.getBoundingClientRect().toJSON()),
    );
    const frame = await page.locator('#image-frame').boundingBox();
    for (const [i, box] of boxes.entries()) {
      assert.ok(box.left >= frame.x && box.right <= frame.x + frame.width + 1, names_[i]);
      for (const other of boxes.slice(0, i))
        assert.ok(
          box.right <= other.left ||
            other.right <= box.left ||
            box.bottom <= other.top ||
            other.bottom <= box.top,
          `${names_[i]} overlaps another name`,
        );
    }
    await page.click('[data-target=lid]');
    assert.equal(await page.locator('#image-names .selected').textContent(), '?lid');
    await page.keyboard.press('5');
    await showsLayer(page, 'depth');
    assert.equal(await names.count(), 0, 'other layers have no names');
    const legend = await page.locator('#image-legend').textContent();
    assert.match(legend, /\d\.\d{3} m\d\.\d{3} m.*striped/);
  }));

test('the legend says what a label means, and its name behind it', () =>
  withPage('/', desktop, async (page) => {
    await showsFrame(page, 0);
    const entries = await page.locator('#image-legend .legend-entry').evaluateAll((all) =>
      all.map((one) => {
        const name = one.querySelector('.word').textContent;
        const { right } = one.querySelector('.word').getBoundingClientRect();
        const { right: end } = document.getElementById('image').getBoundingClientRect();
        return { name, text: one.textContent, isInside: right <= end };
      }),
    );
    assert.deepEqual(
      entries.map(({ name }) => name),
      ['front', 'occluded', 'unknown', 'beyond', 'fringe'],
    );
    for (const { name, text, isInside } of entries) {
      assert.match(text, new RegExp(`^\\w.+ \\w+ ${name}$`));
      assert.ok(isInside, text);
    }
  }));

const wide = path.join(root, '../shared/data/xarm7_realsense'); // 1280 x 720
test('a wide image fills its pane', { skip: !existsSync(wide) && `no ${wide}` }, async () => {
  const folder = mkdtempSync(path.join(tmpdir(), 'wide-'));
  cpSync(wide, folder, { recursive: true });
  const recording = path.join(folder, 'recording.yaml');
  const robots = path.join(wide, '../robots');
  const text = readFileSync(recording, 'utf8').replaceAll('../robots', robots);
  writeFileSync(recording, `${text}\ntargets: targets.yaml\n`);
  const boxes = ['left', 'middle', 'right'].map((name, i) => [name, 300 * i + 100]);
  const targets = boxes.map(([name, u]) => `  - {name: ${name}, box: [${u}, 300, 80, 80]}\n`);
  writeFileSync(path.join(folder, 'targets.yaml'), `targets:\n${targets.join('')}`);
  const server = await serve(folder);
  const { page, faults, close } = await open(shared.browser, server.url);
  await showsFrame(page, 0);
  await page.waitForFunction(() => {
    const [frame, stage] = ['image-frame', 'image-stage'].map((id) =>
      document.getElementById(id).getBoundingClientRect(),
    );
    return frame.width * frame.height > 0.95 * stage.width * stage.height;
  });
  const [frame, stage, scene] = await Promise.all(
    ['#image-frame', '#image-stage', '#scene'].map((id) => page.locator(id).boundingBox()),
  );
  assert.ok(Math.abs(frame.width / frame.height - 16 / 9) < 0.01);
  assert.ok(scene.width > 300, 'the scene keeps a place');
  assert.deepEqual(faults, []);
  await close();
  await server.stop();
  rmSync(folder, { recursive: true });
});

test('the scene is drawn, rotates, and hides its parts', () =>
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
    assert.ok((await changedFraction(page, first, turned)) > 0.2, 'rotated');
    for (const part of ['cloud', 'robot', 'camera', 'targets']) {
      const with_ = await scene.screenshot();
      await page.click(`[data-part=${part}]`);
      if (part === 'cloud') await showsWithout(page, part);
      else await drawn(page);
      await page.mouse.move(5, 5);
      const without = await scene.screenshot();
      assert.ok((await changedFraction(page, with_, without)) > 0.002, `${part} was there`);
    }
  }));

test('from the camera, the robot covers the pixels of the link image', () =>
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
    // The scene's axis is the image's centre, 6 pixels next to the principal point.
    assert.ok(overlap > 0.85, `${overlap}`);
  }));

/** Runs in the page: intersection over union of the robot in the scene and in the link image. */
async function robotOverlap() {
  const bytes = await (await fetch('/api/frames/2/packet?with=links&step=4')).arrayBuffer();
  const length = new DataView(bytes).getUint32(0, true);
  const links = new Uint16Array(bytes.slice(4 + length));
  const canvas = document.getElementById('scene-canvas');
  const { clientWidth: width, clientHeight: height } = canvas;
  const focal = Math.min(height / 480, width / 640); // screen pixels for an image pixel
  const flat = new OffscreenCanvas(640, 480);
  const context = flat.getContext('2d');
  document.querySelector('[data-key=c]').click(); // drawn in this frame
  await new Promise((done) => requestAnimationFrame(done));
  const shown = [(width - 640 * focal) / 2, (height - 480 * focal) / 2, 640 * focal, 480 * focal];
  const ratio = canvas.width / width;
  context.drawImage(canvas, ...shown.map((length) => length * ratio), 0, 0, 640, 480);
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
