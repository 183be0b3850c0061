// SPDX-License-Identifier: Apache-2.0
import { svg } from '../view/dom';
import { rowSvg } from './charts';

const height = 16;
const pixelsBetween = 90;

/** Steps of 1, 2 or 5 times a power of ten. */
export function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  const found = [1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-9)) ?? 10;
  return found * power;
}

/** Times where the frames have stamps, else their numbers. */
export function axisChart(times: readonly (number | null)[], width: number): SVGSVGElement {
  const chart = rowSvg(width, height, 'axis of time');
  const every = Math.max(1, niceStep((times.length * pixelsBetween) / Math.max(width, 1)));
  for (let frame = 0; frame < times.length; frame += every) {
    const x = ((frame + 0.5) * width) / times.length;
    const time = times[frame];
    const digits = (times.at(-1) ?? 0) > 20 ? 1 : 2;
    const text = time === null || time === undefined ? `${frame}` : `${time.toFixed(digits)} s`;
    const anchor = frame === 0 && x < 20 ? 'start' : x > width - 20 ? 'end' : 'middle';
    chart.append(
      svg('path', { d: `M${x.toFixed(1)} 0V4`, class: 'tick' }),
      svg('text', { x: x.toFixed(1), y: 13.5, 'text-anchor': anchor, class: 'tick-text' }, text),
    );
  }
  return chart;
}
