// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mostQuiet } from '../../src/model/quiet';
import { Throttle } from '../../src/model/throttle';

const rest = (milliseconds: number): Promise<void> =>
  new Promise((resolve) => setTimeout(resolve, milliseconds));

test('what a throttle left out is drawn when its time has come, and once', async () => {
  let value = 0;
  const drawn: number[] = [];
  const throttle = new Throttle(40, () => drawn.push(value));
  for (value = 1; value <= 5; ++value) throttle.request();
  assert.deepEqual(drawn, [1]);
  await rest(200);
  assert.deepEqual(drawn, [1, 6], 'the last, not the second');
});

test('a throttle that is flushed draws what is pending, and nothing twice', async () => {
  let drawn = 0;
  const throttle = new Throttle(40, () => ++drawn);
  throttle.flush();
  assert.equal(drawn, 0);
  throttle.request();
  throttle.request();
  throttle.flush();
  assert.equal(drawn, 2);
  await rest(200);
  assert.equal(drawn, 2);
});

test('a second without a frame is told; of slow cameras two and a half periods are', () => {
  assert.equal(mostQuiet(30, false), 1000);
  assert.equal(mostQuiet(0, false), 1000);
  assert.equal(mostQuiet(1, false), 2500);
  assert.equal(mostQuiet(30, true), 5000);
});
