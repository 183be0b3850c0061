// SPDX-License-Identifier: Apache-2.0
import type { Diagnostic, LiveState } from '../api/types';
import { byId, setText } from './dom';
import { showMissing } from './missing';

const rateWindow = 2000; // milliseconds
let dropped = 0;
let shownAt: number[] = [];

/** @param drawing milliseconds from the packet's arrival until it was on the screen */
export function showRate(live: LiveState, drawing: number): void {
  dropped += live.dropped;
  const lag = live.age_ms + drawing;
  const now = performance.now();
  shownAt = [...shownAt.filter((time) => now - time < rateWindow), now];
  const shown = (1000 * shownAt.length) / rateWindow;
  const mode = byId('mode');
  mode.dataset['lag'] = lag.toFixed(0);
  setText(
    mode,
    `live · ${live.rate_hz.toFixed(0)} Hz, ${shown.toFixed(0)} shown · lag ${lag.toFixed(0)} ms · ${dropped} dropped`,
  );
}

/** @param seconds until the next attempt to connect; null: connected */
export function showLink(seconds: number | null): void {
  const mode = byId('mode');
  mode.classList.toggle('fault', seconds !== null);
  setText(
    mode,
    seconds === null ? 'live' : `no connection: trying again in ${seconds.toFixed(0) || 1} s`,
  );
}

let shown = '';

export function showDiagnostics(diagnostics: readonly Diagnostic[]): void {
  const lines = diagnostics.map(({ level, message }) => `${level}: ${message}`);
  const key = lines.join('\n');
  if (key === shown) return;
  shown = key;
  const wrong = diagnostics.filter(({ level }) => level !== 'ok');
  const isFault = wrong.some(({ level }) => level === 'error');
  const level = isFault ? 'fault' : wrong.length ? 'warn' : 'ok';
  showMissing(lines, wrong.length ? 'Diagnostics' : 'All well', level);
}
