// SPDX-License-Identifier: Apache-2.0
// The report of what planned motions will hide.
import type { ForecastInterval, Verdict } from '../api/types';
import { percent, seconds } from '../model/format';
import { element } from '../view/dom';
import {
  barLegend,
  bars,
  gallery,
  headOf,
  hint,
  lessSeen,
  mostColumns,
  notes,
  section,
  tableCard,
  tableSection,
  verdictCell,
  type Origin,
  type Picture,
} from './parts';

interface Forecast {
  readonly intervals: readonly (ForecastInterval & { readonly hidden: number })[];
}

interface Motion {
  readonly name: string;
  readonly duration_s: number;
  readonly targets: readonly {
    readonly name: string;
    readonly any_camera: Forecast;
    readonly cameras: readonly (Forecast & { readonly camera: string | null })[];
  }[];
}

/** look_ahead.json. */
export interface LookAhead extends Origin {
  readonly frame: number;
  readonly now: readonly {
    readonly name: string;
    readonly verdict: Verdict;
    readonly hidden_by_other: number | null;
    readonly reason: string | null;
  }[];
  readonly ranking: readonly Readonly<{ motion: string; seen: number; reason: string | null }>[];
  readonly motions: readonly Motion[];
  readonly notes: readonly string[];
}

export function lookAheadPage(of: LookAhead, pictures: readonly Picture[]): Node[] {
  const ranking = of.motions.length > 1 ? of.ranking : [];
  return [
    headOf('Look ahead', of),
    hint(
      `What planned motions of the robot will hide from frame ${of.frame} on, if nothing else moves. ` +
        'Times are seconds from the motion’s start.',
    ),
    ...notes(of.notes),
    ...tableSection(
      'Ranking',
      ['motion', 'targets seen', 'what costs most'],
      ranking.map(({ motion, seen, reason }) => [
        motion,
        `${percent(seen)} of the time`,
        reason ?? '',
      ]),
    ),
    ...tableSection(
      'Now, as the camera measures',
      ['target', 'now', 'hidden by other things', 'reason'],
      of.now.map(({ name, verdict, hidden_by_other: other, reason }) => [
        name,
        verdictCell(verdict),
        percent(other, 0),
        reason ?? '',
      ]),
    ),
    ...of.motions.map((motion, i) => {
      const shown = pictures.filter(({ index }) => index === i);
      return section(motion.name, ...motionParts(motion), gallery(shown));
    }),
  ];
}

function motionParts({ targets, duration_s: duration }: Motion): Node[] {
  const rows = targets.flatMap(({ name, any_camera, cameras }) => {
    const columns = (forecast: Forecast): Verdict[] => columnsOf(forecast, duration);
    if (cameras.length < 2) return [[name, columns(any_camera)] as const];
    return [
      [element('b', '', `${name}, any camera`), columns(any_camera)] as const,
      ...cameras.map((one) => [one.camera ?? '', columns(one)] as const),
    ];
  });
  const intervals = targets.flatMap(({ name, any_camera }) =>
    any_camera.intervals.map(({ begin_s, end_s, verdict, hidden, by, reason }) => {
      const times = [seconds(begin_s), seconds(end_s)];
      return [name, ...times, verdictCell(verdict), percent(hidden, 0), by ?? '', reason ?? ''];
    }),
  );
  return [
    hint(`${seconds(duration)}, from left to right. `, ...barLegend()),
    bars(rows),
    tableCard(['target', 'from', 'to', 'is', 'most hidden', 'by', 'reason'], intervals),
    hint('Orange in the pictures: the robot as it will be.'),
  ];
}

/** Returns the verdicts of equal parts of the motion, each the one in which least is seen. */
function columnsOf({ intervals }: Forecast, duration: number): Verdict[] {
  const count = duration > 0 ? mostColumns : 1;
  const columns = new Array<Verdict>(count).fill('visible');
  const columnAt = (time: number): number =>
    count > 1 ? Math.min(Math.floor((time / duration) * count), count - 1) : 0;
  for (const { begin_s, end_s, verdict } of intervals)
    for (let i = columnAt(begin_s); i <= columnAt(end_s); ++i)
      columns[i] = lessSeen(columns[i] as Verdict, verdict);
  return columns;
}
