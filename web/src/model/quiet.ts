// SPDX-License-Identifier: Apache-2.0

const shortest = 1000; // milliseconds
const longest = 30_000; // after a pause the last interval says little of the next one
const periods = 2.5; // of a camera that is slow by itself
const longestDrawing = 5000; // milliseconds: a large robot takes that long to be drawn first
const longestAge = 7 * 86_400_000; // milliseconds: older stamps are of another clock, or of a bag

/**
 * Milliseconds without a frame after which that is told.
 * @param rate frames in a second, as the server told it last; 0: not known
 * @param drawing a frame has come and is being drawn
 */
export function mostQuiet(rate: number, drawing: boolean): number {
  const slow = rate > 0 ? Math.min((1000 * periods) / rate, longest) : shortest;
  const limit = Math.max(shortest, slow);
  return drawing ? Math.max(limit, longestDrawing) : limit;
}

/**
 * Milliseconds since a frame that may have waited at the server: the first one of a connection, or
 * after a pause. 0 where its stamp cannot be of this clock.
 * @param age from its stamp until it was sent
 * @param drawing from its arrival until it was on the screen; long where the page was not looked at
 */
export function waited(age: number, drawing: number): number {
  const all = age + (drawing > longestDrawing ? drawing : 0);
  return all > 0 && all < longestAge ? all : 0;
}
