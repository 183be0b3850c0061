// SPDX-License-Identifier: Apache-2.0
// Says whether what the live page shows is of now. While no frames come, asks the server why.
import { fetchSession } from './api/client';
import type { Diagnostic, LiveState as LiveNumbers, Session } from './api/types';
import { showMode, showNotes } from './view/page';

const lookMilliseconds = 250;
const pollMilliseconds = 1000;
const answerMilliseconds = 3000;

const shortestQuiet = 1000; // milliseconds
const longestQuiet = 30_000; // after a pause the last interval says little of the next one
const periods = 2.5; // of a camera that is slow by itself
const longestDrawing = 5000; // milliseconds: a large robot takes that long to be drawn first
const longestAge = 7 * 86_400_000; // milliseconds: older stamps are of another clock, or of a bag

/**
 * Milliseconds without a frame after which that is told.
 * @param rate frames in a second, as the server told it last; 0: not known
 * @param drawing a frame has come and is being drawn
 */
export function mostQuiet(rate: number, drawing: boolean): number {
  const slow = rate > 0 ? Math.min((1000 * periods) / rate, longestQuiet) : shortestQuiet;
  const limit = Math.max(shortestQuiet, slow);
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

const hertz = (rate: number): string => rate.toFixed(rate < 1 ? 1 : 0);

interface Words {
  readonly text: string;
  /** The same without numbers that change with every frame. */
  readonly said?: string;
  readonly isFault?: boolean;
  /** What is shown is not of now; without it faults are. */
  readonly isStale?: boolean;
}

export interface LiveHandlers {
  /** What the server says while no frame comes; the fault of the last one, where it cannot be drawn. */
  told(session: Session, fault: string | null): void;
  /** It answers again, after it did not. */
  back(): void;
}

export class LiveState {
  private isDrawing = false;
  private hasFrames = false;
  private isPaused = false;
  private retry: number | null = null; // seconds until the next attempt to connect
  private fault: string | null = null; // of the last frame
  private live: { readonly numbers: LiveNumbers; readonly lag: number } | null = null; // since begin()
  private rate = 0;
  private dropped = 0;
  private since = performance.now(); // the last frame
  private isPolling = false;
  private polledAt = -Infinity;
  private isSilent = false; // the server did not answer the last question

  constructor(private readonly handlers: LiveHandlers) {
    this.show();
    window.setInterval(() => this.look(), lookMilliseconds);
    // A page that is not seen draws nothing and wants no frames.
    document.addEventListener('visibilitychange', () => this.begin());
  }

  connected(): void {
    this.retry = null;
    this.begin();
  }

  disconnected(seconds: number): void {
    this.retry = seconds;
    this.show();
  }

  setPaused(paused: boolean): void {
    this.isPaused = paused;
    this.begin();
  }

  arrived(): void {
    this.isDrawing = true;
  }

  /** @param milliseconds from the frame's arrival until it was on the screen */
  drawn(numbers: LiveNumbers, milliseconds: number): void {
    const mayBeOld = this.live === null; // the server keeps the newest for whoever asks for it
    this.since = performance.now() - (mayBeOld ? waited(numbers.age_ms, milliseconds) : 0);
    this.live = { numbers, lag: numbers.age_ms + milliseconds };
    this.hasFrames = true;
    this.fault = null;
    this.rate = numbers.rate_hz;
    this.dropped += numbers.dropped;
    showTold(numbers.missing, numbers.diagnostics);
    this.show();
  }

  /** A frame came that cannot be drawn. */
  failed(fault: string): void {
    this.fault = fault;
    showTold([], [{ level: 'error', message: fault }], true);
    this.look();
  }

  /** Of arrived(), whether the frame could be drawn or not. */
  ended(): void {
    this.isDrawing = false;
  }

  /** Anew: from now on frames are waited for. */
  private begin(): void {
    this.since = performance.now();
    this.live = null;
    this.show();
  }

  private get isQuiet(): boolean {
    const quiet = performance.now() - this.since;
    return !this.hasFrames || quiet > mostQuiet(this.rate, this.isDrawing);
  }

  private look(): void {
    if (document.hidden || this.isPaused || !this.isQuiet) return;
    this.show();
    if (!this.isPolling && performance.now() - this.polledAt > pollMilliseconds) void this.poll();
  }

  private show(): void {
    const { text, said, isFault, isStale } = this.words();
    document.documentElement.classList.toggle('stale', isStale ?? isFault ?? false);
    showMode(text, said ?? text, isFault);
  }

  private words(): Words {
    if (this.retry !== null) {
      const said = 'no connection: trying again';
      return { text: `${said} in ${this.retry.toFixed(0) || 1} s`, said, isFault: true };
    }
    if (this.isPaused) return { text: 'paused: this is not live' };
    if (this.fault) return { text: 'frames come that cannot be drawn', isFault: true };
    if (this.hasFrames && this.isQuiet) {
      const seconds = Math.floor((performance.now() - this.since) / 1000);
      return { text: `no new frame for ${seconds} s`, said: 'no new frame', isFault: true };
    }
    if (!this.live) return { text: 'waiting for a frame', isStale: this.hasFrames };
    const { numbers, lag } = this.live;
    const rate = `${hertz(numbers.rate_hz)} Hz · lag ${lag.toFixed(0)} ms`;
    return { text: `live · ${rate} · ${this.dropped} dropped`, said: 'live' };
  }

  private async poll(): Promise<void> {
    this.isPolling = true;
    try {
      const session = await fetchSession(AbortSignal.timeout(answerMilliseconds));
      if (this.isSilent) this.handlers.back();
      this.isSilent = false;
      this.handlers.told(session, this.fault);
    } catch (error) {
      this.isSilent = true;
      showTold([error instanceof Error ? error.message : String(error)], [], true);
    }
    this.polledAt = performance.now();
    this.isPolling = false;
  }
}

/**
 * What is not there and what penumbra live says of itself, behind one button.
 * @param isFault no frames come: that is why
 */
export function showTold(
  missing: readonly string[],
  diagnostics: readonly Diagnostic[],
  isFault = false,
): void {
  const lines = [...missing, ...diagnostics.map(({ level, message }) => `${level}: ${message}`)];
  const wrong = diagnostics.filter(({ level }) => level !== 'ok');
  const amiss = missing.length + wrong.length;
  const title = missing.length ? 'Not there' : amiss || isFault ? 'Diagnostics' : 'All well';
  const isError = isFault || wrong.some(({ level }) => level === 'error');
  showNotes(lines, title, isError ? 'fault' : amiss ? 'warn' : 'ok', amiss || lines.length);
}
