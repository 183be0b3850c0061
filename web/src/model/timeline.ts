// SPDX-License-Identifier: Apache-2.0
// What the timeline shows of the frames: pure data, at most one column for each pixel.
import type { FrameReport, Source, TargetReport, Verdict } from '../api/types';
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

const gravity: Readonly<Record<Verdict, number>> = {
  visible: 1,
  out_of_view: 0,
  partial: 2,
  unknown: 3,
  hidden: 4,
};

/** The graver of two: where several frames share a pixel, none that is hidden gets lost. */
export function graver(a: Sample | null, b: Sample | null): Sample | null {
  if (!a || !b) return a ?? b;
  const difference = gravity[b.verdict] - gravity[a.verdict];
  if (difference !== 0) return difference > 0 ? b : a;
  return (b.occluded ?? 0) > (a.occluded ?? 0) ? b : a;
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
