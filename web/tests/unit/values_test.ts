// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { parseJson } from '../../src/api/json';
import { pointBytes, type Packet } from '../../src/api/packet';
import { depthColors, depthRange } from '../../src/model/depth_colors';
import { count, metres, milliseconds, percent, stamp } from '../../src/model/format';
import { FrameCache } from '../../src/model/frame_cache';
import { waitOf } from '../../src/model/player';
import { copySurroundings } from '../../src/model/surroundings';
import { niceStep } from '../../src/timeline/charts';
import { labelTable, overlayTable } from '../../src/view/painters';
import { readoutAt } from '../../src/view/readout';
import { frame } from './support';

const packet: Packet = {
  frame: frame(0, []),
  server: 'a',
  sceneVersion: 1,
  linkPoses: [],
  cameraPose: null,
  marks: [],
  live: null,
  byteLength: 100,
  has: new Set(['labels', 'links', 'vdi', 'depth']),
  labels: { width: 2, height: 1, values: Uint8Array.of(2, 3) },
  links: { width: 2, height: 1, values: Uint16Array.of(1, 0) },
  vdi: { width: 2, height: 1, values: Float32Array.of(1.5, 0) },
  depth: { width: 2, height: 1, values: Float32Array.of(1.25, 0) },
};

test('names come without marks that turn the direction of text', () => {
  const text = '{"name": "a\u202ecod.exe\u2066\u200f", "other": "\u05d0 \u8155 caf\u00e9"}';
  assert.deepEqual(parseJson(text), {
    name: 'a\ufffdcod.exe\ufffd\ufffd',
    other: '\u05d0 \u8155 caf\u00e9',
  });
});

test('what is not known is a dash, never a zero', () => {
  assert.equal(percent(null), '–');
  assert.equal(metres(undefined), '–');
  assert.equal(milliseconds(Number.NaN), '–');
  assert.equal(percent(0), '0.0 %');
  assert.equal(count(1234567), '1\u202f234\u202f567');
});

test('stamps of both kinds of clocks', () => {
  assert.equal(stamp('1700000000300000001'), '2023-11-14 22:13:20.300');
  assert.equal(stamp('12500000000'), '12.500 s');
  assert.equal(stamp(null), '–');
});

test('values under the pointer are the packet’s', () => {
  const first = readoutAt(packet, ['forearm'], 0, 0, 2);
  assert.deepEqual(
    [first.label, first.link, first.virtual, first.measured, first.difference],
    ['occluded', 'forearm', '1.500 m', '1.250 m', '−250 mm'],
  );
  const second = readoutAt(packet, ['forearm'], 1, 0, 2);
  assert.deepEqual(
    [second.label, second.link, second.virtual, second.measured, second.difference],
    ['unknown', 'no link', 'none', 'none', '–'],
  );
  assert.equal(
    readoutAt({ ...packet, labels: { width: 0, height: 0, values: new Uint8Array() } }, [], 0, 0, 2)
      .label,
    '–',
  );
});

test('the scale of depths ends at percentiles of what is measured', () => {
  const depths = Float32Array.from({ length: 1000 }, (_, i) => 1 + i / 1000);
  depths.set([0, Number.NaN, Infinity, -1], 300);
  depths.set([0.01, 65, 60], 500); // a few that are off
  const [near, far] = depthRange(depths) ?? [0, 0];
  assert.ok(Math.abs(near - 1.02) < 0.003 && Math.abs(far - 1.98) < 0.003, `${near} ${far}`);
  assert.deepEqual(depthRange(Float32Array.of(0, 2)), [2, 2]);
  assert.equal(depthRange(Float32Array.of(0, Number.NaN)), null);
});

test('the depth colours rise evenly in lightness', () => {
  const lightness = depthColors.map(([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b);
  for (let i = 1; i < lightness.length; ++i)
    assert.ok((lightness[i] as number) <= (lightness[i - 1] as number) + 1, `at ${i}`);
});

test('frames are paced by their stamps, and gaps are not waited for', () => {
  const times = [0, 0.1, 0.4, 100, null, 101];
  assert.ok(Math.abs(waitOf(times, 0, 1) - 0.1) < 1e-12);
  assert.ok(Math.abs(waitOf(times, 1, 2) - 0.15) < 1e-12);
  assert.equal(waitOf(times, 2, 1), 1);
  assert.equal(waitOf(times, 3, 1), 0.1);
  assert.equal(waitOf(times, 4, 0.5), 0.2);
});

test('ticks stand at round numbers', () => {
  assert.deepEqual([0.7, 1, 1.2, 2, 3, 6, 11, 51].map(niceStep), [1, 1, 2, 2, 5, 10, 20, 100]);
});

test('the cache fetches a frame once, and forgets the longest unused', async () => {
  const fetched: number[] = [];
  const cache = new FrameCache((index) => {
    fetched.push(index);
    return Promise.resolve({ ...packet, byteLength: 100 });
  }, 250);
  for (const index of [1, 1, 2, 1, 3, 1, 2]) await cache.get(index, ['color']);
  assert.deepEqual(fetched, [1, 2, 3, 2]);
});

test('labels of a later Penumbra are seen, and look like none of ours', () => {
  for (const table of [labelTable, overlayTable]) {
    assert.equal(table[0], 0, 'clear is clear');
    const ours = new Set(table.slice(0, 6));
    assert.equal(ours.size, 6);
    for (const value of [6, 17, 255]) {
      assert.ok((table[value] as number) >>> 24 > 0, `${value} is no clear`);
      assert.ok(!ours.has(table[value] as number), `${value} is none of ours`);
    }
  }
});

test('the label fringe has a name', () => {
  const labels = { width: 1, height: 1, values: Uint8Array.of(5) };
  assert.equal(readoutAt({ ...packet, labels }, [], 0, 0, 1).label, 'fringe');
});

test('without the robot the points that are clear or front are left', () => {
  const points = [0, 1, 2, 3, 4, 5, 6, 1, 0].map((label, i) => {
    const bytes = new Uint8Array(pointBytes).fill(100 + i);
    bytes[12] = label;
    return bytes;
  });
  const bytes = Uint8Array.from(points.flatMap((point) => [...point]));
  const to = new Uint8Array(bytes.length);
  const count = copySurroundings({ count: points.length, bytes }, to);
  const left = [0, 1, 7, 8].flatMap((i) => [...(points[i] as Uint8Array)]);
  assert.equal(count, 4);
  assert.deepEqual([...to.subarray(0, pointBytes * count)], left);
});
