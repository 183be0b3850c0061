// SPDX-License-Identifier: Apache-2.0

export const speeds = [0.25, 0.5, 1, 2, 4] as const;
const secondsWithoutStamps = 0.1;
const longestWait = 1; // seconds: a gap in a recording is not waited for

/**
 * Seconds to wait before the next frame at a speed.
 * @param seconds the frames' times; null: without stamp
 */
export function waitOf(seconds: readonly (number | null)[], frame: number, speed: number): number {
  const now = seconds[frame];
  const next = seconds[frame + 1];
  const step =
    now === null || next === null || now === undefined || next === undefined || next <= now
      ? secondsWithoutStamps
      : next - now;
  return Math.min(step / speed, longestWait);
}

/** Plays frame after frame; each is shown before the next one's time begins to count. */
export class Player {
  playing = false;
  speed = 1;
  private run = 0;

  constructor(
    private readonly times: () => readonly (number | null)[],
    private readonly current: () => number,
    private readonly show: (frame: number) => Promise<void>,
    private readonly changed: () => void,
  ) {}

  toggle(): void {
    if (this.playing) this.pause();
    else void this.play();
  }

  pause(): void {
    ++this.run;
    if (!this.playing) return;
    this.playing = false;
    this.changed();
  }

  private async play(): Promise<void> {
    const run = ++this.run;
    this.playing = true;
    this.changed();
    if (this.current() >= this.times().length - 1) await this.show(0);
    while (run === this.run && this.current() < this.times().length - 1) {
      const due = performance.now() + 1000 * waitOf(this.times(), this.current(), this.speed);
      await new Promise((resolve) => window.setTimeout(resolve, due - performance.now()));
      if (run === this.run) await this.show(this.current() + 1);
    }
    if (run === this.run) this.pause();
  }
}
