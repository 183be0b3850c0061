// SPDX-License-Identifier: Apache-2.0
// The timeline's rows as SVG, with at most one column per pixel.
import type { FrameReport, TargetReport, Verdict } from '../api/types';
import { verdictOf } from '../model/labels';
import type { ForecastSpan } from '../model/forecast';
import { condense, hidersOf, larger, runsOf, worse, type Run, type Track } from '../model/timeline';
import { svg } from '../view/dom';

const fractionHeight = 26;
const stripHeight = 14;
const sourceHeight = 6;
const axisHeight = 16;
const tickDistance = 90; // pixels
const characterWidth = 6.2; // pixels, of a link's name

function rowSvg(width: number, height: number, label: string): SVGSVGElement {
  const size = { width, height, viewBox: `0 0 ${width} ${height}` };
  return svg('svg', { ...size, role: 'img', 'aria-label': label, class: 'row-chart' });
}

/** Draws the hidden fractions as stacked areas; below them the verdict, then the source. */
export function targetChart(track: Track, width: number, label: string): SVGSVGElement {
  const samples = condense<TargetReport | null>(track.samples, Math.floor(width), worse);
  const chart = rowSvg(width, fractionHeight + stripHeight + sourceHeight, label);
  chart.append(...fractionAreas(samples, width), ...verdictStrip(samples, width));
  chart.append(...sourceLines(samples, width));
  return chart;
}

const fractionFills = [
  ['occluded_fraction', 'var(--l-occluded)'],
  ['hidden_by_other_fraction', 'var(--l-other)'],
  ['unknown_fraction', 'url(#p-unknown)'],
] as const;

function fractionAreas(samples: readonly (TargetReport | null)[], width: number): SVGElement[] {
  const isUnknown = samples.map((sample) => sample?.occluded_fraction == null);
  const layers = fractionFills.map(([key]) => samples.map((sample) => sample?.[key] ?? 0));
  const fills = fractionFills.map(([, fill]) => fill);
  const line = svg('path', { d: `M0 ${fractionHeight - 0.5}H${width}`, class: 'base-line' });
  return [
    ...gaps(isUnknown, width, fractionHeight),
    ...stackedAreas(layers, fills, width, fractionHeight),
    line,
  ];
}

/** Marks columns without values. */
function gaps(isUnknown: readonly boolean[], width: number, height: number): SVGElement[] {
  const runs = runsOf(isUnknown).filter((run) => run.value);
  const boxes = runs.map((run) => ({ ...span(run, isUnknown.length, width), y: 1 }));
  return boxes.map((box) => svg('rect', { ...box, height: height - 1, fill: 'url(#p-none)' }));
}

/** Draws layers of values from 0 to 1 on top of each other. */
function stackedAreas(
  layers: readonly (readonly number[])[],
  fills: readonly string[],
  width: number,
  height: number,
): SVGElement[] {
  let below = (layers[0] ?? []).map(() => 0);
  return layers.map((values, index) => {
    const above = below.map((low, i) => Math.min(1, low + (values[i] ?? 0)));
    const d = areaPath(below, above, width, height);
    below = above;
    return svg('path', { d, fill: fills[index] ?? '', class: 'area' });
  });
}

function areaPath(
  low: readonly number[],
  high: readonly number[],
  width: number,
  height: number,
): string {
  const x = (i: number): string => ((i * width) / high.length).toFixed(1);
  const y = (value: number): string => (height - value * (height - 1)).toFixed(1);
  const upper = high.map((value, i) => `${i ? 'L' : 'M'}${x(i)} ${y(value)}H${x(i + 1)}`);
  const lower = low.map((value, i) => `L${x(i + 1)} ${y(value)}H${x(i)}`).reverse();
  return `${upper.join('')}${lower.join('')}Z`;
}

const span = (run: Run<unknown>, count: number, width: number): { x: number; width: number } => ({
  x: (run.from * width) / count,
  width: ((run.to - run.from) * width) / count,
});

function verdictStrip(samples: readonly (TargetReport | null)[], width: number): SVGElement[] {
  const keys = samples.map((sample) => sample && `${verdictOf(sample)}\n${hiderOf(sample)}`);
  return runsOf(keys).flatMap((run) => {
    const sample = samples[run.from];
    const at = span(run, samples.length, width);
    const box = { ...at, y: fractionHeight + 1, height: stripHeight - 2 };
    if (!sample) return [svg('rect', { ...box, fill: 'url(#p-none)' })];
    const verdict = verdictOf(sample);
    const fill = verdictFills[verdict];
    const shape = svg('rect', { ...box, fill, class: `strip ${verdict}` });
    const text = hiderOf(sample);
    if (!text || text.length * characterWidth + 8 > at.width) return [shape];
    const middle = { x: at.x + at.width / 2, y: fractionHeight + stripHeight - 4 };
    return [shape, svg('text', { ...middle, 'text-anchor': 'middle', class: 'blame' }, text)];
  });
}

const forecastHeight = 5;

/** Draws what was forecast at a frame, above what then happened. */
export function forecastStrip(
  spans: readonly ForecastSpan[],
  count: number,
  width: number,
): SVGSVGElement {
  const chart = rowSvg(width, forecastHeight, 'forecast');
  chart.classList.add('forecast');
  for (const { from, to, verdict } of spans) {
    const at = span({ from, to, value: verdict }, count, width);
    const box = { ...at, y: 0, height: forecastHeight, fill: verdictFills[verdict] };
    chart.append(svg('rect', { ...box, class: `strip ${verdict}` }));
  }
  return chart;
}

