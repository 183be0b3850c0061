// SPDX-License-Identifier: Apache-2.0
// Says whether frames still come. While none do, asks the server what is amiss.
import { fetchSession } from './api/client';
import type { LiveState, Session } from './api/types';
import { mostQuiet } from './model/quiet';
import {
  showLost,
  showPaused,
  showQuiet,
  showRate,
  showTold,
  showWaiting,
} from './view/live_status';

const lookMilliseconds = 250;
const pollMilliseconds = 1000;
const answerMilliseconds = 3000;

export interface WatchHandlers {
  /** What the server says while no frame comes. */
  told(session: Session): void;
  /** It answers again, after it did not. */
  back(): void;
}

export class LiveWatch {
  private hasFrames = false;
  private paused = false;
  private lost = false; // no connection: that is told
  private drawing = false;
  private since = performance.now(); // the last frame
  private rate = 0;
  private polledAt = -Infinity;
  private polling = false;
  private silent = false; // the server did not answer the last question

  constructor(private readonly handlers: WatchHandlers) {
    showWaiting(false);
    window.setInterval(() => this.look(), lookMilliseconds);
    // A page that is not seen draws nothing and wants no frames.
    document.addEventListener('visibilitychange', () => (this.since = performance.now()));
  }

  connected(): void {
    this.lost = false;
    this.since = performance.now();
    if (this.paused) showPaused();
    else showWaiting(this.hasFrames);
  }

  /** @param seconds until the next attempt */
  disconnected(seconds: number): void {
    this.lost = true;
    showLost(seconds);
  }

  setPaused(paused: boolean): void {
    this.paused = paused;
    this.since = performance.now();
    if (this.lost) return;
    if (paused) showPaused();
    else showWaiting(false);
  }

  arrived(): void {
    this.drawing = true;
  }

  /** @param milliseconds from the frame's arrival until it was on the screen */
  drawn(live: LiveState, milliseconds: number): void {
    this.hasFrames = true;
    this.rate = live.rate_hz;
    this.since = performance.now();
    showTold(live.missing, live.diagnostics);
    if (!this.paused && !this.lost) showRate(live, milliseconds);
  }

  /** Of arrived(), whether the frame could be drawn or not. */
  ended(): void {
    this.drawing = false;
  }

  private look(): void {
    if (document.hidden || this.paused) return;
    const quiet = performance.now() - this.since;
    const isQuiet = quiet > mostQuiet(this.rate, this.drawing);
    if (this.hasFrames && !isQuiet) return;
    if (this.hasFrames && !this.lost) showQuiet(Math.floor(quiet / 1000));
    if (!this.polling && performance.now() - this.polledAt > pollMilliseconds) void this.poll();
  }

  private async poll(): Promise<void> {
    this.polling = true;
    try {
      const session = await fetchSession(AbortSignal.timeout(answerMilliseconds));
      if (this.silent) this.handlers.back();
      this.silent = false;
      this.handlers.told(session);
    } catch (error) {
      this.silent = true;
      showTold([error instanceof Error ? error.message : String(error)], [], true);
    }
    this.polledAt = performance.now();
    this.polling = false;
  }
}
