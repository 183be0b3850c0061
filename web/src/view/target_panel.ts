// SPDX-License-Identifier: Apache-2.0
// The selected target's numbers, as in report.json.
import type { FrameReport, Handled, TargetReport } from '../api/types';
import { count, metres, percent, seconds, unknownText, vector } from '../model/format';
import { forecastText } from '../model/forecast';
import { verdictNames, verdictOf } from '../model/labels';
import { hiddenText } from '../model/timeline';
import { element, swatch, term } from './dom';
import { verdictIcon } from './verdict_icon';

/** One value of report.json, and its text. */
interface Fact {
  readonly key: string;
  readonly name: string;
  readonly text: string;
  readonly value: unknown;
  readonly color: string;
}

/** Plain words, shown before the fact's name. */
const plainWords: Readonly<Record<string, string>> = {
  front: 'in front of it',
  occluded: 'robot seen',
  unknown: 'not measured',
  beyond: 'seen past it',
  fringe: 'its edge',
  occluded_fraction: 'robot hides it',
  front_fraction: 'in front of the robot',
  clear_fraction: 'no robot there',
  hidden_by_other_fraction: 'others hide it',
  measured_fraction: 'has a depth',
  seen_past_fraction: 'camera sees past it',
  covered: 'all its pixels',
  inside: 'pixels in the image',
  sigma_m: 'may be off by',
};

/** Tooltips; see docs/targets.md. */
const meanings: Readonly<Record<string, string>> = {
  occluded_fraction: 'the sensor measures the robot (fraction of the pixels in the image)',
  front_fraction: 'an object in front of the robot',
  unknown_fraction: 'robot, but no measurement',
  clear_fraction: 'no robot',
  hidden_by_other_fraction: 'an object that is not the robot, in front of the target',
  measured_fraction: 'pixels with a valid measured depth',
  seen_past_fraction: 'the sensor measures behind the expected target',
  fringe: 'next to the robot, depth is unreliable',
  covered: 'pixels of its full extent, inside or outside the image',
  inside: 'pixels inside the image; fractions refer to these',
  sigma_m: 'standard deviation of its position',
  age_s: 'time since the last accepted estimate',
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
    const plain = plainWords[fact.key];
    const name = element('dt', '', plain ? term(plain, fact.name) : fact.name);
    name.title = meanings[fact.key] ?? '';
    if (fact.color) name.prepend(swatch(fact.color));
    const value = element('dd', fact.text === unknownText ? 'none' : '', fact.text);
    value.dataset['key'] = fact.key;
    value.dataset['value'] = JSON.stringify(fact.value ?? null);
    list.append(name, value);
  }
  return list;
}

export function targetDetails(target: TargetReport): HTMLElement {
  const verdict = verdictOf(target);
  const heading = element('h3', 'verdict', verdictIcon(verdict), verdictNames[verdict]);
  heading.dataset['key'] = 'verdict';
  heading.dataset['value'] = JSON.stringify(target.verdict);
  const body = element('div', 'target-details', heading);
  if (verdict === 'unknown' && target.blame?.length)
    body.append(element('p', '', hiddenText(target)));
  if (target.reason) body.append(element('p', 'reason', target.reason));
  if (target.forecast?.length) {
    const text = element('p', 'forecast-text', forecastText(target.forecast));
    body.append(element('h4', '', 'Will be hidden'), text);
  }
  body.append(factList(coverageFacts(target)));
  if (target.blame?.length) body.append(element('h4', '', 'Hidden by'), blameBars(target));
  body.append(element('h4', '', 'Measured point'), factList(measuredFacts(target)));
  if (target.handled)
    body.append(
      element('h4', '', term('Position to use', 'handled')),
      factList(handledFacts(target, target.handled)),
    );
  return body;
}

function coverageFacts(target: TargetReport): Fact[] {
  type Key = Extract<keyof TargetReport, `${string}_fraction`>;
  const fraction = (key: Key, name: string, color = ''): Fact =>
    fact(key, name, target[key], percent(target[key], 2), color);
  return [
    fraction('occluded_fraction', 'occluded', '--l-occluded'),
    fraction('front_fraction', 'front', '--l-front'),
    fraction('unknown_fraction', 'unknown', '--l-unknown'),
    fraction('clear_fraction', 'clear'),
    fraction('hidden_by_other_fraction', 'other', '--l-other'),
    fraction('measured_fraction', 'measured'),
    fraction('seen_past_fraction', 'seen past'),
    fact('covered', 'covered', target.covered, count(target.covered)),
    fact('inside', 'inside', target.inside, count(target.inside)),
  ];
}

const measuredFacts = ({ point, point_pixels, point_spread_m }: TargetReport): Fact[] => [
  fact('point', 'x y z, m', point, vector(point)),
  fact('point_pixels', 'pixels', point_pixels, count(point_pixels)),
  fact('point_spread_m', 'spread', point_spread_m, metres(point_spread_m)),
];

const handledFacts = ({ estimate }: TargetReport, handled: Handled): Fact[] => [
  fact('source', 'source', handled.source, handled.source),
  fact('age_s', 'age', handled.age_s, seconds(handled.age_s, 3)),
  fact('position', 'x y z, m', handled.position, vector(handled.position)),
  fact('orientation', 'x y z w', handled.orientation, vector(handled.orientation)),
  fact('sigma_m', 'sigma', handled.sigma_m, metres(handled.sigma_m)),
  ...(handled.lost_in_s == null
    ? []
    : [fact('lost_in_s', 'lost in', handled.lost_in_s, seconds(handled.lost_in_s, 2))]),
  fact('estimate', 'estimate', estimate, estimate ?? unknownText),
];

function blameBars(target: TargetReport): HTMLElement {
  const list = element('ul', 'blame-bars');
  for (const { link, fraction } of target.blame ?? []) {
    const bar = element('span', 'bar');
    bar.style.width = `${Math.min(100, 100 * fraction).toFixed(1)}%`;
    list.append(element('li', '', element('span', 'bar-name', link), bar, percent(fraction)));
  }
  return list;
}

/** Returns a button per target of a frame. */
export function targetList(
  frame: FrameReport,
  selected: string | null,
  select: (name: string) => void,
): HTMLElement {
  const buttons = frame.targets.map((target) => {
    const verdict = verdictOf(target);
    const hidden = hiddenText(target);
    const [share = '', ...by] = hidden.replace('at least', '≥').split(/(?= behind )/);
    const amount = element('span', 'amount', share, element('span', 'by', ...by));
    const name = element('span', 'name', target.name);
    const button = element('button', '', verdictIcon(verdict), name, amount);
    const title = `${target.name}: ${verdictNames[verdict]}, hidden: ${hidden}`;
    Object.assign(button, { type: 'button', title, ariaLabel: title });
    button.dataset['target'] = target.name;
    button.setAttribute('aria-pressed', String(target.name === selected));
    button.addEventListener('click', () => select(target.name));
    return button;
  });
  return element('div', 'target-list', ...buttons);
}
