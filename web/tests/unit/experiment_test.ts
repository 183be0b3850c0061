// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { errorPath } from '../../src/experiment/error_chart';
import { lengthName, scaleOf, shareOf, ticksOf } from '../../src/experiment/log_scale';

test('each power of ten takes as much of the scale, and values beyond it lie on its ends', () => {
  const scale = { low: 1, high: 1000 };
  const shares = [1, 10, 100, 1000, 0, 5000].map((value) => shareOf(scale, value));
  shares.forEach((share, i) =>
    assert.ok(Math.abs(share - ([0, 1 / 3, 2 / 3, 1, 0, 1][i] as number)) < 1e-12),
  );
  assert.deepEqual(ticksOf(scale), [1, 10, 100, 1000]);
});

test('a scale holds all values, and nothing where nothing is above 0', () => {
  assert.deepEqual(scaleOf([2, 45, 0]), { low: 1, high: 100 });
  assert.deepEqual(scaleOf([10]), { low: 10, high: 100 });
  assert.deepEqual(scaleOf([0.3]), { low: 0.1, high: 1 });
  assert.equal(scaleOf([0]), null);
  assert.equal(scaleOf([]), null);
});

test('lengths are named in the largest unit below them', () => {
  assert.deepEqual([0.1, 1, 10, 100, 1000, 10000].map(lengthName), [
    '0.1 mm',
    '1 mm',
    '1 cm',
    '10 cm',
    '1 m',
    '10 m',
  ]);
});

test('no pose is a gap, and a single pose a dot', () => {
  const path = errorPath([1, 1, null, 1000, null, 1], 60);
  assert.equal(path, 'M5.0 126.0h0L15.0 126.0M35.0 6.0h0M55.0 126.0h0');
});

test('where frames share a column, none without a pose gets lost', () => {
  assert.equal(errorPath([1, null, 1, 1000], 2), 'M1.5 6.0h0');
});
