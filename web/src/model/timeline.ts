// SPDX-License-Identifier: Apache-2.0
// The data of the timeline, reduced to at most one column per pixel.
import type { FrameReport, TargetReport, Verdict } from '../api/types';
import { percent, unknownText } from './format';
import { verdictOf } from './labels';

export interface Track {
  readonly name: string;
  /** One per frame; null: the frame does not report this target. */
  readonly samples: readonly (TargetReport | null)[];
}

/** Equal neighbours: from <= index < to. */
export interface Run<T> {
  readonly from: number;
  readonly to: number;
  readonly value: T;
}

/** Returns one track per target, in the order in which the targets first appear. */
export function tracksOf(frames: readonly FrameReport[]): Track[] {
  const byName = new Map<string, (TargetReport | null)[]>();
  frames.forEach((frame, index) => {
    for (const target of frame.targets) {
      let samples = byName.get(target.name);
      if (!samples) {
        samples = new Array<TargetReport | null>(frames.length).fill(null);
        byName.set(target.name, samples);
      }
      samples[index] = target;
    }
  });
  return [...byName].map(([name, samples]) => ({ name, samples }));
}

export const countOf = (
  samples: readonly (Pick<TargetReport, 'verdict'> | null)[],
  verdict: Verdict,
): number => samples.filter((sample) => sample && verdictOf(sample) === verdict).length;

/** Returns the fraction that is hidden, by the robot or by other objects; null if not known. */
export const hiddenFraction = (target: TargetReport): number | null =>
  target.occluded_fraction === null
    ? null
    : target.occluded_fraction + (target.hidden_by_other_fraction ?? 0);

/** Returns the sample with the largest hidden fraction, or null if none is known. */
export function mostHidden(samples: readonly (TargetReport | null)[]): TargetReport | null {
  const fractionOf = (sample: TargetReport | null): number =>
    (sample && hiddenFraction(sample)) ?? -1;
  return samples.reduce((a, b) => (fractionOf(b) > fractionOf(a) ? b : a), null);
}

const minFraction = 0.005; // smaller ones round to 0 %

/** Returns the links that hide a target, and "others" for other objects; the largest part first. */
export const hidersOf = (target: TargetReport): string[] =>
  [...(target.blame ?? []), { link: 'others', fraction: target.hidden_by_other_fraction ?? 0 }]
    .filter(({ fraction }) => fraction >= minFraction)
    .sort((a, b) => b.fraction - a.fraction)
    .map(({ link }) => link);

/**
 * Returns how much of a target is hidden, and by what: "37 % behind wrist, others"; for an unknown
 * target the known part: "at least 57 % behind link2".
 */
export function hiddenText(target: TargetReport): string {
  const fraction = (target.inside ?? 0) > 0 ? hiddenFraction(target) : null;
  const isUnknown = verdictOf(target) === 'unknown';
  if (fraction === null || (isUnknown && fraction < minFraction)) return unknownText;
  const hiders = hidersOf(target);
  const behind = hiders.length > 0 ? ` behind ${hiders.join(', ')}` : '';
  return `${isUnknown ? 'at least ' : ''}${percent(fraction, 0)}${behind}`;
}

const severities = ['visible', 'held', 'out_of_view', null, 'partial', 'unknown', 'hidden'];
const severityOf = (target: TargetReport | null): number =>
  severities.indexOf(target && verdictOf(target));

/** Returns the worse of two samples: a pixel of several frames is visible only if all of them are. */
export function worse(a: TargetReport | null, b: TargetReport | null): TargetReport | null {
  const difference = severityOf(b) - severityOf(a);
  if (difference !== 0) return difference > 0 ? b : a;
  return b && (hiddenFraction(b) ?? 0) > ((a && hiddenFraction(a)) ?? 0) ? b : a;
}

/** Joins neighbours until at most `columns` values are left. */
export function condense<T>(
  values: readonly T[],
  columns: number,
  join: (a: T, b: T) => T,
): readonly T[] {
  if (values.length <= columns || columns < 1) return values;
  const start = (column: number): number => Math.floor((column * values.length) / columns);
  return Array.from({ length: columns }, (_, column) =>
    values.slice(start(column), start(column + 1)).reduce(join),
  );
}

/** Returns the larger one of two values; null is an unknown value. */
export const larger = (a: number | null, b: number | null): number | null =>
  a === null || (b !== null && b > a) ? b : a;

export function runsOf<T>(values: readonly T[]): Run<T>[] {
  const runs: Run<T>[] = [];
  values.forEach((value, index) => {
    const last = runs.at(-1);
    if (last && last.value === value) runs[runs.length - 1] = { ...last, to: index + 1 };
    else runs.push({ from: index, to: index + 1, value });
  });
  return runs;
}

/** Returns the seconds since the first stamp, or null for a frame without a stamp. */
export function secondsOf(frames: readonly FrameReport[]): (number | null)[] {
  const start = BigInt(frames.find((frame) => frame.stamp_ns !== null)?.stamp_ns ?? 0);
  return frames.map(({ stamp_ns }) =>
    stamp_ns === null ? null : Number(BigInt(stamp_ns) - start) / 1e9,
  );
}

const isOccluded = (track: Track, frame: number): boolean =>
  ['partial', 'hidden'].includes(track.samples[frame]?.verdict ?? '');

/** Returns the frames where an occlusion starts: partial or hidden, after a frame that is neither. */
export function onsets(tracks: readonly Track[]): number[] {
  const found = new Set<number>();
  for (const track of tracks)
    track.samples.forEach((_, frame) => {
      if (isOccluded(track, frame) && !isOccluded(track, frame - 1)) found.add(frame);
    });
  return [...found].sort((a, b) => a - b);
}

/** Returns the nearest onset after (direction 1) or before (-1) a frame, or undefined. */
export const nextOnset = (
  tracks: readonly Track[],
  frame: number,
  direction: 1 | -1,
): number | undefined =>
  direction === 1
    ? onsets(tracks).find((onset) => onset > frame)
    : onsets(tracks).findLast((onset) => onset < frame);

const secondsWithoutStamps = 0.1;
const maxWait = 1; // seconds: gaps of a recording are shortened

/** Returns the seconds between a frame and the next one during playback. */
export function waitOf(times: readonly (number | null)[], frame: number, speed: number): number {
  const [now, next] = [times[frame] ?? null, times[frame + 1] ?? null];
  const isKnown = now !== null && next !== null && next > now;
  return Math.min((isKnown ? next - now : secondsWithoutStamps) / speed, maxWait);
}
