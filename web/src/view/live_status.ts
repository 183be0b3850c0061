// SPDX-License-Identifier: Apache-2.0
import type { Diagnostic, LiveState } from '../api/types';
import { byId, setText } from './dom';
import { showMissing } from './missing';

const rateWindow = 2000; // milliseconds
let dropped = 0;
let shownAt: number[] = [];

/** @param isStale what the page shows is not of now */
function showState(text: string, isFault = false, isStale = isFault): void {
  const mode = byId('mode');
  mode.classList.toggle('fault', isFault);
  document.documentElement.classList.toggle('stale', isStale);
  setText(mode, text);
}

/** @param drawing milliseconds from the packet's arrival until it was on the screen */
export function showRate(live: LiveState, drawing: number): void {
  dropped += live.dropped;
  const lag = live.age_ms + drawing;
  const now = performance.now();
  shownAt = [...shownAt.filter((time) => now - time < rateWindow), now];
  const shown = (1000 * shownAt.length) / rateWindow;
  byId('mode').dataset['lag'] = lag.toFixed(0);
  showState(
    `live · ${live.rate_hz.toFixed(0)} Hz, ${shown.toFixed(0)} shown · lag ${lag.toFixed(0)} ms · ${dropped} dropped`,
  );
}

/** @param isStale what is shown is of before the connection was lost */
export const showWaiting = (isStale: boolean): void =>
  showState('waiting for a frame', false, isStale);
export const showPaused = (): void => showState('paused: this is not live');
export const showQuiet = (seconds: number): void =>
  showState(`no new frame for ${seconds} s`, true);

/** @param seconds until the next attempt to connect */
export const showLost = (seconds: number): void =>
  showState(`no connection: trying again in ${seconds.toFixed(0) || 1} s`, true);

let shown: string | null = null;

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
  const level = isError ? 'fault' : amiss ? 'warn' : 'ok';
  const key = [title, level, ...lines].join('\n');
  if (key === shown) return;
  shown = key;
  showMissing(lines, title, level, amiss || lines.length);
}
