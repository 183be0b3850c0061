// SPDX-License-Identifier: Apache-2.0
import type { Source, Verdict } from '../api/types';
import { percent } from '../model/format';
import { verdictNames } from '../model/labels';
import { hiddenShare, hiderOf, onsets, type Sample, type Track } from '../model/timeline';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';

const verdicts = Object.keys(verdictNames) as Verdict[];
const sources: readonly Source[] = ['measured', 'predicted', 'held', 'lost'];
const mostOnsets = 12;

interface Frames {
  numberOf(frame: number): string;
  seek(frame: number): void;
}

/** How often each verdict was given, where occlusions began, and by which link. */
export function targetsTable(tracks: readonly Track[], frames: Frames): HTMLElement {
  if (tracks.length === 0) return element('p', 'hint', 'No targets were judged.');
  const head = element('tr', '', element('th', '', 'target'));
  for (const verdict of verdicts)
    head.append(element('th', '', verdictIcon(verdict), verdictNames[verdict]));
  const blames = tracks.some(({ samples }) =>
    samples.some((sample) => sample?.blame || sample?.other),
  );
  head.append(element('th', '', 'most hidden'));
  const more = [...(blames ? ['by'] : []), 'handled', 'occlusions begin'];
  head.append(...more.map((title) => element('th', 'text', title)));
  const table = element('table', '', head);
  for (const track of tracks) table.append(rowOf(track, blames, frames));
  return element('div', 'panel card scroll', table);
}

function rowOf(track: Track, blames: boolean, frames: Frames): HTMLTableRowElement {
  const row = element('tr', '', element('th', '', track.name));
  for (const verdict of verdicts) {
    const times = track.samples.filter((sample) => sample?.verdict === verdict).length;
    row.append(element('td', times ? '' : 'none', String(times)));
  }
  const worst = mostHidden(track);
  row.append(element('td', '', percent(worst && hiddenShare(worst))));
  if (blames) row.append(element('td', 'text', worst && hiddenShare(worst) ? hiderOf(worst) : ''));
  row.append(
    element('td', 'text', handledText(track)),
    element('td', 'text', ...onsetButtons(track, frames)),
  );
  return row;
}

function mostHidden(track: Track): Sample | null {
  const shareOf = (sample: Sample | null): number => (sample && hiddenShare(sample)) ?? -1;
  let most: Sample | null = null;
  for (const sample of track.samples) if (shareOf(sample) > shareOf(most)) most = sample;
  return most;
}

function handledText(track: Track): string {
  const parts = sources.map((source) => {
    const times = track.samples.filter((sample) => sample?.source === source).length;
    return times > 0 ? `${source} ${times}` : '';
  });
  return parts.filter(Boolean).join(', ');
}

function onsetButtons(track: Track, { numberOf, seek }: Frames): (Node | string)[] {
  const begin = onsets([track]);
  const shown: (Node | string)[] = begin.slice(0, mostOnsets).map((frame) => {
    const button = element('button', 'small', numberOf(frame));
    button.addEventListener('click', () => seek(frame));
    return button;
  });
  if (begin.length > mostOnsets) shown.push(` and ${begin.length - mostOnsets} more`);
  return shown;
}
