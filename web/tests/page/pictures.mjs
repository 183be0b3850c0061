// SPDX-License-Identifier: Apache-2.0
// Compares screenshots in the browser, which decodes them.
import { existsSync } from 'node:fs';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = fileURLToPath(new URL('baselines', import.meta.url));
const failed = fileURLToPath(new URL('failed', import.meta.url));

/**
 * Runs in the page: the difference of two PNGs' mean colours in each block of 8 x 8 pixels, 0 to 255.
 * It is small if a text moves by one pixel, and large if it is missing.
 * @returns the differences in each of the boxes, or null if the sizes differ
 */
async function blockDifferences([one, other, boxes]) {
  const pixelsOf = async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext('2d');
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, bitmap.width, bitmap.height);
  };
  const [a, b] = [await pixelsOf(one), await pixelsOf(other)];
  if (a.width !== b.width || a.height !== b.height) return null;
  const difference = (left, top, right, bottom) => {
    const sums = [0, 0, 0];
    for (let y = top; y < bottom; ++y)
      for (let x = left; x < right; ++x)
        for (let channel = 0; channel < 3; ++channel) {
          const at = 4 * (y * a.width + x) + channel;
          sums[channel] += a.data[at] - b.data[at];
        }
    return Math.max(...sums.map(Math.abs)) / ((right - left) * (bottom - top));
  };
  const whole = { x: 0, y: 0, width: a.width, height: a.height };
  return (boxes ?? [whole]).map((box) => {
    const [right, bottom] = [
      Math.min(a.width, Math.floor(box.x + box.width)),
      Math.min(a.height, Math.floor(box.y + box.height)),
    ];
    const found = [];
    for (let y = Math.max(0, Math.ceil(box.y)); y < bottom; y += 8)
      for (let x = Math.max(0, Math.ceil(box.x)); x < right; x += 8)
        found.push(difference(x, y, Math.min(x + 8, right), Math.min(y + 8, bottom)));
    return found;
  });
}

/** Runs in the page: halves the size of a screenshot; baselines have this size. */
async function half(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
  const canvas = new OffscreenCanvas(bitmap.width >> 1, bitmap.height >> 1);
  const context = canvas.getContext('2d');
  context.imageSmoothingQuality = 'high';
  context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  const made = new Uint8Array(await (await canvas.convertToBlob()).arrayBuffer());
  return btoa(Array.from(made, (byte) => String.fromCharCode(byte)).join(''));
}

const base64 = (buffer) => Buffer.from(buffer).toString('base64');

const changed = 6; // grey values: larger than rendering noise

const fractionOf = (differences) =>
  differences.filter((difference) => difference > changed).length / differences.length;

/** Returns the fraction of blocks that differ. */
export async function changedFraction(page, one, other) {
  const differences = await page.evaluate(blockDifferences, [base64(one), base64(other)]);
  return differences ? fractionOf(differences[0]) : 1;
}

/** Runs in the page: the boxes of its panels at half size, or null outside the screenshot. */
function boxesOf(selectors) {
  const boxOf = (selector) => {
    const node = document.querySelector(selector);
    const { left, top, width, height } = node?.getBoundingClientRect() ?? { width: 0 };
    if (width === 0 || top >= innerHeight) return null;
    return { x: left / 2, y: top / 2, width: width / 2, height: height / 2 };
  };
  return selectors.map(boxOf);
}

/**
 * Compares the page with its baseline; PENUMBRA_BASELINES=write replaces the baseline.
 * @param panels by name: a selector first
 * @returns by visible panel the fraction of its blocks that changed
 */
export async function againstBaseline(page, name, panels) {
  const file = path.join(folder, `${name}.png`);
  const picture = await page.screenshot();
  const small = Buffer.from(await page.evaluate(half, base64(picture)), 'base64');
  if (process.env.PENUMBRA_BASELINES === 'write') {
    await mkdir(folder, { recursive: true });
    await writeFile(file, small);
  }
  if (!existsSync(file)) throw new Error(`${file} does not exist`);
  const selectors = Object.values(panels).map(([selector]) => selector);
  const boxes = await page.evaluate(boxesOf, selectors);
  const seen = Object.keys(panels).filter((_, index) => boxes[index]);
  const kept = base64(await readFile(file));
  const all = [kept, base64(small), boxes.filter((box) => box)];
  const differences = await page.evaluate(blockDifferences, all);
  await mkdir(failed, { recursive: true });
  await writeFile(path.join(failed, `${name}.png`), small);
  return Object.fromEntries(
    seen.map((panel, index) => [panel, differences ? fractionOf(differences[index]) : 1]),
  );
}
