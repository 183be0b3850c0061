// SPDX-License-Identifier: Apache-2.0
// Shows whether the live page is up to date. While no frames come, asks the server for the reason.
import { fetchSession } from './api/client';
import type { Diagnostic, LiveStatus, Session } from './api/types';
import { showNotes, showState, type State } from './view/page';

const checkMilliseconds = 250;
const pollMilliseconds = 1000;
const answerMilliseconds = 3000;

const minSilence = 1000; // milliseconds without a frame, before the page says so
const maxSilence = 30_000; // after a pause, the rate of frames is too low
const silencePeriods = 2.5; // of a slow camera
const drawingMilliseconds = 5000; // the first drawing of a large robot
const maxAge = 7 * 86_400_000; // milliseconds; older stamps are of another clock

export interface LiveHandlers {
  /** The server's session while no frame comes; `fault` of a frame that cannot be displayed. */
  session(session: Session, fault: string | null): void;
  /** The server responds again. */
  returned(): void;
}

export class LiveState {
  private isDrawing = false;
  private hasFrames = false;
  private isPaused = false;
  private retry: number | null = null; // seconds until the next attempt to connect
  private fault: string | null = null; // of the last frame
  private lag: number | null = null; // milliseconds, of the last frame since restart()
  private dropped = 0;
  private rate = 0; // Hz; 0: not known
  private frameTime = performance.now(); // of the last frame
  private isPolling = false;
  private polledAt = -Infinity;
  private isUnreachable = false;

  constructor(private readonly handlers: LiveHandlers) {
    this.show();
    window.setInterval(() => this.check(), checkMilliseconds);
    // A hidden page requests no frames.
    document.addEventListener('visibilitychange', () => this.restart());
  }

  connected(): void {
    this.retry = null;
    this.restart();
  }

  disconnected(seconds: number): void {
    this.retry = seconds;
    this.show();
  }

  setPaused(isPaused: boolean): void {
    this.isPaused = isPaused;
    this.restart();
  }

  /** A frame arrived; drawn() or failed() follows, then finished(). */
  arrived(): void {
    this.isDrawing = true;
  }

  /** @param milliseconds from the frame's arrival until it was displayed */
  drawn(status: LiveStatus, milliseconds: number): void {
    // The first frame after a pause can be old: the server keeps the newest one. Drawing takes this long
    // only on a page that was hidden meanwhile.
    const age = status.age_ms + (milliseconds > drawingMilliseconds ? milliseconds : 0);
    const isOld = this.lag === null && age > 0 && age < maxAge;
    this.frameTime = performance.now() - (isOld ? age : 0);
    this.lag = status.age_ms + milliseconds;
    this.hasFrames = true;
    this.fault = null;
    this.rate = status.rate_hz;
    this.dropped += status.dropped;
    showDiagnostics(status.missing, status.diagnostics);
    this.show();
  }

  /** A frame cannot be displayed. */
  failed(fault: string): void {
    this.fault = fault;
    showDiagnostics([], [{ level: 'error', message: fault }], true);
    this.check();
  }

  finished(): void {
    this.isDrawing = false;
  }

  private restart(): void {
    this.frameTime = performance.now();
    this.lag = null;
    this.show();
  }

  private get isSilent(): boolean {
    const periods = this.rate > 0 ? (1000 * silencePeriods) / this.rate : 0;
    const least = this.isDrawing ? drawingMilliseconds : minSilence;
    const limit = Math.max(least, Math.min(periods, maxSilence));
    return !this.hasFrames || performance.now() - this.frameTime > limit;
  }

  private check(): void {
    if (document.hidden || this.isPaused || !this.isSilent) return;
    this.show();
    if (!this.isPolling && performance.now() - this.polledAt > pollMilliseconds) void this.poll();
  }

  private show(): void {
    const state = this.state();
    const isWaiting = this.hasFrames && !this.isPaused && this.lag === null;
    document.documentElement.classList.toggle('stale', isWaiting || !!state.isFault);
    showState(state);
  }

  private state(): State {
    if (this.retry !== null) {
      const numbers = ` in ${this.retry.toFixed(0) || 1} s`;
      return { name: 'no connection: trying again', numbers, isFault: true };
    }
    if (this.isPaused) return { name: 'paused: not live' };
    if (this.fault) return { name: 'received frames cannot be displayed', isFault: true };
    if (this.hasFrames && this.isSilent) {
      const seconds = Math.floor((performance.now() - this.frameTime) / 1000);
      return { name: 'no new frame', numbers: ` for ${seconds} s`, isFault: true };
    }
    if (this.lag === null) return { name: 'waiting for a frame' };
    const rate = this.rate.toFixed(this.rate < 1 ? 1 : 0);
    const lag = this.lag.toFixed(0);
    return { name: 'live', numbers: ` · ${rate} Hz · lag ${lag} ms · ${this.dropped} dropped` };
  }

  private async poll(): Promise<void> {
    this.isPolling = true;
    try {
      const session = await fetchSession(AbortSignal.timeout(answerMilliseconds));
      if (this.isUnreachable) this.handlers.returned();
      this.isUnreachable = false;
      this.handlers.session(session, this.fault);
    } catch (error) {
      this.isUnreachable = true;
      showDiagnostics([error instanceof Error ? error.message : String(error)], [], true);
    }
    this.polledAt = performance.now();
    this.isPolling = false;
  }
}

/**
 * Lists missing data and the diagnostics of penumbra live.
 * @param isFault no frames can be displayed, for these reasons
 */
export function showDiagnostics(
  missing: readonly string[],
  diagnostics: readonly Diagnostic[],
  isFault = false,
): void {
  const problems = diagnostics.filter(({ level }) => level !== 'ok');
  const textOf = ({ level, message }: Diagnostic): string => `${level}: ${message}`;
  if (missing.length + problems.length === 0 && !isFault)
    return showNotes({ title: 'OK', level: 'ok', lines: diagnostics.map(textOf) });
  const isError = isFault || problems.some(({ level }) => level === 'error');
  showNotes({
    title: missing.length ? 'Missing data' : 'Diagnostics',
    level: isError ? 'fault' : 'warn',
    lines: [...missing, ...problems.map(textOf)],
  });
}
