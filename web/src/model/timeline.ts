// SPDX-License-Identifier: Apache-2.0
// What the timeline shows of the frames: pure data, at most one column for each pixel.
import type { FrameReport, Source, TargetReport, Verdict } from '../api/types';
import { nothing, percent } from './format';
import { verdictOf } from './labels';

export interface Sample {
  readonly verdict: Verdict;
  /** Fractions of the target; null: not known. */
  readonly occluded: number | null;
  readonly other: number | null;
  readonly unknown: number | null;
  /** The link that hides most of it. */
  readonly blame: string | null;
  readonly source: Source | null;
}

export interface Track {
  readonly name: string;
  /** One for each frame; null: the frame says nothing of this target. */
  readonly samples: readonly (Sample | null)[];
}

export interface Run<T> {
  readonly from: number;
  /** One beyond the last. */
  readonly to: number;
  readonly value: T;
}

export function sampleOf(target: TargetReport): Sample {
  const [blame] = [...(target.blame ?? [])].sort((a, b) => b.fraction - a.fraction);
  return {
    verdict: verdictOf(target.verdict),
    occluded: target.occluded_fraction,
    other: target.hidden_by_other_fraction,
    unknown: target.unknown_fraction,
    blame: blame?.link ?? null,
    source: target.handled?.source ?? null,
  };
}

/** Tracks in the order in which their targets first appear. */
export function tracksOf(frames: readonly FrameReport[]): Track[] {
  const byName = new Map<string, (Sample | null)[]>();
  frames.forEach((frame, index) => {
    for (const target of frame.targets) {
      let samples = byName.get(target.name);
      if (!samples) {
        samples = new Array<Sample | null>(frames.length).fill(null);
        byName.set(target.name, samples);
      }
      samples[index] = sampleOf(target);
    }
  });
  return [...byName].map(([name, samples]) => ({ name, samples }));
}

/** By the robot and by others; null: not known. */
export const hiddenShare = ({
  occluded,
  other,
}: Pick<Sample, 'occluded' | 'other'>): number | null =>
  occluded === null ? null : occluded + (other ?? 0);

/** Who hides most of it: a link, or others than the robot; empty: not known. */
export const hiderOf = ({ occluded, other, blame }: Sample): string =>
  (other ?? 0) > (occluded ?? 0) ? 'others' : (blame ?? '');

const leastShare = 0.005; // smaller ones round to 0 %

/**
 * How much of a target is hidden, and behind what: "37 % behind wrist, others". Of an unknown target
 * it is what is known: "at least 57 % behind link2".
 */
export function hiddenWords(target: TargetReport): string {
  const { occluded_fraction: occluded, hidden_by_other_fraction: other } = target;
  const share = (target.inside ?? 0) > 0 ? hiddenShare({ occluded, other }) : null;
  const isUnknown = verdictOf(target.verdict) === 'unknown';
  if (share === null || (isUnknown && share < leastShare)) return nothing;
  const hiders = [...(target.blame ?? []), { link: 'others', fraction: other ?? 0 }]
    .filter(({ fraction }) => fraction >= leastShare)
    .sort((a, b) => b.fraction - a.fraction)
    .map(({ link }) => link);
  const behind = hiders.length > 0 ? ` behind ${hiders.join(', ')}` : '';
  return `${isUnknown ? 'at least ' : ''}${percent(share, 0)}${behind}`;
}

const gravity: Readonly<Record<Verdict | 'none', number>> = {
  visible: 0,
  out_of_view: 1,
  none: 2, // the frame says nothing of it
  partial: 3,
  unknown: 4,
  hidden: 5,
};
const gravityOf = (sample: Sample | null): number => gravity[sample?.verdict ?? 'none'];

/**
 * The graver of two: where several frames share a pixel, none that is hidden gets lost, and the pixel
 * says visible only where all of them do.
 */
export function graver(a: Sample | null, b: Sample | null): Sample | null {
  const difference = gravityOf(b) - gravityOf(a);
  if (difference !== 0) return difference > 0 ? b : a;
  return b && (hiddenShare(b) ?? 0) > ((a && hiddenShare(a)) ?? 0) ? b : a;
}

/** Joins neighbours until at most `columns` are left. */
export function condense<T>(
  values: readonly T[],
  columns: number,
  join: (a: T, b: T) => T,
): readonly T[] {
  if (values.length <= columns || columns < 1) return values;
  const result: T[] = [];
  for (let column = 0; column < columns; ++column) {
    const from = Math.floor((column * values.length) / columns);
    const to = Math.floor(((column + 1) * values.length) / columns);
    result.push(values.slice(from, to).reduce(join));
  }
  return result;
}

/** Of as many values as there may be; null: none is known. */
export function largest(values: readonly (number | null)[]): number | null {
  let most: number | null = null;
  for (const value of values) if (value !== null && (most === null || value > most)) most = value;
  return most;
}

/** Neighbours that are alike, as one run. */
export function runsOf<T>(values: readonly T[]): Run<T>[] {
  const runs: Run<T>[] = [];
  values.forEach((value, index) => {
    const last = runs.at(-1);
    if (last && last.value === value) runs[runs.length - 1] = { ...last, to: index + 1 };
    else runs.push({ from: index, to: index + 1, value });
  });
  return runs;
}

/** Seconds since the first frame that has a stamp; null: this one has none. */
export function secondsOf(frames: readonly FrameReport[]): (number | null)[] {
  const first = frames.find((frame) => frame.stamp_ns !== null)?.stamp_ns;
  if (first === undefined || first === null) return frames.map(() => null);
  const start = BigInt(first);
  return frames.map((frame) =>
    frame.stamp_ns === null ? null : Number(BigInt(frame.stamp_ns) - start) / 1e9,
  );
}

const isOccluded = (track: Track, frame: number): boolean => {
  const verdict = track.samples[frame]?.verdict;
  return verdict === 'partial' || verdict === 'hidden';
};

/** Frames in which an occlusion begins: partial or hidden, and neither in the frame before. */
export function onsets(tracks: readonly Track[]): number[] {
  const found = new Set<number>();
  for (const track of tracks)
    track.samples.forEach((_, frame) => {
      if (isOccluded(track, frame) && (frame === 0 || !isOccluded(track, frame - 1)))
        found.add(frame);
    });
  return [...found].sort((a, b) => a - b);
}

/** The nearest onset after (direction 1) or before (-1) a frame; undefined: there is none. */
export function nextOnset(
  tracks: readonly Track[],
  frame: number,
  direction: 1 | -1,
): number | undefined {
  const all = onsets(tracks);
  return direction === 1
    ? all.find((onset) => onset > frame)
    : all.findLast((onset) => onset < frame);
}
