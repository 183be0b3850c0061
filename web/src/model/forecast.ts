// SPDX-License-Identifier: Apache-2.0
// What a planned motion will hide of a target.
import type { ForecastInterval, Verdict } from '../api/types';
import { seconds } from './format';

/** Returns "in 1.30 s behind forearm, for 0.80 s", why it is not known, or until when it is not. */
export function forecastText(forecast: readonly ForecastInterval[]): string {
  const unknown = forecast.findIndex(({ verdict }) => verdict === 'unknown');
  const hidden = forecast.findIndex(({ verdict }) => verdict === 'hidden');
  const first = forecast[hidden];
  if (!first || (unknown >= 0 && unknown < hidden)) {
    const reason = forecast[unknown]?.reason;
    return reason ?? `not in the next ${seconds(forecast.at(-1)?.end_s ?? 0, 2)}`;
  }
  const when = first.begin_s > 0 ? `in ${seconds(first.begin_s, 2)}` : 'now';
  const isOpen = hidden + 1 === forecast.length;
  const length = `${isOpen ? 'at least ' : ''}${seconds(first.end_s - first.begin_s, 2)}`;
  return `${when}${first.by ? ` behind ${first.by}` : ''}, for ${length}`;
}

/** A part of a timeline, in frames: the middle of frame i is i + 0.5. */
export interface ForecastSpan {
  readonly from: number;
  readonly to: number;
  readonly verdict: Verdict;
}

/**
 * Returns where on a timeline a frame's forecast lies.
 * @param times of the frames, seconds; null: without a stamp
 */
export function forecastSpans(
  forecast: readonly ForecastInterval[],
  times: readonly (number | null)[],
  frame: number,
): ForecastSpan[] {
  const now = times[frame];
  if (now == null) return [];
  const at = (time: number): number => {
    const after = times.findIndex((one, i) => i > frame && one !== null && one > time);
    if (after < 0) return times.length;
    const [before, next] = [times[after - 1] ?? now, times[after] ?? now];
    return after - 0.5 + (time - before) / (next - before);
  };
  return forecast
    .map(({ begin_s, end_s, verdict }) => ({
      from: at(now + begin_s),
      to: at(now + end_s),
      verdict,
    }))
    .filter(({ from, to }) => to > from);
}
