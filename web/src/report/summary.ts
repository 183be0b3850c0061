// SPDX-License-Identifier: Apache-2.0
import type { FrameReport, Report, Summary } from '../api/types';
import { count, milliseconds, percent, seconds, stamp, turnedText } from '../model/format';
import { secondsOf } from '../model/timeline';
import { element } from '../view/dom';

export function headOf(report: Report): HTMLElement {
  const { backend = '?', isa, device } = report.renderer ?? {};
  const renderer = device ?? [backend, isa].filter(Boolean).join(', ');
  const first = report.frames.find((frame) => frame.stamp_ns !== null);
  const when = first ? ` · from ${stamp(first.stamp_ns)}` : '';
  return element(
    'header',
    '',
    element('h1', '', 'Penumbra report'),
    element('p', 'input', report.input),
    element('p', 'hint', `Penumbra ${report.penumbra} · ${renderer}${when}`),
  );
}

export function tilesOf({ frames, summary }: Report): HTMLElement {
  const duration = secondsOf(frames).findLast((time) => time !== null) ?? null;
  const pixels = summary?.pixels ?? {};
  const robot = pixels['robot'] ?? null;
  const fractionOf = (name: string): string => {
    const part = pixels[name] ?? null;
    return percent(robot && part !== null ? part / robot : null);
  };
  const { total, of } = medianOf(summary);
  const calibration = summary?.calibration;
  const bad = summary?.bad_frames ?? frames.filter((frame) => frame.status !== 'ok').length;
  return element(
    'div',
    'tiles',
    tile('frames', count(frames.length), duration === null ? '' : seconds(duration)),
    tile('bad frames', count(bad), bad ? statuses(frames) : 'all ok', bad > 0),
    tile('robot pixels', count(robot), `unknown ${fractionOf('unknown')}`),
    tile('front', fractionOf('front'), `beyond ${fractionOf('beyond')}`),
    ...(calibration
      ? [
          tile(
            'camera moved',
            `${calibration.moved_mm.toFixed(1)} mm`,
            `± ${calibration.moved_error_mm.toFixed(1)} mm, ${turnedText(calibration)}`,
            calibration.has_moved,
          ),
        ]
      : []),
    tile('median per frame', milliseconds(total), of),
  );
}

function tile(name: string, value: string, more: string, fault = false): HTMLElement {
  const lines = [element('span', 'hint', name), element('strong', '', value)];
  return element(
    'div',
    `panel tile${fault ? ' fault' : ''}`,
    ...lines,
    element('span', 'hint', more),
  );
}

/** Sums the known stages, and names them if others have no time. */
function medianOf(summary: Summary | null): { total: number | null; of: string } {
  const stages = Object.entries(summary?.timing_ms ?? {});
  const known = stages.flatMap(([name, time]) => (time ? [{ name, median: time.median }] : []));
  if (known.length === 0) return { total: null, of: 'not measured' };
  const total = known.reduce((sum, { median }) => sum + median, 0);
  const names = known.map(({ name }) => name).join(', ');
  return { total, of: known.length === stages.length ? 'all stages' : names };
}

function statuses(frames: readonly FrameReport[]): string {
  const counts = new Map<string, number>();
  for (const { status } of frames)
    if (status !== 'ok') counts.set(status, (counts.get(status) ?? 0) + 1);
  return [...counts].map(([status, times]) => `${status} ${times}`).join(', ');
}

/** Returns the run's notes, faults and missing links. */
export function notesOf({ summary }: Report): HTMLElement[] {
  const lines = [
    ...(summary?.notes ?? []).map(textOf),
    ...(summary?.faults ?? []).map(textOf),
    ...(summary?.missing_links ?? []).map((link) => `not rendered: ${textOf(link)}`),
  ];
  if (lines.length === 0) return [];
  const items = lines.map((line) => element('li', '', line));
  return [element('section', 'notes', element('h2', '', 'Notes'), element('ul', '', ...items))];
}

function textOf(value: unknown): string {
  if (typeof value !== 'object' || value === null) return String(value);
  const parts = Object.entries(value).map(([key, part]) => `${key}: ${textOf(part)}`);
  return parts.join(', ');
}
