// SPDX-License-Identifier: Apache-2.0
// The timeline's rows as SVG: as wide as the screen's pixels, whatever the number of frames.
import type { FrameReport, Verdict } from '../api/types';
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

const fractionHeight = 26;
const stripHeight = 14;
const sourceHeight = 6;
const axisHeight = 16;
const pixelsBetweenTicks = 90;
const characterWidth = 6.2; // of the blame's text, pixels

function rowSvg(width: number, height: number, label: string): SVGSVGElement {
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

const partFills = [
  ['occluded', 'var(--l-occluded)'],
  ['other', 'var(--l-other)'],
  ['unknown', 'url(#p-unknown)'],
] as const;

function stack(samples: readonly (Sample | null)[], width: number): SVGElement[] {
  const base = samples.map(() => 0);
  const layers = partFills.map(([part, fill]) => {
    const below = base.slice();
    samples.forEach((sample, i) => (base[i] = Math.min(1, (base[i] ?? 0) + (sample?.[part] ?? 0))));
    return areaPath(below, base.slice(), width, fractionHeight, fill);
  });
  const isUnknown = samples.map((sample) => sample?.occluded == null);
  const line = svg('path', { d: `M0 ${fractionHeight - 0.5}H${width}`, class: 'base-line' });
  return [...gaps(isUnknown, width, fractionHeight), ...layers, line];
}

/** Where nothing is known. */
function gaps(isUnknown: readonly boolean[], width: number, height: number): SVGElement[] {
  const runs = runsOf(isUnknown).filter((run) => run.value);
  const boxes = runs.map((run) => ({ ...span(run, isUnknown.length, width), y: 1 }));
  return boxes.map((box) => svg('rect', { ...box, height: height - 1, fill: 'url(#p-none)' }));
}

function areaPath(
  low: readonly number[],
  high: readonly number[],
  width: number,
  height: number,
  fill: string,
): SVGPathElement {
  const x = (i: number): string => ((i * width) / high.length).toFixed(1);
  const y = (value: number): string => (height - value * (height - 1)).toFixed(1);
  let path = '';
  high.forEach((value, i) => (path += `${i ? 'L' : 'M'}${x(i)} ${y(value)}H${x(i + 1)}`));
  for (let i = low.length - 1; i >= 0; --i) path += `L${x(i + 1)} ${y(low[i] as number)}H${x(i)}`;
  return svg('path', { d: `${path}Z`, fill, class: 'area' });
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
    if (!sample) return [svg('rect', { ...box, fill: 'url(#p-none)' })];
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
    const fill = fault ? 'url(#p-fault)' : 'var(--line)';
    chart.append(svg('rect', { ...at, y: 2, height: 10, fill }));
    if (fault && run.value.length * characterWidth + 8 < at.width)
      chart.append(svg('text', { x: at.x + 4, y: 10.5, class: 'blame' }, run.value));
  }
  return chart;
}

/** Stacked series of a unit from zero to the largest sum; null: nothing known. */
export function seriesChart(
  series: readonly (readonly (number | null)[])[],
  width: number,
  height: number,
  label: string,
): SVGSVGElement {
  const columns = Math.floor(width);
  const larger = (a: number | null, b: number | null): number | null =>
    a === null ? b : b === null ? a : Math.max(a, b);
  const known = series.map((values) => condense(values, columns, larger));
  const layers = known.map((values) => values.map((value) => value ?? 0));
  const sums = (layers[0] ?? []).map((_, i) => layers.reduce((sum, one) => sum + (one[i] ?? 0), 0));
  const top = Math.max(...sums, Number.EPSILON);
  const chart = rowSvg(width, height, label);
  const isUnknown = sums.map((_, i) => known.every((values) => (values[i] ?? null) === null));
  chart.append(...gaps(isUnknown, width, height));
  let below = sums.map(() => 0);
  layers.forEach((values, index) => {
    const above = below.map((low, i) => low + (values[i] ?? 0) / top);
    chart.append(areaPath(below, above, width, height, `var(--series-${index})`));
    below = above;
  });
  return chart;
}

/** Steps of 1, 2 or 5 times a power of ten. */
export function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  const found = [1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-9)) ?? 10;
  return found * power;
}

/** Times where the frames have stamps, else their numbers. */
export function axisChart(
  frames: readonly FrameReport[],
  times: readonly (number | null)[],
  width: number,
): SVGSVGElement {
  const chart = rowSvg(width, axisHeight, 'axis of time');
  const every = Math.max(1, niceStep((times.length * pixelsBetweenTicks) / Math.max(width, 1)));
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

const verdictFill: Readonly<Record<Verdict, string>> = {
  visible: 'var(--v-visible)',
  partial: 'url(#p-partial)',
  hidden: 'url(#p-hidden)',
  unknown: 'url(#p-unknown)',
  out_of_view: 'none',
};

/** Fills that differ without colour too: plain, stripes, grid, dots, nothing. */
export function addPatterns(): void {
  const lines = (d: string, stroke: string, opacity: number): SVGElement =>
    svg('path', { d, stroke, 'stroke-opacity': opacity });
  const defs = svg(
    'defs',
    {},
    pattern(
      'p-partial',
      6,
      'var(--v-partial)',
      lines('M-1 7 7-1M2 10 10 2M-4 4 4-4', '#000', 0.45),
    ),
    pattern('p-hidden', 5, 'var(--v-hidden)', lines('M0 0 5 5M5 0 0 5', '#000', 0.38)),
    pattern('p-unknown', 5, 'var(--v-unknown)', svg('circle', { cx: 2.5, cy: 2.5, r: 1.15 })),
    pattern('p-none', 6, 'none', lines('M-1 1 1-1M0 6 6 0M5 7 7 5', 'var(--soft)', 0.28)),
    pattern('p-fault', 6, '#b42318', lines('M0 0 6 6M6 0 0 6', '#fff', 0.4)),
  );
  document.body.append(svg('svg', { width: 0, height: 0, 'aria-hidden': 'true' }, defs));
}

function pattern(id: string, size: number, fill: string, marks: SVGElement): SVGPatternElement {
  const ground = svg('rect', { width: size, height: size, fill });
  const units = { patternUnits: 'userSpaceOnUse', width: size, height: size };
  return svg('pattern', { id, ...units }, ground, marks);
}
