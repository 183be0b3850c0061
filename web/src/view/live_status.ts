// SPDX-License-Identifier: Apache-2.0
import type { Diagnostic, LiveState } from '../api/types';
import { RateMeter } from '../model/rate';
import { byId } from './dom';
import { showMissing } from './missing';
import { showMode } from './mode';

let dropped = 0;
const shownRate = new RateMeter();

/** @param isStale what the page shows is not of now */
function showState(text: string, said: string, isFault = false, isStale = isFault): void {
  document.documentElement.classList.toggle('stale', isStale);
  showMode(text, said, isFault);
}

const hertz = (rate: number): string => rate.toFixed(rate < 1 ? 1 : 0);

/**
 * A frame was drawn.
 * @param drawing milliseconds from the packet's arrival until it was on the screen
 * @param isOfNow whether that may be said; it is counted in any case
 */
export function showRate(live: LiveState, drawing: number, isOfNow: boolean): void {
  dropped += live.dropped;
  const shown = shownRate.count(performance.now());
  if (!isOfNow) return;
  const lag = live.age_ms + drawing;
  Object.assign(byId('mode').dataset, {
    lag: lag.toFixed(0),
    rate: live.rate_hz.toFixed(2),
    shown: shown.toFixed(2),
  });
  showState(
    `live · ${hertz(live.rate_hz)} Hz, ${hertz(shown)} shown · lag ${lag.toFixed(0)} ms · ${dropped} dropped`,
    'live',
  );
}

const waiting = 'waiting for a frame';
const paused = 'paused: this is not live';
const undrawable = 'frames come that cannot be drawn';

/** @param isStale what is shown is of before the connection was lost */
export const showWaiting = (isStale: boolean): void => showState(waiting, waiting, false, isStale);
export const showPaused = (): void => showState(paused, paused);
export const showUndrawable = (): void => showState(undrawable, undrawable, true);
export const showQuiet = (seconds: number): void =>
  showState(`no new frame for ${seconds} s`, 'no new frame', true);

/** @param seconds until the next attempt to connect */
export const showLost = (seconds: number): void =>
  showState(
    `no connection: trying again in ${seconds.toFixed(0) || 1} s`,
    'no connection: trying again',
    true,
  );

let told: string | null = null;

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
  if (key === told) return;
  told = key;
  showMissing(lines, title, level, amiss || lines.length);
}
