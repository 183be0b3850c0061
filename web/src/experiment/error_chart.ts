// SPDX-License-Identifier: Apache-2.0
// Every method's position error over the frames, on a scale of powers of ten, as a timeline's row.
import { condense, runsOf } from '../model/timeline';
import { rowSvg } from '../timeline/charts';
import { element, svg } from '../view/dom';
import { lengthName, shareOf, ticksOf, type LogScale } from './log_scale';

export const errorScale: LogScale = { low: 1, high: 1000 }; // millimetres
const height = 132;
const margin = 6;

export interface ErrorLine {
  readonly key: string;
  /** Millimetres; null: no pose. */
  readonly errors: readonly (number | null)[];
}

export interface Marks {
  /** Frames in which the target counts as hidden. */
  readonly hidden: readonly boolean[];
  readonly goal: number | null;
  readonly goalName: string;
}

const y = (error: number): string =>
  (height - margin - shareOf(errorScale, error) * (height - 2 * margin)).toFixed(1);

/** No pose is graver than any error. */
const graver = (a: number | null, b: number | null): number | null =>
  a === null || b === null ? null : Math.max(a, b);

/** A path with a gap wherever there is no pose. */
export function errorPath(errors: readonly (number | null)[], width: number): string {
  const columns = condense(errors, Math.max(Math.floor(width), 1), graver);
  let path = '';
  columns.forEach((error, i) => {
    if (error === null) return;
    const x = (((i + 0.5) * width) / columns.length).toFixed(1);
    const goesOn = i > 0 && (columns[i - 1] ?? null) !== null;
    path += goesOn ? `L${x} ${y(error)}` : `M${x} ${y(error)}h0`;
  });
  return path;
}

export function errorChart(
  lines: readonly ErrorLine[],
  chosen: string,
  marks: Marks,
  width: number,
): SVGSVGElement {
  const chart = rowSvg(width, height, 'position error of every method');
  chart.classList.add('error-chart');
  const count = marks.hidden.length;
  for (const run of runsOf(marks.hidden)) {
    if (!run.value) continue;
    const x = (run.from * width) / count;
    const box = { x, y: 0, width: ((run.to - run.from) * width) / count, height };
    chart.append(svg('rect', { ...box, class: 'hidden-span' }));
  }
  for (const tick of ticksOf(errorScale))
    chart.append(
      svg('path', { d: `M0 ${y(tick)}H${width}`, class: 'grid-line' }),
      svg('text', { x: 3, y: Number(y(tick)) + 3.5, class: 'scale-text' }, lengthName(tick)),
    );
  if (marks.goal !== null) chart.append(...goalMark(marks, width));
  const drawn = [...lines].sort((a, b) => Number(a.key === chosen) - Number(b.key === chosen));
  for (const { key, errors } of drawn) {
    const name = `method-line m-${key}${key === chosen ? ' chosen' : ''}`;
    chart.append(svg('path', { d: errorPath(errors, width), class: name }));
  }
  return chart;
}

function goalMark({ goal, goalName, hidden }: Marks, width: number): SVGElement[] {
  const x = (((goal ?? 0) + 0.5) * width) / hidden.length;
  const left = x > width / 2;
  const at = { x: x + (left ? -4 : 4), y: 11, 'text-anchor': left ? 'end' : 'start' };
  return [
    svg('path', { d: `M${x.toFixed(1)} 0V${height}`, class: 'goal-line' }),
    svg('text', { ...at, class: 'scale-text' }, goalName),
  ];
}

/** A piece of a method's line, for legends and tables. */
export function lineSwatch(key: string): SVGSVGElement {
  const line = svg('path', { d: 'M1 5H27', class: `method-line m-${key} chosen` });
  return svg('svg', { class: 'line-swatch', viewBox: '0 0 28 10', 'aria-hidden': 'true' }, line);
}

/** Buttons that choose a method, whose line stands out. */
export function methodLegend(
  methods: readonly { readonly key: string; readonly name: string }[],
  choose: (key: string) => void,
): HTMLElement {
  const buttons = methods.map(({ key, name }) => {
    const button = element('button', 'small', lineSwatch(key), name);
    button.dataset['method'] = key;
    button.addEventListener('click', () => choose(key));
    return button;
  });
  return element('div', 'legend-group methods', element('b', '', 'Position error'), ...buttons);
}
