// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { parseJson } from '../../src/api/packet';
import { depthColors, depthRange } from '../../src/model/depth_colors';
import { count, metres, milliseconds, percent, stamp } from '../../src/model/format';
import { labelColor, labelStyles } from '../../src/model/labels';
import { waitOf } from '../../src/model/timeline';
import { lessSeen, moreSeen } from '../../src/report/parts';
import { niceStep } from '../../src/timeline/charts';

test('replaces direction marks', () => {
  const text = '{"name": "a\u202ecod.exe\u2066\u200f", "other": "\u05d0 \u8155 caf\u00e9"}';
  assert.deepEqual(parseJson(text), {
    name: 'a\ufffdcod.exe\ufffd\ufffd',
    other: '\u05d0 \u8155 caf\u00e9',
  });
});

test('an unknown value is a dash', () => {
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

test('the depth scale ends at percentiles of the measured depths', () => {
  const depths = Float32Array.from({ length: 1000 }, (_, i) => 1 + i / 1000);
  depths.set([0, Number.NaN, Infinity, -1], 300);
  depths.set([0.01, 65, 60], 500); // outliers
  const [near, far] = depthRange(depths) ?? [0, 0];
  assert.ok(Math.abs(near - 1.02) < 0.003 && Math.abs(far - 1.98) < 0.003, `${near} ${far}`);
  assert.deepEqual(depthRange(Float32Array.of(0, 2)), [2, 2]);
  assert.equal(depthRange(Float32Array.of(0, Number.NaN)), null);
});

test('the lightness of depth colours is monotonic', () => {
  const lightness = depthColors.map(([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b);
  for (let i = 1; i < lightness.length; ++i)
    assert.ok((lightness[i] as number) <= (lightness[i - 1] as number) + 1, `at ${i}`);
});

test('stamps set the pace of playback, and gaps are shortened', () => {
  const times = [0, 0.1, 0.4, 100, null, 101];
  assert.ok(Math.abs(waitOf(times, 0, 1) - 0.1) < 1e-12);
  assert.ok(Math.abs(waitOf(times, 1, 2) - 0.15) < 1e-12);
  assert.equal(waitOf(times, 2, 1), 1);
  assert.equal(waitOf(times, 3, 1), 0.1);
  assert.equal(waitOf(times, 4, 0.5), 0.2);
});

test('ticks are at round numbers', () => {
  assert.deepEqual([0.7, 1, 1.2, 2, 3, 6, 11, 51].map(niceStep), [1, 1, 2, 2, 5, 10, 20, 100]);
});

test('invalid labels are visible, and differ from all labels', () => {
  const colors = labelStyles.map((_, label) => labelColor(label));
  assert.equal(new Set(colors).size, colors.length);
  assert.equal(colors[0], null, 'clear');
  for (const label of [6, 17, 255]) assert.ok(!colors.includes(labelColor(label)), `${label}`);
});

test('of several verdicts a bar shows the one in which least is seen, a set of cameras most', () => {
  const order = ['unknown', 'out_of_view', 'held', 'hidden', 'partial', 'visible'] as const;
  order.forEach((less, i) => {
    for (const more of order.slice(i)) {
      assert.deepEqual([lessSeen(less, more), lessSeen(more, less)], [less, less]);
      assert.deepEqual([moreSeen(less, more), moreSeen(more, less)], [more, more]);
    }
  });
});
