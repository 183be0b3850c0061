// SPDX-License-Identifier: Apache-2.0

/** Draws at once, then no oftener than that: what is asked for in between, once its time has come. */
export class Throttle {
  private drawnAt = -Infinity;
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly milliseconds: number,
    private readonly draw: () => void,
  ) {}

  request(): void {
    const wait = this.drawnAt + this.milliseconds - performance.now();
    if (wait <= 0) this.now();
    else this.timer ??= setTimeout(() => this.now(), wait);
  }

  /** What is pending, at once. */
  flush(): void {
    if (this.timer !== null) this.now();
  }

  private now(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    this.drawnAt = performance.now();
    this.draw();
  }
}
