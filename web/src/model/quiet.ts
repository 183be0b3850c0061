// SPDX-License-Identifier: Apache-2.0

const shortest = 1000; // milliseconds
const periods = 2.5; // of a camera that is slow by itself
const longestDrawing = 5000; // milliseconds: a large robot takes that long to be drawn first

/**
 * Milliseconds without a frame after which that is told.
 * @param rate frames in a second, as the server told it last; 0: not known
 * @param drawing a frame has come and is being drawn
 */
export function mostQuiet(rate: number, drawing: boolean): number {
  const limit = rate > 0 ? Math.max(shortest, (1000 * periods) / rate) : shortest;
  return drawing ? Math.max(limit, longestDrawing) : limit;
}
