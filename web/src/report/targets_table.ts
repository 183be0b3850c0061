// SPDX-License-Identifier: Apache-2.0
import type { Report, Source, Verdict } from '../api/types';
import { percent } from '../model/format';
import { verdictNames } from '../model/labels';
import { onsets } from '../model/occlusions';
import type { Sample, Track } from '../model/timeline';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';

const verdicts = Object.keys(verdictNames) as Verdict[];
const sources: readonly Source[] = ['measured', 'predicted', 'held', 'lost'];
const mostOnsets = 12;

/** How often each verdict was given, where occlusions began, and by which link. */
export function targetsTable(
  report: Report,
  tracks: readonly Track[],
  seek: (frame: number) => void,
): HTMLElement {
  if (tracks.length === 0) return element('p', 'hint', 'No targets were judged.');
  const head = element('tr', '', element('th', '', 'target'));
  for (const verdict of verdicts)
    head.append(element('th', '', verdictIcon(verdict), verdictNames[verdict]));
  const more = ['most occluded', 'by', 'handled', 'occlusions begin'];
  head.append(...more.map((title) => element('th', '', title)));
  const table = element('table', '', head);
  for (const track of tracks) table.append(rowOf(report, track, seek));
  return element('div', 'panel card scroll', table);
}

function rowOf(report: Report, track: Track, seek: (frame: number) => void): HTMLTableRowElement {
  const row = element('tr', '', element('th', '', track.name));
  for (const verdict of verdicts) {
    const times = track.samples.filter((sample) => sample?.verdict === verdict).length;
    row.append(element('td', times ? '' : 'none', String(times)));
  }
  const worst = mostOccluded(track);
  row.append(
    element('td', '', percent(worst?.occluded ?? null)),
    element('td', 'text', worst?.occluded ? (worst.blame ?? '') : ''),
    element('td', 'text', handledText(track)),
    element('td', 'text', ...onsetButtons(report, track, seek)),
  );
  return row;
}

function mostOccluded(track: Track): Sample | null {
  let most: Sample | null = null;
  for (const sample of track.samples)
    if ((sample?.occluded ?? -1) > (most?.occluded ?? -1)) most = sample;
  return most;
}

function handledText(track: Track): string {
  const parts = sources.map((source) => {
    const times = track.samples.filter((sample) => sample?.source === source).length;
    return times > 0 ? `${source} ${times}` : '';
  });
  return parts.filter(Boolean).join(', ');
}

function onsetButtons(
  report: Report,
  track: Track,
  seek: (frame: number) => void,
): (Node | string)[] {
  const frames = onsets([track]);
  const shown: (Node | string)[] = frames.slice(0, mostOnsets).map((frame) => {
    const button = element('button', 'small', String(report.frames[frame]?.index ?? frame));
    button.addEventListener('click', () => seek(frame));
    return button;
  });
  if (frames.length > mostOnsets) shown.push(` and ${frames.length - mostOnsets} more`);
  return shown;
}
