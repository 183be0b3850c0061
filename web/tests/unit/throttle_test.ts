// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Throttle } from '../../src/model/throttle';

test('a throttle calls at once, and once more after the interval', async () => {
  let value = 0;
  const values: number[] = [];
  const throttle = new Throttle(40, () => values.push(value));
  for (value = 1; value <= 5; ++value) throttle.request();
  assert.deepEqual(values, [1]);
  await new Promise((resolve) => setTimeout(resolve, 200));
  assert.deepEqual(values, [1, 6]);
});
