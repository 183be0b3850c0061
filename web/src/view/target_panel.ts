// SPDX-License-Identifier: Apache-2.0
// The chosen target's numbers, as report.json has them.
import type { FrameReport, Handled, TargetReport } from '../api/types';
import { count, metres, nothing, percent, seconds, vector } from '../model/format';
import { verdictNames, verdictOf } from '../model/labels';
import { hiddenWords } from '../model/timeline';
import { element, swatch } from './dom';
import { verdictIcon } from './verdict_icon';

/** One number: its text for people, and report.json's own value beside it. */
interface Fact {
  readonly key: string;
  readonly name: string;
  readonly text: string;
  readonly value: unknown;
  readonly color: string;
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

export const fact = (
  key: string,
  name: string,
  value: unknown,
  text: string,
  color = '',
): Fact => ({ key, name, text, value, color });

export function factList(facts: readonly Fact[]): HTMLDListElement {
  const list = element('dl', 'facts');
  for (const fact of facts) {
    const name = element('dt', '', fact.name);
    name.title = meanings[fact.key] ?? '';
    if (fact.color) name.prepend(swatch(fact.color));
    const value = element('dd', fact.text === nothing ? 'none' : '', fact.text);
    value.dataset['key'] = fact.key;
    value.dataset['value'] = JSON.stringify(fact.value ?? null);
    list.append(name, value);
  }
  return list;
}

export function targetDetails(target: TargetReport): HTMLElement {
  const verdict = verdictOf(target.verdict);
  const heading = element('h3', 'verdict', verdictIcon(verdict), verdictNames[verdict]);
  heading.dataset['key'] = 'verdict';
  heading.dataset['value'] = JSON.stringify(target.verdict);
  const body = element('div', 'target-details', heading);
  if (verdict === 'unknown' && target.blame?.length)
    body.append(element('p', '', hiddenWords(target)));
  if (target.reason) body.append(element('p', 'reason', target.reason));
  body.append(factList(coverage(target)));
  if (target.blame?.length) body.append(element('h4', '', 'Hidden by'), blameBars(target));
  body.append(element('h4', '', 'Measured point'), factList(measured(target)));
  if (target.handled)
    body.append(element('h4', '', 'Handled'), factList(handled(target, target.handled)));
  return body;
}

function coverage(target: TargetReport): Fact[] {
  type Key = Extract<keyof TargetReport, `${string}_fraction`>;
  const fraction = (key: Key, name: string, color = ''): Fact =>
    fact(key, name, target[key], percent(target[key], 2), color);
  return [
    fraction('occluded_fraction', 'occluded', '--l-occluded'),
    fraction('front_fraction', 'in front', '--l-front'),
    fraction('unknown_fraction', 'unknown', '--l-unknown'),
    fraction('clear_fraction', 'clear of robot'),
    fraction('hidden_by_other_fraction', 'hidden by others', '--l-other'),
    fraction('measured_fraction', 'measured'),
    fraction('seen_past_fraction', 'seen past'),
    fact('covered', 'pixels', target.covered, count(target.covered)),
    fact('inside', 'in the image', target.inside, count(target.inside)),
  ];
}

const measured = ({ point, point_pixels, point_spread_m }: TargetReport): Fact[] => [
  fact('point', 'x y z, m', point, vector(point)),
  fact('point_pixels', 'of pixels', point_pixels, count(point_pixels)),
  fact('point_spread_m', 'spread', point_spread_m, metres(point_spread_m)),
];

const handled = ({ estimate }: TargetReport, is: Handled): Fact[] => [
  fact('source', 'source', is.source, is.source),
  fact('age_s', 'age', is.age_s, seconds(is.age_s, 3)),
  fact('position', 'x y z, m', is.position, vector(is.position)),
  fact('orientation', 'x y z w', is.orientation, vector(is.orientation)),
  fact('sigma_m', 'sigma', is.sigma_m, metres(is.sigma_m)),
  fact('estimate', 'estimate', estimate, estimate ?? nothing),
];

function blameBars(target: TargetReport): HTMLElement {
  const list = element('ul', 'blame-bars');
  for (const { link, fraction: share } of target.blame ?? []) {
    const bar = element('span', 'bar');
    bar.style.width = `${Math.min(100, 100 * share).toFixed(1)}%`;
    list.append(element('li', '', element('span', 'bar-name', link), bar, percent(share)));
  }
  return list;
}

/** Targets of a frame to choose from. */
export function targetList(
  frame: FrameReport,
  chosen: string | null,
  choose: (name: string) => void,
): HTMLElement {
  const buttons = frame.targets.map((target) => {
    const verdict = verdictOf(target.verdict);
    const hidden = hiddenWords(target);
    const amount = element('span', 'amount', hidden.replace('at least', '≥'));
    const name = element('span', 'name', target.name);
    const button = element('button', '', verdictIcon(verdict), name, amount);
    button.type = 'button';
    button.dataset['target'] = target.name;
    const words = `${target.name}: ${verdictNames[verdict]}, hidden: ${hidden}`;
    button.title = words;
    button.setAttribute('aria-pressed', String(target.name === chosen));
    button.setAttribute('aria-label', words);
    button.addEventListener('click', () => choose(target.name));
    return button;
  });
  return element('div', 'target-list', ...buttons);
}
