// SPDX-License-Identifier: Apache-2.0
import type { Source, TargetReport, Verdict } from '../api/types';
import { percent } from '../model/format';
import { verdictNames, verdictOf, verdicts } from '../model/labels';
import {
  hiddenFraction,
  hiddenText,
  hidersOf,
  mostHidden,
  onsets,
  runsOf,
  worse,
  type Track,
} from '../model/timeline';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';

const sources: readonly Source[] = ['measured', 'predicted', 'held', 'lost'];
const maxOnsets = 12;

interface Frames {
  numberOf(frame: number): string;
  seek(frame: number): void;
}

/** Returns per target the number of frames of each verdict, the worst occlusion, and all onsets. */
export function targetsTable(tracks: readonly Track[], frames: Frames): HTMLElement {
  if (tracks.length === 0) return element('p', 'hint', 'No targets.');
  const head = element('tr', '', element('th', '', 'target'));
  const counted = verdicts.filter((verdict) =>
    tracks.some(({ samples }) => samples.some((one) => one && verdictOf(one) === verdict)),
  );
  for (const verdict of counted)
    head.append(element('th', '', verdictIcon(verdict), verdictNames[verdict]));
  head.append(element('th', '', 'max hidden'));
  for (const title of ['by', 'position', 'starts in frame'])
    head.append(element('th', 'text', title));
  const table = element('table', '', head);
  for (const track of tracks) table.append(rowOf(track, counted, frames));
  return element('div', 'panel card scroll', table);
}

function rowOf(track: Track, counted: readonly Verdict[], frames: Frames): HTMLTableRowElement {
  const row = element('tr', '', element('th', '', track.name));
  for (const verdict of counted) {
    const count = track.samples.filter((sample) => sample && verdictOf(sample) === verdict).length;
    row.append(element('td', count ? '' : 'none', String(count)));
  }
  const worst = mostHidden(track.samples);
  row.append(
    element('td', '', percent(worst && hiddenFraction(worst))),
    element('td', 'text', (worst && hidersOf(worst)[0]) ?? ''),
    element('td', 'text', handledText(track)),
    element('td', 'text', ...onsetButtons(track, frames)),
  );
  return row;
}

function handledText(track: Track): string {
  const parts = sources.map((source) => {
    const count = track.samples.filter((sample) => sample?.handled?.source === source).length;
    return count > 0 ? `${source} ${count}` : '';
  });
  return parts.filter(Boolean).join(', ');
}

function onsetButtons(track: Track, { numberOf, seek }: Frames): (Node | string)[] {
  const begin = onsets([track]);
  const shown: (Node | string)[] = begin.slice(0, maxOnsets).map((frame) => {
    const button = element('button', 'small', numberOf(frame));
    button.addEventListener('click', () => seek(frame));
    return button;
  });
  if (begin.length > maxOnsets) shown.push(` and ${begin.length - maxOnsets} more`);
  return shown;
}

/** Lists what each target is, and behind which links, from frame to frame; closed at first. */
export function verdictList(tracks: readonly Track[], frames: Frames): HTMLElement {
  const head = element('tr', '', element('th', '', 'frames'));
  for (const title of ['verdict', 'hidden']) head.append(element('th', 'text', title));
  const lists = tracks.map((track) => {
    const table = element('table', '', head.cloneNode(true));
    for (const { from, to } of runsOf(track.samples.map(stateOf))) {
      const sample = track.samples.slice(from, to).reduce(worse);
      if (!sample) continue;
      const button = element('button', 'small', spanOf(from, to, frames));
      button.addEventListener('click', () => frames.seek(from));
      table.append(
        element(
          'tr',
          '',
          element('td', '', button),
          element('td', 'text', verdictIcon(verdictOf(sample)), verdictNames[verdictOf(sample)]),
          element('td', 'text', hiddenText(sample)),
        ),
      );
    }
    const title = element('summary', '', `${track.name}, frame by frame`);
    return element('details', 'panel card scroll', title, table);
  });
  return element('div', '', ...lists);
}

/** Neighbouring frames of one state are one row. */
const stateOf = (sample: TargetReport | null): string =>
  sample ? [verdictOf(sample), ...hidersOf(sample)].join() : '';

const spanOf = (from: number, to: number, { numberOf }: Frames): string =>
  to - from === 1 ? numberOf(from) : `${numberOf(from)} to ${numberOf(to - 1)}`;
