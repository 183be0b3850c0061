// SPDX-License-Identifier: Apache-2.0
import type { FrameReport, TargetReport, Verdict } from '../../src/api/types';

export function target(
  name: string,
  verdict: Verdict,
  more: Partial<TargetReport> = {},
): TargetReport {
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

export function frame(index: number, targets: readonly TargetReport[]): FrameReport {
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
export const framesOf = (tracks: Readonly<Record<string, string>>): FrameReport[] => {
  const length = Math.max(...Object.values(tracks).map((letters_) => letters_.length));
  return Array.from({ length }, (_, index) => {
    const targets = Object.entries(tracks).flatMap(([name, text]) => {
      const verdict = letters[text[index] ?? '.'];
      return verdict ? [target(name, verdict)] : [];
    });
    return frame(index, targets);
  });
};
