// SPDX-License-Identifier: Apache-2.0
// The report of what candidate cameras would see.
import type { Verdict } from '../api/types';
import { percent } from '../model/format';
import { verdictNames, verdicts } from '../model/labels';
import { element } from '../view/dom';
import {
  barLegend,
  bars,
  headOf,
  hint,
  moreSeen,
  mostColumns,
  notes,
  section,
  tableCard,
  tableDetails,
  tableSection,
  type Cell,
  type Origin,
} from './parts';

/** Shares of the frames by verdict; `by_frame` has one of `letters` for each frame. */
type SeenTarget = Readonly<Record<Verdict, number> & { name: string; by_frame: string }>;

/** view_planning.json. */
export interface ViewPlan extends Origin {
  readonly frames: readonly number[];
  readonly frames_left_out: number;
  readonly candidates: readonly {
    readonly name: string;
    readonly targets: readonly SeenTarget[];
    readonly first_unknown: string | null;
  }[];
  readonly best: readonly {
    readonly cameras: readonly string[];
    readonly visible: Readonly<Record<string, number>>;
    readonly mean_visible: number;
  }[];
}

/** One letter for each verdict, in the order of `verdicts`. */
const letters = 'vph?og';
const verdictsOf = ({ by_frame }: SeenTarget): Verdict[] =>
  Array.from(by_frame, (letter) => verdicts[letters.indexOf(letter)] ?? 'unknown');

export function viewPlanningPage(of: ViewPlan): Node[] {
  const { candidates, best, frames, frames_left_out: left } = of;
  const targets = candidates[0]?.targets.map(({ name }) => name) ?? [];
  const largest = best.at(-1)?.cameras ?? [];
  const nameOf = (name: string): HTMLElement =>
    element(largest.includes(name) ? 'b' : 'span', '', name);
  const sets = best.map(({ cameras, visible, mean_visible }) => [
    String(cameras.length),
    cameras.join(' + '),
    ...[mean_visible, ...targets.map((name) => visible[name])].map((share) => percent(share)),
  ]);
  const shares = candidates.flatMap(({ name, targets: seen }) =>
    seen.map((target) => [name, target.name, ...verdicts.map((one) => percent(target[one]))]),
  );
  const overTime = targets.flatMap((name, t) => {
    const seen = candidates.map((one) => verdictsOf(one.targets[t] as SeenTarget));
    const chosen = seen.filter((_, c) => largest.includes(candidates[c]?.name ?? ''));
    const together = frames.map((_, f) =>
      chosen.map((all) => all[f] as Verdict).reduce(moreSeen, 'unknown'),
    );
    const rows = candidates.map((one, c) => [nameOf(one.name), seen[c] ?? []] as const);
    return [element('h3', '', name), bars([[element('b', '', 'best set'), together], ...rows])];
  });
  const each = Math.ceil(frames.length / mostColumns);
  const why = 'because the robot’s pose is not known.';
  return [
    headOf('View planning', of),
    ...notes(left > 0 ? [`${left} of ${left + frames.length} frames are left out, ${why}`] : []),
    section(
      'Best sets',
      hint(
        'The share of the frames in which at least one camera of the set sees the target: it is ' +
          'visible, not only in part.',
      ),
      tableCard(['cameras', 'best set', 'visible, mean', ...targets], sets),
    ),
    section(
      'Share visible',
      hint('Of the frames. Candidates of the largest set above are bold.'),
      tableCard(
        ['candidate', ...targets],
        candidates.map((one) => [[nameOf(one.name)], ...one.targets.map(heatCell)]),
      ),
      tableDetails(
        'The shares of all verdicts',
        ['candidate', 'target', ...verdicts.map((verdict) => verdictNames[verdict])],
        shares,
      ),
    ),
    section(
      'Over time',
      hint(
        `Frame ${frames[0]} to ${frames.at(-1)}, from left to right. ` +
          'The best set shows the camera that sees most. ',
        each > 1 ? `Each step shows the one of ${each} frames in which least is seen. ` : '',
        ...barLegend(),
      ),
      ...overTime,
    ),
    ...tableSection(
      'Unknown',
      ['candidate', 'first unknown verdict'],
      candidates.flatMap(({ name, first_unknown: first }) => (first ? [[name, first]] : [])),
    ),
  ];
}

/** Returns a cell whose colour is the share that is visible. */
function heatCell({ visible }: SeenTarget): Cell {
  const cell = element('span', 'heat', percent(visible));
  cell.style.setProperty('--share', `${100 * visible}%`);
  return [cell];
}
