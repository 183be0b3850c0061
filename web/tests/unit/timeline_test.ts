// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  condense,
  graver,
  hiddenShare,
  hiddenWords,
  hiderOf,
  largest,
  nextOnset,
  onsets,
  runsOf,
  sampleOf,
  secondsOf,
  tracksOf,
  type Sample,
} from '../../src/model/timeline';
import { frame, framesOf, target } from './support';

test('tracks come in order of appearance, with gaps where a target is not told of', () => {
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

test('the blame is the link that hides most', () => {
  const blame = [
    { link: 'wrist', fraction: 0.2 },
    { link: 'forearm', fraction: 0.5 },
  ];
  assert.equal(sampleOf(target('cup', 'hidden', { blame })).blame, 'forearm');
  assert.equal(sampleOf(target('cup', 'visible')).blame, null);
  assert.equal(sampleOf(target('cup', 'unknown', { blame: null })).blame, null);
});

test('a verdict that is not known is unknown', () => {
  const later = { ...target('cup', 'visible'), verdict: 'shiny' } as unknown as ReturnType<
    typeof target
  >;
  assert.equal(sampleOf(later).verdict, 'unknown');
});

test('condensing loses no hidden frame', () => {
  const frames = framesOf({ cup: 'v'.repeat(1000) });
  frames[617] = frame(617, [target('cup', 'hidden')]);
  const samples = tracksOf(frames)[0]?.samples ?? [];
  for (const columns of [1, 7, 100, 999]) {
    const columnsMade = condense(samples, columns, graver);
    assert.equal(columnsMade.length, columns);
    const hidden = columnsMade.flatMap((sample, at) => (sample?.verdict === 'hidden' ? [at] : []));
    assert.deepEqual(hidden.length, 1);
    assert.ok(Math.abs((hidden[0] as number) - (617 * columns) / 1000) <= 1);
  }
  assert.equal(condense(samples, 2000, graver).length, 1000);
});

test('a pixel is visible where all of its frames are', () => {
  const [track] = tracksOf(framesOf({ cup: 'vo.puh' }));
  const samples = track?.samples ?? [];
  const order = [...samples]; // each one graver than those before it
  for (const [i, less] of order.entries())
    for (const more of order.slice(i)) {
      assert.equal(graver(less ?? null, more ?? null), more);
      assert.equal(graver(more ?? null, less ?? null), more);
    }
  const seldom = tracksOf(framesOf({ cup: 'vv.vovpvvu' }))[0]?.samples ?? [];
  assert.deepEqual(
    condense(seldom, 5, graver).map((sample) => sample?.verdict ?? null),
    ['visible', null, 'out_of_view', 'partial', 'unknown'],
  );
});

test('of two that are hidden the one that is hidden more, by whomever', () => {
  const by = (occluded: number, other: number): Sample =>
    sampleOf(
      target('cup', 'partial', { occluded_fraction: occluded, hidden_by_other_fraction: other }),
    );
  assert.equal(graver(by(0.2, 0), by(0, 0.5))?.other, 0.5);
  assert.equal(hiderOf(by(0, 0.5)), 'others');
  assert.equal(hiddenShare(by(0.25, 0.5)), 0.75);
});

test('what hides a target is in words, of an unknown one at least', () => {
  const blame = [
    { link: 'link1', fraction: 0.1 },
    { link: 'link2', fraction: 0.47 },
    { link: 'link3', fraction: 0.001 },
  ];
  const more = { blame, occluded_fraction: 0.571, hidden_by_other_fraction: 0.2 };
  assert.equal(hiddenWords(target('cup', 'partial', more)), '77 % behind link2, others, link1');
  assert.equal(
    hiddenWords(target('cup', 'unknown', { ...more, hidden_by_other_fraction: null })),
    'at least 57 % behind link2, link1',
  );
  assert.equal(hiddenWords(target('cup', 'visible')), '0 %');
  assert.equal(hiddenWords(target('cup', 'unknown')), '–', 'nothing is known');
  assert.equal(hiddenWords(target('cup', 'out_of_view', { inside: 0 })), '–');
});

test('runs cover all', () => {
  assert.deepEqual(runsOf(['a', 'a', 'b', 'a']), [
    { from: 0, to: 2, value: 'a' },
    { from: 2, to: 3, value: 'b' },
    { from: 3, to: 4, value: 'a' },
  ]);
  assert.deepEqual(runsOf([]), []);
});

test('seconds count from the first stamp', () => {
  const frames = framesOf({ cup: 'vvv' });
  frames[1] = { ...(frames[1] as (typeof frames)[number]), stamp_ns: null };
  assert.deepEqual(secondsOf(frames), [0, null, 0.2]);
});

test('an onset is the first frame of an occlusion, of any target', () => {
  const tracks = tracksOf(framesOf({ cup: 'vvphhvvuh', wrist: 'pvvvvvpuv' }));
  assert.deepEqual(onsets(tracks), [0, 2, 6, 8]);
});

test('jumps go to the nearest onset and end at the last', () => {
  const tracks = tracksOf(framesOf({ cup: 'vvphhvvuh' }));
  assert.equal(nextOnset(tracks, 0, 1), 2);
  assert.equal(nextOnset(tracks, 2, 1), 8);
  assert.equal(nextOnset(tracks, 8, 1), undefined);
  assert.equal(nextOnset(tracks, 8, -1), 2);
  assert.equal(nextOnset(tracks, 2, -1), undefined);
  assert.equal(nextOnset([], 0, 1), undefined);
});

test('the largest of hours of frames', () => {
  const values: (number | null)[] = new Array<number>(300_000).fill(1);
  values[1234] = 7;
  values[99] = null;
  assert.equal(largest(values), 7);
  assert.equal(largest([null]), null);
  assert.equal(largest([-2, null, -1]), -1);
});
