// SPDX-License-Identifier: Apache-2.0

const span = 2000; // milliseconds

/** Frames in a second, of the last two seconds; where they are rarer, of the last two frames. */
export class RateMeter {
  private readonly times: number[] = [];

  /**
   * @param now milliseconds
   * @returns 0 after the first frame: not known yet
   */
  count(now: number): number {
    this.times.push(now);
    while (this.times.length > 2 && now - (this.times[0] ?? now) > span) this.times.shift();
    const first = this.times[0] ?? now;
    return first < now ? (1000 * (this.times.length - 1)) / (now - first) : 0;
  }
}
