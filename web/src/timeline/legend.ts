// SPDX-License-Identifier: Apache-2.0
import type { Verdict } from '../api/types';
import { verdictNames } from '../model/labels';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';

/** Verdicts by shape and colour, then what the areas and lines are. */
export function timelineLegend(): HTMLElement[] {
  const verdicts = (Object.keys(verdictNames) as Verdict[]).map((verdict) =>
    element('span', 'legend-entry', verdictIcon(verdict), verdictNames[verdict]),
  );
  const entry = (kind: string, name: string): HTMLElement =>
    element('span', 'legend-entry', element('i', `swatch ${kind}`), name);
  return [
    group('Verdict', ...verdicts),
    group(
      'Hidden',
      entry('l-occluded', 'by robot'),
      entry('l-other', 'by others'),
      entry('l-unknown', 'unknown'),
    ),
    group(
      'Handled',
      entry('s-measured', 'measured'),
      entry('s-predicted', 'predicted'),
      entry('s-held', 'held'),
    ),
  ];
}

const group = (title: string, ...entries: HTMLElement[]): HTMLElement =>
  element('div', 'legend-group', element('b', '', title), ...entries);
