// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mostQuiet, waited } from '../../src/live_state';
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
  assert.equal(mostQuiet(0.001, false), 30_000, 'nobody waits for ever');
});

test('a frame that waited is as old as its stamp, where that can be', () => {
  assert.equal(waited(32_000, 40), 32_000);
  assert.equal(waited(50, 90_000), 90_050, 'nobody looked at the page meanwhile');
  assert.equal(waited(50, 4000), 50, 'a large robot takes that long to be drawn first');
  assert.equal(waited(-3_600_000, 10), 0, 'a clock that is ahead');
  assert.equal(waited(1.7e12, 10), 0, 'stamps that begin at zero, or of a bag');
});
