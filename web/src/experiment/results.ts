// SPDX-License-Identifier: Apache-2.0
// Every method's measures over all seeds, with their confidence: metrics.json's numbers.
import { nothing } from '../model/format';
import { element, svg } from '../view/dom';
import { lineSwatch } from './error_chart';
import { lengthName, scaleOf, shareOf, ticksOf } from './log_scale';
import type { Experiment, Lane, Measure, Measured, Method } from './types';

const unknown: Measured = { value: null, ci95: null };

const measuredOf = (lane: Lane, method: Method, key: string): Measured =>
  lane.methods[method.key]?.summary[key] ?? unknown;

export function laneResults(experiment: Experiment, key: string, lane: Lane): HTMLElement {
  const compared = experiment.measures.find((measure) => measure.key === experiment.compared);
  const body = element('div', 'lane', element('h3', '', lane.name), resultTable(experiment, lane));
  body.dataset['lane'] = key;
  if (compared) body.append(intervalChart(experiment.methods, lane, compared));
  return body;
}

function resultTable(experiment: Experiment, lane: Lane): HTMLElement {
  const head = element('tr', '', element('th', '', 'method'));
  for (const { name, unit } of experiment.measures)
    head.append(element('th', '', unit ? `${name}, ${unit}` : name));
  head.append(element('th', '', 'p95 as a multiple of ours'));
  const ours = experiment.methods.at(-1);
  const best = ours && measuredOf(lane, ours, experiment.compared).value;
  const table = element('table', 'results', head);
  for (const method of experiment.methods) {
    const row = element('tr', method === ours ? 'ours' : '');
    row.dataset['method'] = method.key;
    row.append(element('th', '', lineSwatch(method.key), method.name));
    for (const measure of experiment.measures)
      row.append(cellOf(measure, measuredOf(lane, method, measure.key)));
    const value = measuredOf(lane, method, experiment.compared).value;
    const known = value !== null && !!best && best > 0;
    row.append(element('td', known ? '' : 'none', known ? (value / best).toFixed(1) : nothing));
    table.append(row);
  }
  return element('div', 'panel scroll', table);
}

function cellOf(measure: Measure, measured: Measured): HTMLTableCellElement {
  const { value, ci95 } = measured;
  const text = (number: number): string => number.toFixed(measure.digits);
  const cell = element('td', value === null ? 'none' : '', value === null ? nothing : text(value));
  if (value !== null)
    cell.append(element('small', '', ci95 ? `${text(ci95[0])} to ${text(ci95[1])}` : nothing));
  cell.dataset['key'] = measure.key;
  cell.dataset['value'] = JSON.stringify(measured);
  return cell;
}

/** Values with their confidence as dots and whiskers, on one scale of powers of ten. */
function intervalChart(methods: readonly Method[], lane: Lane, measure: Measure): HTMLElement {
  const rows = methods.map((method) => ({
    method,
    measured: measuredOf(lane, method, measure.key),
  }));
  const ends = rows.flatMap(({ measured: { value, ci95 } }) => [value ?? 0, ...(ci95 ?? [])]);
  const scale = scaleOf(ends);
  if (!scale)
    return element(
      'p',
      'hint',
      'In no frame that counts is the target hidden: nothing to compare.',
    );
  const at = (value: number): string => `${(100 * shareOf(scale, value)).toFixed(2)}%`;
  const grid = ticksOf(scale).map(at);
  const chart = element('div', 'intervals');
  for (const { method, measured } of rows) {
    const { value, ci95 } = measured;
    const line = svg('svg', { class: 'interval', role: 'img', 'aria-label': method.name });
    for (const x of grid)
      line.append(svg('line', { x1: x, x2: x, y1: 0, y2: '100%', class: 'grid-line' }));
    if (value !== null) {
      const [low, high] = ci95 ?? [value, value];
      const whisker = { x1: at(low), x2: at(high), y1: '50%', y2: '50%' };
      line.append(
        svg('line', { ...whisker, class: `whisker m-${method.key}` }),
        svg('circle', { cx: at(value), cy: '50%', r: 5, class: `dot m-${method.key}` }),
      );
    }
    chart.append(element('span', '', method.name), line);
  }
  const axis = svg('svg', { class: 'interval-axis', 'aria-hidden': 'true' });
  ticksOf(scale).forEach((tick, i, all) => {
    const anchor = i === 0 ? 'start' : i + 1 === all.length ? 'end' : 'middle';
    const place = { x: at(tick), y: 12, 'text-anchor': anchor };
    axis.append(svg('text', { ...place, class: 'scale-text' }, lengthName(tick)));
  });
  chart.append(element('span', ''), axis);
  const caption = element('figcaption', 'hint', `${measure.name}, with 95 % confidence.`);
  return element('figure', 'panel card', chart, caption);
}
