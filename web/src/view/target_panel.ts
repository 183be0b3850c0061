// SPDX-License-Identifier: Apache-2.0
// The chosen target's numbers, as report.json has them.
import type { FrameReport, TargetReport } from '../api/types';
import { count, metres, nothing, percent, seconds, vector } from '../model/format';
import { verdictNames, verdictOf } from '../model/labels';
import { hiddenShare } from '../model/timeline';
import { element } from './dom';
import { verdictIcon } from './verdict_icon';

/** One number: its text for people, and report.json's own value beside it. */
interface Fact {
  readonly key: string;
  readonly name: string;
  readonly text: string;
  readonly value: unknown;
  readonly color?: string;
}

/** What surprises; docs/targets.md says more. */
const meanings: Readonly<Record<string, string>> = {
  occluded_fraction: 'of its pixels in the image: the sensor sees the robot there',
  front_fraction: 'something real stands before the robot there',
  unknown_fraction: 'robot on the ray, and no measurement',
  clear_fraction: 'no robot on the ray',
  hidden_by_other_fraction: 'something that is not the robot stands before it',
  measured_fraction: 'pixels with a measured depth that counts',
  seen_past_fraction: 'the sensor looks past the place where it is expected',
  fringe: 'beside the robot, depth not to be trusted',
  covered: 'that its whole extent covers, in the image or not',
  inside: 'of those, in the image: fractions are of these',
  sigma_m: 'one standard deviation of its position',
  age_s: 'since the last estimate that was taken',
};

const fraction = (
  key: string,
  name: string,
  value: number | null | undefined,
  color = '',
): Fact => ({
  key,
  name,
  text: percent(value, 2),
  value,
  color,
});

export function factList(facts: readonly Fact[]): HTMLDListElement {
  const list = element('dl', 'facts');
  for (const fact of facts) {
    const name = element('dt', '', fact.name);
    name.title = meanings[fact.key] ?? '';
    if (fact.color) name.prepend(element('i', `swatch ${fact.color}`));
    const value = element('dd', fact.text === nothing ? 'none' : '', fact.text);
    value.dataset['key'] = fact.key;
    value.dataset['value'] = JSON.stringify(fact.value ?? null);
    list.append(name, value);
  }
  return list;
}

export function targetDetails(target: TargetReport): HTMLElement {
  const verdict = verdictOf(target.verdict);
  const heading = element('h3', `verdict ${verdict}`, verdictIcon(verdict), verdictNames[verdict]);
  heading.dataset['key'] = 'verdict';
  heading.dataset['value'] = JSON.stringify(target.verdict);
  const body = element('div', 'target-details', heading);
  if (target.reason) body.append(element('p', 'reason', target.reason));
  body.append(factList(coverage(target)));
  if (target.blame?.length) body.append(element('h4', '', 'Hidden by'), blameBars(target));
  body.append(element('h4', '', 'Measured point'), factList(measured(target)));
  if (target.handled) body.append(element('h4', '', 'Handled'), factList(handled(target)));
  return body;
}

const coverage = (target: TargetReport): Fact[] => [
  fraction('occluded_fraction', 'occluded', target.occluded_fraction, 'l-occluded'),
  fraction('front_fraction', 'in front', target.front_fraction, 'l-front'),
  fraction('unknown_fraction', 'unknown', target.unknown_fraction, 'l-unknown'),
  fraction('clear_fraction', 'clear of robot', target.clear_fraction),
  fraction(
    'hidden_by_other_fraction',
    'hidden by others',
    target.hidden_by_other_fraction,
    'l-other',
  ),
  fraction('measured_fraction', 'measured', target.measured_fraction),
  fraction('seen_past_fraction', 'seen past', target.seen_past_fraction),
  { key: 'covered', name: 'pixels', text: count(target.covered), value: target.covered },
  { key: 'inside', name: 'in the image', text: count(target.inside), value: target.inside },
];

const measured = (target: TargetReport): Fact[] => [
  { key: 'point', name: 'x y z, m', text: vector(target.point), value: target.point },
  {
    key: 'point_pixels',
    name: 'of pixels',
    text: count(target.point_pixels),
    value: target.point_pixels,
  },
  {
    key: 'point_spread_m',
    name: 'spread',
    text: metres(target.point_spread_m),
    value: target.point_spread_m,
  },
];

function handled(target: TargetReport): Fact[] {
  const is = target.handled;
  return [
    { key: 'source', name: 'source', text: is?.source ?? nothing, value: is?.source },
    { key: 'age_s', name: 'age', text: seconds(is?.age_s, 3), value: is?.age_s },
    { key: 'position', name: 'x y z, m', text: vector(is?.position), value: is?.position },
    { key: 'orientation', name: 'x y z w', text: vector(is?.orientation), value: is?.orientation },
    { key: 'sigma_m', name: 'sigma', text: metres(is?.sigma_m), value: is?.sigma_m },
    { key: 'estimate', name: 'estimate', text: target.estimate ?? nothing, value: target.estimate },
  ];
}

function blameBars(target: TargetReport): HTMLElement {
  const list = element('ul', 'blame-bars');
  for (const { link, fraction: share } of target.blame ?? []) {
    const bar = element('span', 'bar');
    bar.style.width = `${Math.min(100, 100 * share).toFixed(1)}%`;
    list.append(element('li', '', element('span', 'bar-name', link), bar, percent(share)));
  }
  return list;
}

/** How much of it robot and others hide; where the verdict is unknown, at least. */
function hiddenText(target: TargetReport): string {
  const { occluded_fraction: occluded, hidden_by_other_fraction: other } = target;
  const share = (target.inside ?? 0) > 0 ? hiddenShare({ occluded, other }) : null;
  if (verdictOf(target.verdict) !== 'unknown') return percent(share, 0);
  return share !== null && share >= 0.005 ? `≥ ${percent(share, 0)}` : percent(null, 0);
}

/** Targets of a frame to choose from. */
export function targetList(
  frame: FrameReport,
  chosen: string | null,
  choose: (name: string) => void,
): HTMLElement {
  const list = element('div', 'target-list');
  for (const target of frame.targets) {
    const verdict = verdictOf(target.verdict);
    const hidden = hiddenText(target);
    const amount = element('span', 'amount', hidden);
    amount.title = 'hidden, by the robot or by others';
    const button = element(
      'button',
      '',
      verdictIcon(verdict),
      element('span', 'name', target.name),
      amount,
    );
    button.type = 'button';
    button.dataset['target'] = target.name;
    button.setAttribute('aria-pressed', String(target.name === chosen));
    button.setAttribute('aria-label', `${target.name}: ${verdictNames[verdict]}, ${hidden} hidden`);
    button.addEventListener('click', () => choose(target.name));
    list.append(button);
  }
  return list;
}
