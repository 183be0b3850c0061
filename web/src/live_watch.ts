// SPDX-License-Identifier: Apache-2.0
// Says whether frames still come. While none do, asks the server what is amiss.
import { fetchSession } from './api/client';
import type { LiveState, Session } from './api/types';
import { mostQuiet, waited } from './model/quiet';
import {
  showLost,
  showPaused,
  showQuiet,
  showRate,
  showTold,
  showUndrawable,
  showWaiting,
} from './view/live_status';

const lookMilliseconds = 250;
const pollMilliseconds = 1000;
const answerMilliseconds = 3000;

export interface WatchHandlers {
  /** What the server says while no frame comes; the fault of the last one, where it cannot be drawn. */
  told(session: Session, fault: string | null): void;
  /** It answers again, after it did not. */
  back(): void;
}

export class LiveWatch {
  private hasFrames = false;
  private paused = false;
  private lost = false; // no connection: that is told
  private drawing = false;
  private since = performance.now(); // the last frame
  private mayBeOld = true; // the next frame: the server keeps the newest for whoever asks for it
  private rate = 0;
  private fault: string | null = null;
  private polledAt = -Infinity;
  private polling = false;
  private silent = false; // the server did not answer the last question

  constructor(private readonly handlers: WatchHandlers) {
    showWaiting(false);
    window.setInterval(() => this.look(), lookMilliseconds);
    // A page that is not seen draws nothing and wants no frames.
    document.addEventListener('visibilitychange', () => this.begin());
  }

  connected(): void {
    this.lost = false;
    this.begin();
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
    this.begin();
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
    this.fault = null;
    this.rate = live.rate_hz;
    this.since = performance.now();
    if (this.mayBeOld) this.since -= waited(live.age_ms, milliseconds);
    this.mayBeOld = false;
    const isOfNow = performance.now() - this.since <= mostQuiet(this.rate, false);
    showTold(live.missing, live.diagnostics);
    showRate(live, milliseconds, isOfNow && !this.paused && !this.lost);
    if (!isOfNow) this.showAmiss();
  }

  /** A frame came that cannot be drawn. */
  failed(fault: string): void {
    this.fault = fault;
    showTold([], [{ level: 'error', message: fault }], true);
    this.look();
  }

  /** Of arrived(), whether the frame could be drawn or not. */
  ended(): void {
    this.drawing = false;
  }

  /** Anew: from now on frames are waited for. */
  private begin(): void {
    this.since = performance.now();
    this.mayBeOld = true;
  }

  private look(): void {
    if (document.hidden || this.paused) return;
    const quiet = performance.now() - this.since;
    if (this.hasFrames && quiet <= mostQuiet(this.rate, this.drawing)) return;
    this.showAmiss();
    if (!this.polling && performance.now() - this.polledAt > pollMilliseconds) void this.poll();
  }

  private showAmiss(): void {
    if (this.lost || this.paused) return;
    if (this.fault) showUndrawable();
    else if (this.hasFrames) showQuiet(Math.floor((performance.now() - this.since) / 1000));
  }

  private async poll(): Promise<void> {
    this.polling = true;
    try {
      const session = await fetchSession(AbortSignal.timeout(answerMilliseconds));
      if (this.silent) this.handlers.back();
      this.silent = false;
      this.handlers.told(session, this.fault);
    } catch (error) {
      this.silent = true;
      showTold([error instanceof Error ? error.message : String(error)], [], true);
    }
    this.polledAt = performance.now();
    this.polling = false;
  }
}
