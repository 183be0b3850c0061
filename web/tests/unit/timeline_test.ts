// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { FrameReport, TargetReport, Verdict } from '../../src/api/types';
import { verdictOf } from '../../src/model/labels';
import {
  condense,
  hiddenFraction,
  hiddenText,
  hidersOf,
  onsets,
  secondsOf,
  tracksOf,
  worse,
} from '../../src/model/timeline';

function target(name: string, verdict: Verdict, more: Partial<TargetReport> = {}): TargetReport {
  return {
    name,
    covered: 10,
    inside: 10,
    occluded_fraction: 0,
    front_fraction: 0,
    clear_fraction: 1,
    unknown_fraction: 0,
    hidden_by_other_fraction: 0,
    verdict,
    blame: [],
    point: null,
    point_pixels: null,
    point_spread_m: null,
    handled: null,
    ...more,
  };
}

function frame(index: number, targets: readonly TargetReport[]): FrameReport {
  return {
    index,
    stamp_ns: String(1_700_000_000_000_000_000n + BigInt(index) * 100_000_000n),
    joint_age_ms: 0,
    status: 'ok',
    pixels: {},
    timing_ms: {},
    targets,
  };
}

const letters: Readonly<Record<string, Verdict>> = {
  v: 'visible',
  p: 'partial',
  h: 'hidden',
  u: 'unknown',
  o: 'out_of_view',
  c: 'held',
};

/** Returns one frame per letter; a dot: the target is not in the frame. */
const framesOf = (tracks: Readonly<Record<string, string>>): FrameReport[] => {
  const length = Math.max(...Object.values(tracks).map((letters_) => letters_.length));
  return Array.from({ length }, (_, index) => {
    const targets = Object.entries(tracks).flatMap(([name, text]) => {
      const verdict = letters[text[index] ?? '.'];
      return verdict ? [target(name, verdict)] : [];
    });
    return frame(index, targets);
  });
};

test('tracks are in order of appearance, with gaps in frames without the target', () => {
  const tracks = tracksOf(framesOf({ cup: 'vv.h', wrist: '.p.v' }));
  assert.deepEqual(
    tracks.map((track) => track.name),
    ['cup', 'wrist'],
  );
  assert.deepEqual(
    tracks[0]?.samples.map((sample) => sample?.verdict ?? null),
    ['visible', 'visible', null, 'hidden'],
  );
  assert.equal(tracks[1]?.samples[0], null);
});

test('an unknown verdict name is unknown', () => {
  const target_ = { ...target('cup', 'visible'), verdict: 'shiny' } as unknown as TargetReport;
  assert.equal(verdictOf(target_), 'unknown');
});

test('condensing keeps hidden frames', () => {
  const frames = framesOf({ cup: 'v'.repeat(1000) });
  frames[617] = frame(617, [target('cup', 'hidden')]);
  const samples = tracksOf(frames)[0]?.samples ?? [];
  for (const columns of [1, 7, 100, 999]) {
    const columnsMade = condense(samples, columns, worse);
    assert.equal(columnsMade.length, columns);
    const hidden = columnsMade.flatMap((sample, at) => (sample?.verdict === 'hidden' ? [at] : []));
    assert.deepEqual(hidden.length, 1);
    assert.ok(Math.abs((hidden[0] as number) - (617 * columns) / 1000) <= 1);
  }
  assert.equal(condense(samples, 2000, worse).length, 1000);
});

test('a pixel is visible only if all of its frames are', () => {
  const [track] = tracksOf(framesOf({ cup: 'vco.puh' }));
  const samples = track?.samples ?? [];
  const order = [...samples]; // from best to worst
  for (const [i, less] of order.entries())
    for (const more of order.slice(i)) {
      assert.equal(worse(less ?? null, more ?? null), more);
      assert.equal(worse(more ?? null, less ?? null), more);
    }
  const seldom = tracksOf(framesOf({ cup: 'vv.vovpvvu' }))[0]?.samples ?? [];
  assert.deepEqual(
    condense(seldom, 5, worse).map((sample) => sample?.verdict ?? null),
    ['visible', null, 'out_of_view', 'partial', 'unknown'],
  );
});

test('of two hidden samples the worse one is hidden more, by the robot or by others', () => {
  const by = (occluded: number, other: number): TargetReport =>
    target('cup', 'partial', { occluded_fraction: occluded, hidden_by_other_fraction: other });
  assert.equal(worse(by(0.2, 0), by(0, 0.5))?.hidden_by_other_fraction, 0.5);
  assert.deepEqual(hidersOf(by(0, 0.5)), ['others']);
  assert.equal(hiddenFraction(by(0.25, 0.5)), 0.75);
});

test('the text of what hides a target; for an unknown one the known part', () => {
  const blame = [
    { link: 'link1', fraction: 0.1 },
    { link: 'link2', fraction: 0.47 },
    { link: 'link3', fraction: 0.001 },
  ];
  const more = { blame, occluded_fraction: 0.571, hidden_by_other_fraction: 0.2 };
  assert.equal(hiddenText(target('cup', 'partial', more)), '77 % behind link2, others, link1');
  assert.equal(
    hiddenText(target('cup', 'unknown', { ...more, hidden_by_other_fraction: null })),
    'at least 57 % behind link2, link1',
  );
  assert.equal(hiddenText(target('cup', 'visible')), '0 %');
  assert.equal(hiddenText(target('cup', 'unknown')), '–', 'no known part');
  assert.equal(hiddenText(target('cup', 'out_of_view', { inside: 0 })), '–');
});

test('seconds since the first stamp', () => {
  const frames = framesOf({ cup: 'vvv' });
  frames[1] = { ...(frames[1] as (typeof frames)[number]), stamp_ns: null };
  assert.deepEqual(secondsOf(frames), [0, null, 0.2]);
});

test('onsets of all targets', () => {
  const tracks = tracksOf(framesOf({ cup: 'vvphhvvuh', wrist: 'pvvvvvpuv' }));
  assert.deepEqual(onsets(tracks), [0, 2, 6, 8]);
});
