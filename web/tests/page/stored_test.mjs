// SPDX-License-Identifier: Apache-2.0
// The page of a stored recording, as a user drives it, with the program that serves it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import {
  desktop,
  drawn,
  example,
  launch,
  open,
  phone,
  serve,
  showsFrame,
  showsLayer,
  showsWithout,
} from './browser.mjs';
import { changedShare } from './pictures.mjs';

const step = process.env.PENUMBRA_FULL ? 1 : 4; // of the frames whose numbers are compared
const mostSeconds = 2; // until the first frame is shown
let browser, server, report;

before(async () => {
  [browser, server] = await Promise.all([launch(), serve(example)]);
  report = await (await fetch(new URL('/api/report', server.url))).json();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** @param address what follows the host */
async function withPage(address, options, use) {
  const shown = await open(browser, new URL(address, server.url).href, options);
  try {
    await use(shown.page, shown);
    assert.deepEqual(shown.faults, []);
  } finally {
    await shown.close();
  }
}

const frameShown = async (page) => Number(await page.locator('#frame-number').textContent());

test('loads in less than two seconds', async () => {
  // The first is the browser's own start; of the others the best one, as other programs run, too.
  const loads = [];
  for (let i = 0; i < 4; ++i)
    await withPage('/', desktop, (_, { seconds }) => void loads.push(seconds));
  console.log(`first frame after ${loads.map((seconds) => seconds.toFixed(2)).join(', ')} s`);
  assert.ok(Math.min(...loads.slice(1)) < mostSeconds, `${loads} s`);
});

test('every number of every target is report.json’s', () =>
  withPage('/', desktop, async (page) => {
    let compared = 0;
    for (const frame of report.frames) {
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
          const told = key in target ? target[key] : (target.handled?.[key] ?? null);
          assert.deepEqual(JSON.parse(value), told, `${frame.index} ${target.name} ${key}`);
          if (key.endsWith('_fraction') && told !== null)
            assert.ok(
              Math.abs(Number.parseFloat(text) / 100 - told) <= 0.5001e-4,
              `${key}: ${text}`,
            );
          if (told === null) assert.equal(text, '–');
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

test('steps, jumps and plays', () =>
  withPage('/', desktop, async (page) => {
    await page.click('#step-forward');
    await showsFrame(page, 1);
    await page.keyboard.press('ArrowLeft');
    await showsFrame(page, 0);
    await page.keyboard.press('End');
    await showsFrame(page, 11);
    await page.keyboard.press('Home');
    await showsFrame(page, 0);
    await page.selectOption('#speed', '4');
    await page.keyboard.press(' ');
    await showsFrame(page, 11);
    assert.equal(await page.locator('html').getAttribute('class'), '', 'it pauses at the end');
    await page.selectOption('#speed', '0.25');
    await page.keyboard.press(' '); // from the start again
    await page.waitForFunction(() => {
      const frame = Number(document.getElementById('frame-number').textContent);
      return frame > 0 && frame < 11;
    });
    await page.click('#play');
    await page.locator('html:not(.playing)').waitFor();
    await drawn(page); // the frame that was being drawn
    const at = await frameShown(page);
    await page.waitForTimeout(500);
    assert.equal(await frameShown(page), at);
  }));

test('after many steps at once it is the last frame that is drawn', () =>
  withPage('/#frame=9', desktop, async (page) => {
    await showsFrame(page, 9);
    const expected = await page.locator('#main').screenshot();
    for (let round = 0; round < 3; ++round) {
      for (const key of ['End', 'Home', 'ArrowRight', '2', 'End', '1', 'ArrowLeft', 'ArrowLeft'])
        await page.keyboard.press(key);
      await showsFrame(page, 9);
      const shown = await page.locator('#main').screenshot();
      assert.ok((await changedShare(page, expected, shown)) < 0.001);
    }
  }));

test('jumps to the next and the previous occlusion', () =>
  withPage('/', desktop, async (page) => {
    await page.keyboard.press(']');
    await showsFrame(page, 2);
    assert.match(await page.locator('#announce').textContent(), /cylinder, lid/);
    await page.click('#next-occlusion');
    await showsFrame(page, 5);
    await page.keyboard.press(']');
    assert.match(await page.locator('#announce').textContent(), /no later occlusion/);
    await page.keyboard.press('[');
    await showsFrame(page, 2);
  }));

test('the timeline leads to the frame under the pointer', () =>
  withPage('/', desktop, async (page) => {
    const box = await page.locator('.row-body').first().boundingBox();
    const x = (frame) => box.x + ((frame + 0.5) * box.width) / report.frames.length;
    await page.mouse.click(x(7), box.y + 10);
    await showsFrame(page, 7);
    assert.equal(await page.locator('.playhead').getAttribute('aria-valuenow'), '7');
    await page.mouse.down();
    await page.mouse.move(x(4), box.y + 10, { steps: 4 });
    await page.mouse.up();
    await showsFrame(page, 4);
    assert.match(await page.locator('.tip').textContent(), /frame 4 .*\ncube: visible/);
  }));

test('the address keeps frame and target', () =>
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
    const names = ['clear', 'front', 'occluded', 'unknown', 'beyond'];
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
  const address = new URL('/api/frames/3/packet?with=labels,depth&step=4', server.url);
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
  document.getElementById('view-camera').click(); // drawn in this very frame
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

test('light and dark: the system’s, until one is chosen', async () => {
  const theme = (page) => page.locator('html').getAttribute('data-theme');
  await withPage('/', { ...desktop, colorScheme: 'dark' }, async (page) => {
    assert.equal(await theme(page), 'dark');
    await page.emulateMedia({ colorScheme: 'light' });
    await page.locator('html[data-theme=light]').waitFor();
    const light = await page.screenshot();
    await page.keyboard.press('t');
    assert.equal(await theme(page), 'dark');
    await drawn(page);
    assert.ok((await changedShare(page, light, await page.screenshot())) > 0.5);
    await page.reload();
    assert.equal(await theme(page), 'dark');
  });
});

test('light and dark can be chosen where nothing may be stored', async () => {
  const context = await browser.newContext({ ...desktop, deviceScaleFactor: 1 });
  const page = await context.newPage();
  await page.addInitScript(() =>
    Object.defineProperty(window, 'localStorage', {
      get() {
        throw new DOMException('off', 'SecurityError');
      },
    }),
  );
  await page.goto(server.url);
  await showsFrame(page, 0);
  for (const theme of ['dark', 'light']) {
    await page.click('#theme');
    assert.equal(await page.locator('html').getAttribute('data-theme'), theme);
  }
  await context.close();
});

test('layers are radio buttons to the keyboard, and arrows step elsewhere', () =>
  withPage('/#frame=3', desktop, async (page) => {
    await showsFrame(page, 3);
    const focused = () => page.evaluate(() => document.activeElement.dataset.layer);
    const checked = () => page.locator('#layers [aria-checked=true]').getAttribute('data-layer');
    assert.equal(await page.locator('#layers [tabindex="0"]').count(), 1, 'one stop for tab');
    await page.focus('#layers [aria-checked=true]');
    for (const [key, layer] of [
      ['ArrowRight', 'labels'],
      ['ArrowDown', 'links'],
      ['ArrowLeft', 'labels'],
      ['End', 'depth'],
      ['ArrowRight', 'overlay'],
      ['ArrowUp', 'depth'],
      ['Home', 'overlay'],
    ]) {
      await page.keyboard.press(key);
      assert.deepEqual([await focused(), await checked()], [layer, layer], key);
    }
    assert.equal(await frameShown(page), 3, 'no frame was stepped');
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('ArrowRight');
    await showsFrame(page, 4);
  }));

test('the button says what it does', () =>
  withPage('/', desktop, async (page) => {
    const name = () => page.locator('#play').getAttribute('aria-label');
    assert.equal(await name(), 'Play');
    await page.selectOption('#speed', '0.25');
    await page.click('#play');
    assert.equal(await name(), 'Pause');
    await page.click('#play');
    assert.equal(await name(), 'Play');
  }));

test('the list says how much is hidden, by robot and others, as the overlay does', () =>
  withPage('/', desktop, async (page) => {
    let others = 0;
    for (const frame of report.frames) {
      await showsFrame(page, frame.index);
      const shown = await page
        .locator('#target-list [data-target]')
        .evaluateAll((all) =>
          all.map((one) => [one.querySelector('.amount').textContent, one.ariaLabel]),
        );
      frame.targets.forEach((target, i) => {
        // As io/target_overlay.cpp writes it at the target.
        const isTold = target.verdict !== 'unknown' && target.inside > 0;
        const share = target.occluded_fraction + (target.hidden_by_other_fraction ?? 0);
        const text = isTold ? `${Math.round(100 * share)} %` : '–';
        assert.equal(shown[i][0], text, `frame ${frame.index}: ${target.name}`);
        assert.ok(shown[i][1].endsWith(`${text} hidden`), shown[i][1]);
        others += isTold && target.hidden_by_other_fraction > 0.1 ? 1 : 0;
      });
      await page.keyboard.press('ArrowRight');
    }
    assert.ok(others > 0, 'there is one that others hide');
  }));

test('keys are told, and the page can be used by keys alone', () =>
  withPage('/', desktop, async (page) => {
    await page.keyboard.press('?');
    assert.ok(await page.locator('#help').isVisible());
    await page.keyboard.press('Escape');
    assert.ok(!(await page.locator('#help').isVisible()));
    await page.keyboard.press('ArrowDown');
    const chosen = page.locator('#target-list [aria-pressed=true]');
    const name = await chosen.getAttribute('data-target');
    await page.keyboard.press('ArrowUp');
    assert.notEqual(await chosen.getAttribute('data-target'), name);
    const reached = new Set();
    for (let tabs = 0; tabs < 60; ++tabs) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => document.activeElement?.id ?? ''));
    }
    for (const id of ['theme', 'help-button', 'scene-canvas', 'picture-handle', 'play', 'speed'])
      assert.ok(reached.has(id), `${id} is reached by tab`);
  }));

test('what can be pressed has a name', () =>
  withPage('/', desktop, async (page) => {
    const nameless = await page
      .locator('button:visible, select:visible, [role]:visible, canvas:visible')
      .evaluateAll((nodes) =>
        nodes
          .filter((node) => {
            const label = node.getAttribute('aria-label') ?? node.textContent ?? '';
            const labelled =
              node.closest('label') !== null || node.getAttribute('role') === 'status';
            return !label.trim() && !labelled;
          })
          .map((node) => node.outerHTML.slice(0, 80)),
      );
    assert.deepEqual(nameless, []);
  }));

for (const width of [360, 390])
  test(`a phone of ${width} pixels shows all, by touch`, () =>
    withPage('/', { ...phone, viewport: { width, height: 780 } }, async (page) => {
      const overflow = await page.evaluate(
        () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
      );
      assert.equal(overflow, 0, 'nothing sticks out at the side');
      const mode = await page.locator('#mode').evaluate((node) => ({
        whole: node.scrollWidth <= node.clientWidth,
        text: node.textContent,
      }));
      assert.deepEqual(mode, { whole: true, text: '12 frames' });
      assert.ok(await page.locator('#scene').isVisible());
      await page.tap('[data-view=picture]');
      assert.ok(!(await page.locator('#scene').isVisible()));
      await page.tap('#picture-frame', { position: { x: 200, y: 100 } });
      await page.waitForFunction(() => document.getElementById('read-label').textContent !== '–');
      await page.tap('#step-forward');
      await showsFrame(page, 1);
      const small = await page
        .locator('#transport button:visible')
        .evaluateAll(
          (nodes) => nodes.filter((node) => node.clientHeight < 40 || node.clientWidth < 40).length,
        );
      assert.equal(small, 0, 'large enough for a finger');
    }));
