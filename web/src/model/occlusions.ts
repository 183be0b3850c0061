// SPDX-License-Identifier: Apache-2.0
import type { Track } from './timeline';

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

/** The nearest onset after (direction 1) or before (-1) a frame; null: there is none. */
export function nextOnset(
  tracks: readonly Track[],
  frame: number,
  direction: 1 | -1,
): number | null {
  const all = onsets(tracks);
  const found =
    direction === 1 ? all.find((onset) => onset > frame) : all.findLast((onset) => onset < frame);
  return found ?? null;
}
