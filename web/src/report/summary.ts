// SPDX-License-Identifier: Apache-2.0
import type { FrameReport, Report, Summary, TargetReport } from '../api/types';
import { count, milliseconds, percent, seconds, stamp, turnedText } from '../model/format';
import { verdictNames, verdictOf, verdicts } from '../model/labels';
import { notesOf as notesWithoutDiagnosis, plainText, setupText } from '../model/notes';
import {
  countOf,
  hiddenFraction,
  hidersOf,
  mostHidden,
  secondsOf,
  worse,
  type Track,
} from '../model/timeline';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';
import { headOf, notes } from './parts';

export function runHead(report: Report): HTMLElement {
  const { backend = '?', isa, device } = report.renderer ?? {};
  const renderer = device ?? [backend, isa].filter(Boolean).join(', ');
  const first = report.frames.find((frame) => frame.stamp_ns !== null);
  const when = first ? ` · from ${stamp(first.stamp_ns)}` : '';
  return headOf('Penumbra report', report, ` · ${renderer}${when}`);
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
    tile('robot pixels', count(robot), `${fractionOf('unknown')} not measured`),
    tile('something in front', fractionOf('front'), `${fractionOf('beyond')} past its model`),
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

/** Returns a card per target: in how many frames it is visible, and how much is hidden at worst. */
export function targetTiles(tracks: readonly Track[]): HTMLElement {
  return element('div', 'tiles targets', ...tracks.map(targetTile));
}

function targetTile({ name, samples }: Track): HTMLElement {
  const known = samples.filter((sample) => sample !== null);
  const worst = known.reduce<TargetReport | null>(worse, known[0] ?? null);
  const others = verdicts.filter((one) => one !== 'visible' && countOf(known, one) > 0);
  const made = tile(
    name,
    `visible ${countOf(known, 'visible')} of ${known.length}`,
    others.map((verdict) => `${verdictNames[verdict]} ${countOf(known, verdict)}`).join(', '),
  );
  if (worst) made.firstElementChild?.prepend(verdictIcon(verdictOf(worst)));
  const most = mostHidden(samples);
  const by = most ? hidersOf(most)[0] : undefined;
  if (most && by)
    made.append(
      element('span', 'hint', `at worst ${percent(hiddenFraction(most), 0)} hidden, by ${by}`),
    );
  return made;
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

/** Returns what is wrong with the setup, with a button for the frame that shows it. */
export function diagnosisOf({ summary }: Report, seek: (index: number) => void): HTMLElement[] {
  if (!summary?.diagnosis) return [];
  const { diagnosis } = summary;
  const button = element('button', '', `Show frame ${diagnosis.frame}`);
  button.addEventListener('click', () => seek(diagnosis.frame));
  return [element('p', 'diagnosis', setupText(diagnosis), ' ', button)];
}

/** Returns the run's notes, faults and missing links. */
export function notesOf({ summary }: Report): HTMLElement[] {
  return notes([
    ...notesWithoutDiagnosis(summary).map(plainText),
    ...(summary?.faults ?? []).map(textOf),
    ...(summary?.missing_links ?? []).map((link) => `not rendered: ${textOf(link)}`),
  ]);
}

function textOf(value: unknown): string {
  if (typeof value !== 'object' || value === null) return String(value);
  const parts = Object.entries(value).map(([key, part]) => `${key}: ${textOf(part)}`);
  return parts.join(', ');
}
