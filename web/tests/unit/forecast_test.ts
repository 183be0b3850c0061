// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { ForecastInterval } from '../../src/api/types';
import { forecastSpans, forecastText } from '../../src/model/forecast';

type Part = readonly [
  begin: number,
  end: number,
  verdict: ForecastInterval['verdict'],
  by?: string,
];

const forecast = (...parts: readonly Part[]): ForecastInterval[] =>
  parts.map(([begin_s, end_s, verdict, by = null]) => ({
    begin_s,
    end_s,
    verdict,
    by,
    reason: verdict === 'unknown' ? 'off the plan' : null,
  }));

test('a forecast says when, behind what, and for how long', () => {
  const parts: Part[] = [
    [0, 1.3, 'visible'],
    [1.3, 2, 'hidden', 'forearm'],
  ];
  assert.equal(forecastText(forecast(...parts)), 'in 1.30 s behind forearm, for at least 0.70 s');
  parts.push([2, 2.5, 'partial', 'forearm']);
  assert.equal(forecastText(forecast(...parts)), 'in 1.30 s behind forearm, for 0.70 s');
  const now = forecastText(forecast([0, 0.5, 'hidden', 'hand'], [0.5, 1, 'visible']));
  assert.equal(now, 'now behind hand, for 0.50 s');
  assert.equal(forecastText(forecast([0, 2, 'visible'])), 'not in the next 2.00 s');
});

test('a target that may be hidden before is not called seen', () => {
  assert.equal(forecastText(forecast([0, 2, 'unknown'])), 'off the plan');
  assert.equal(forecastText(forecast([0, 1, 'unknown'], [1, 2, 'hidden'])), 'off the plan');
});

test('a forecast lies on the times of the frames to come', () => {
  const parts = forecast([0, 0.15, 'visible'], [0.15, 0.4, 'hidden']);
  assert.deepEqual(forecastSpans(parts, [10, 10.1, 10.2, 10.3], 1), [
    { from: 1.5, to: 3, verdict: 'visible' },
    { from: 3, to: 4, verdict: 'hidden' },
  ]);
  assert.deepEqual(forecastSpans(parts, [10, 10.1], 1), []);
  assert.deepEqual(forecastSpans(parts, [null, null], 0), []);
});
