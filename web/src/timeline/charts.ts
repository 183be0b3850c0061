// SPDX-License-Identifier: Apache-2.0
// The timeline's rows as SVG: as wide as the screen's pixels, whatever the number of frames.
import type { FrameReport } from '../api/types';
import {
  condense,
  graver,
  hiderOf,
  runsOf,
  type Run,
  type Sample,
  type Track,
} from '../model/timeline';
import { svg } from '../view/dom';
import { verdictFill } from './patterns';

export const fractionHeight = 26;
export const stripHeight = 14;
const sourceHeight = 6;
const characterWidth = 6.2; // of the blame's text, pixels

export function rowSvg(width: number, height: number, label: string): SVGSVGElement {
  const size = { width, height, viewBox: `0 0 ${width} ${height}` };
  return svg('svg', { ...size, role: 'img', 'aria-label': label, class: 'row-chart' });
}

/** Occluded, hidden by others and unknown, one upon the other; below the verdict, then the source. */
export function targetChart(track: Track, width: number, label: string): SVGSVGElement {
  const samples = condense<Sample | null>(track.samples, Math.floor(width), graver);
  const chart = rowSvg(width, fractionHeight + stripHeight + sourceHeight, label);
  chart.append(...stack(samples, width), ...verdictStrip(samples, width));
  chart.append(...sources(samples, width));
  return chart;
}

function stack(samples: readonly (Sample | null)[], width: number): SVGElement[] {
  const base = samples.map(() => 0);
  const layers = (['occluded', 'other', 'unknown'] as const).map((part) => {
    const below = base.slice();
    samples.forEach((sample, i) => (base[i] = Math.min(1, (base[i] ?? 0) + (sample?.[part] ?? 0))));
    return areaPath(below, base.slice(), width, fractionHeight, `area ${part}`);
  });
  const isUnknown = samples.map((sample) => sample?.occluded == null);
  const line = svg('path', { d: `M0 ${fractionHeight - 0.5}H${width}`, class: 'base-line' });
  return [...gaps(isUnknown, width, fractionHeight), ...layers, line];
}

/** Where nothing is known. */
function gaps(isUnknown: readonly boolean[], width: number, height: number): SVGElement[] {
  const runs = runsOf(isUnknown).filter((run) => run.value);
  const boxes = runs.map((run) => ({ ...span(run, isUnknown.length, width), y: 1 }));
  return boxes.map((box) => svg('rect', { ...box, height: height - 1, class: 'gap' }));
}

function areaPath(
  low: readonly number[],
  high: readonly number[],
  width: number,
  height: number,
  name: string,
): SVGPathElement {
  const x = (i: number): string => ((i * width) / high.length).toFixed(1);
  const y = (value: number): string => (height - value * (height - 1)).toFixed(1);
  let path = '';
  high.forEach((value, i) => (path += `${i ? 'L' : 'M'}${x(i)} ${y(value)}H${x(i + 1)}`));
  for (let i = low.length - 1; i >= 0; --i) path += `L${x(i + 1)} ${y(low[i] as number)}H${x(i)}`;
  return svg('path', { d: `${path}Z`, class: name });
}

const span = (run: Run<unknown>, count: number, width: number): { x: number; width: number } => ({
  x: (run.from * width) / count,
  width: ((run.to - run.from) * width) / count,
});

function verdictStrip(samples: readonly (Sample | null)[], width: number): SVGElement[] {
  const keys = samples.map((sample) => (sample ? `${sample.verdict}\n${blameOf(sample)}` : ''));
  return runsOf(keys).flatMap((run) => {
    const sample = samples[run.from];
    const at = span(run, samples.length, width);
    const box = { ...at, y: fractionHeight + 1, height: stripHeight - 2 };
    if (!sample) return [svg('rect', { ...box, class: 'gap' })];
    const fill = verdictFill[sample.verdict];
    const shape = svg('rect', { ...box, fill, class: `strip ${sample.verdict}` });
    const text = blameOf(sample);
    if (text.length * characterWidth + 8 > at.width || !text) return [shape];
    const middle = { x: at.x + at.width / 2, y: fractionHeight + stripHeight - 4 };
    return [shape, svg('text', { ...middle, 'text-anchor': 'middle', class: 'blame' }, text)];
  });
}

/** Who hides most of it, of targets that are partial or hidden. */
function blameOf(sample: Sample): string {
  if (sample.verdict !== 'partial' && sample.verdict !== 'hidden') return '';
  return hiderOf(sample);
}

function sources(samples: readonly (Sample | null)[], width: number): SVGElement[] {
  const y = fractionHeight + stripHeight + sourceHeight / 2;
  return runsOf(samples.map((sample) => sample?.source ?? null)).flatMap((run) => {
    if (!run.value || run.value === 'lost') return [];
    const at = span(run, samples.length, width);
    const d = `M${at.x + 0.5} ${y}H${at.x + at.width - 0.5}`;
    return [svg('path', { d, class: `source ${run.value}` })];
  });
}

/** Frames that are not `ok` stand out; the others are a calm line. */
export function statusChart(frames: readonly FrameReport[], width: number): SVGSVGElement {
  const worst = (a: string, b: string): string => (a === 'ok' ? b : a);
  const statuses = condense(
    frames.map((frame) => frame.status),
    Math.floor(width),
    worst,
  );
  const bad = frames.filter((frame) => frame.status !== 'ok').length;
  const chart = rowSvg(width, stripHeight, `${bad} of ${frames.length} frames are not ok`);
  for (const run of runsOf(statuses)) {
    const at = span(run, statuses.length, width);
    const fault = run.value !== 'ok';
    chart.append(
      svg('rect', { ...at, y: 2, height: 10, class: fault ? 'status fault' : 'status' }),
    );
    if (fault && run.value.length * characterWidth + 8 < at.width)
      chart.append(svg('text', { x: at.x + 4, y: 10.5, class: 'blame' }, run.value));
  }
  return chart;
}

/** Stacked series of a unit from zero to the largest sum; null: nothing known. */
export function seriesChart(
  series: readonly { readonly name: string; readonly values: readonly (number | null)[] }[],
  width: number,
  height: number,
  label: string,
): SVGSVGElement {
  const columns = Math.floor(width);
  const larger = (a: number | null, b: number | null): number | null =>
    a === null ? b : b === null ? a : Math.max(a, b);
  const known = series.map(({ values }) => condense(values, columns, larger));
  const layers = known.map((values) => values.map((value) => value ?? 0));
  const sums = (layers[0] ?? []).map((_, i) => layers.reduce((sum, one) => sum + (one[i] ?? 0), 0));
  const top = Math.max(...sums, Number.EPSILON);
  const chart = rowSvg(width, height, label);
  const isUnknown = sums.map((_, i) => known.every((values) => (values[i] ?? null) === null));
  chart.append(...gaps(isUnknown, width, height));
  let below = sums.map(() => 0);
  layers.forEach((values, index) => {
    const above = below.map((low, i) => low + (values[i] ?? 0) / top);
    chart.append(areaPath(below, above, width, height, `series series-${index}`));
    below = above;
  });
  return chart;
}