/** Returns what hides most of a partial or hidden target. */
const hiderOf = (target: TargetReport): string =>
  ['partial', 'hidden'].includes(target.verdict) ? (hidersOf(target)[0] ?? '') : '';

function sourceLines(samples: readonly (TargetReport | null)[], width: number): SVGElement[] {
  const y = fractionHeight + stripHeight + sourceHeight / 2;
  return runsOf(samples.map((sample) => sample?.handled?.source ?? 'lost')).flatMap((run) => {
    if (run.value === 'lost') return [];
    const at = span(run, samples.length, width);
    const d = `M${at.x + 0.5} ${y}H${at.x + at.width - 0.5}`;
    return [svg('path', { d, class: `source ${run.value}` })];
  });
}

export function statusChart(frames: readonly FrameReport[], width: number): SVGSVGElement {
  const all = frames.map((frame) => frame.status);
  const bad = all.filter((status) => status !== 'ok').length;
  const statuses = condense(all, Math.floor(width), (a, b) => (a === 'ok' ? b : a));
  const chart = rowSvg(width, stripHeight, `${bad} of ${frames.length} frames are not ok`);
  for (const run of runsOf(statuses)) {
    const at = span(run, statuses.length, width);
    const isBad = run.value !== 'ok';
    const fill = isBad ? 'url(#p-fault)' : 'var(--line)';
    chart.append(svg('rect', { ...at, y: 2, height: 10, fill }));
    if (isBad && run.value.length * characterWidth + 8 < at.width)
      chart.append(svg('text', { x: at.x + 4, y: 10.5, class: 'blame' }, run.value));
  }
  return chart;
}

/** Draws stacked series, from zero to the largest sum. */
export function seriesChart(
  series: readonly (readonly (number | null)[])[],
  width: number,
  height: number,
  label: string,
): SVGSVGElement {
  const known = series.map((values) => condense(values, Math.floor(width), larger));
  const columns = known[0] ?? [];
  const sums = columns.map((_, i) => known.reduce((sum, values) => sum + (values[i] ?? 0), 0));
  const top = sums.reduce((a, b) => Math.max(a, b), Number.EPSILON);
  const isUnknown = columns.map((_, i) => known.every((values) => values[i] == null));
  const layers = known.map((values) => values.map((value) => (value ?? 0) / top));
  const fills = known.map((_, index) => `var(--series-${index})`);
  const chart = rowSvg(width, height, label);
  chart.append(...gaps(isUnknown, width, height), ...stackedAreas(layers, fills, width, height));
  return chart;
}

/** Returns the next larger step of 1, 2 or 5 times a power of ten. */
export function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  const found = [1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-9)) ?? 10;
  return found * power;
}

/** Draws times; the numbers of frames without stamps. */
export function axisChart(
  frames: readonly FrameReport[],
  times: readonly (number | null)[],
  width: number,
): SVGSVGElement {
  const chart = rowSvg(width, axisHeight, 'time axis');
  const every = Math.max(1, niceStep((times.length * tickDistance) / Math.max(width, 1)));
  const digits = (times.at(-1) ?? 0) > 20 ? 1 : 2;
  for (let frame = 0; frame < times.length; frame += every) {
    const x = ((frame + 0.5) * width) / times.length;
    const time = times[frame] ?? null;
    const text = time === null ? `${frames[frame]?.index}` : `${time.toFixed(digits)} s`;
    const anchor = frame === 0 && x < 20 ? 'start' : x > width - 20 ? 'end' : 'middle';
    chart.append(
      svg('path', { d: `M${x.toFixed(1)} 0V4`, class: 'tick' }),
      svg('text', { x: x.toFixed(1), y: 13.5, 'text-anchor': anchor, class: 'tick-text' }, text),
    );
  }
  return chart;
}

const verdictFills: Readonly<Record<Verdict, string>> = {
  visible: 'var(--v-visible)',
  partial: 'url(#p-partial)',
  hidden: 'url(#p-hidden)',
  unknown: 'url(#p-unknown)',
  out_of_view: 'none',
  held: 'var(--v-held)',
};

/** Adds fills that differ in pattern, too: stripes, grid, dots. */
export function addPatterns(): void {
  const lines = (d: string, stroke: string, opacity: number): SVGElement =>
    svg('path', { d, stroke, 'stroke-opacity': opacity });
  const partial = lines('M-1 7 7-1M2 10 10 2M-4 4 4-4', '#000', 0.45);
  const defs = svg(
    'defs',
    {},
    pattern('p-partial', 6, 'var(--v-partial)', partial),
    pattern('p-hidden', 5, 'var(--v-hidden)', lines('M0 0 5 5M5 0 0 5', '#000', 0.38)),
    pattern('p-unknown', 5, 'var(--v-unknown)', svg('circle', { cx: 2.5, cy: 2.5, r: 1.15 })),
    pattern('p-none', 6, 'none', lines('M-1 1 1-1M0 6 6 0M5 7 7 5', 'var(--muted)', 0.28)),
    pattern('p-fault', 6, '#b42318', lines('M0 0 6 6M6 0 0 6', '#fff', 0.4)),
  );
  document.body.append(svg('svg', { width: 0, height: 0, 'aria-hidden': 'true' }, defs));
}

function pattern(id: string, size: number, fill: string, marks: SVGElement): SVGPatternElement {
  const ground = svg('rect', { width: size, height: size, fill });
  const units = { patternUnits: 'userSpaceOnUse', width: size, height: size };
  return svg('pattern', { id, ...units }, ground, marks);
}
