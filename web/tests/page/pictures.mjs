// SPDX-License-Identifier: Apache-2.0
// Pictures compared in the browser itself, which can decode them.
import { existsSync } from 'node:fs';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = fileURLToPath(new URL('baselines', import.meta.url));
const failed = fileURLToPath(new URL('failed', import.meta.url));

/** Runs in the page: mean difference of blocks of 8 x 8 pixels, 0 to 255, of two PNGs. */
async function blockDifferences([one, other]) {
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
  const columns = Math.ceil(a.width / 8);
  const sums = new Float64Array(columns * Math.ceil(a.height / 8));
  for (let i = 0; i < a.data.length; ++i) {
    const pixel = i >> 2;
    const at = ((pixel / a.width) >> 3) * columns + ((pixel % a.width) >> 3);
    if ((i & 3) < 3) sums[at] += Math.abs(a.data[i] - b.data[i]);
  }
  return Array.from(sums, (sum) => sum / (3 * 64));
}

/** Runs in the page: half as large, as baselines are kept. */
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

/** Share of blocks that differ by more than a grey value of 6: noise of drawing stays below. */
export async function changedShare(page, one, other) {
  const differences = await page.evaluate(blockDifferences, [base64(one), base64(other)]);
  if (!differences) return 1;
  return differences.filter((difference) => difference > 6).length / differences.length;
}

/**
 * The picture against the one that is kept; PENUMBRA_BASELINES=write keeps it anew.
 * @returns the share of blocks that changed
 */
export async function againstBaseline(page, name, picture) {
  const file = path.join(folder, `${name}.png`);
  const small = Buffer.from(await page.evaluate(half, base64(picture)), 'base64');
  if (process.env.PENUMBRA_BASELINES === 'write') {
    await mkdir(folder, { recursive: true });
    await writeFile(file, small);
    return 0;
  }
  if (!existsSync(file)) throw new Error(`${file} is not there`);
  const share = await changedShare(page, await readFile(file), small);
  await mkdir(failed, { recursive: true });
  await writeFile(path.join(failed, `${name}.png`), small);
  return share;
}
