// SPDX-License-Identifier: Apache-2.0

/** Calls a function at once, then at most once per interval; the last request is never lost. */
export class Throttle {
  private calledAt = -Infinity;
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly milliseconds: number,
    private readonly call: () => void,
  ) {}

  request(): void {
    const wait = this.calledAt + this.milliseconds - performance.now();
    if (wait <= 0) this.run();
    else this.timer ??= setTimeout(() => this.run(), wait);
  }

  private run(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
    this.calledAt = performance.now();
    this.call();
  }
}
