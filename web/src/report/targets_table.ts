// SPDX-License-Identifier: Apache-2.0
import type { Source, TargetReport } from '../api/types';
import { percent } from '../model/format';
import { verdictOf, verdicts } from '../model/labels';
import {
  countOf,
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
import { tableCard, tableDetails, verdictCell } from './parts';

const sources: readonly Source[] = ['measured', 'predicted', 'held', 'lost'];
const maxOnsets = 12;

interface Frames {
  numberOf(frame: number): string;
  seek(frame: number): void;
}

/** Returns per target the number of frames of each verdict, the worst occlusion, and all onsets. */
export function targetsTable(tracks: readonly Track[], frames: Frames): HTMLElement {
  if (tracks.length === 0) return element('p', 'hint', 'No targets.');
  const counted = verdicts.filter((verdict) =>
    tracks.some(({ samples }) => countOf(samples, verdict) > 0),
  );
  const rows = tracks.map((track) => {
    const worst = mostHidden(track.samples);
    return [
      track.name,
      ...counted.map((verdict) => String(countOf(track.samples, verdict))),
      percent(worst && hiddenFraction(worst)),
      (worst && hidersOf(worst)[0]) ?? '',
      handledText(track),
      onsetButtons(track, frames),
    ];
  });
  const more = ['max hidden', 'by', 'position', 'starts in frame'];
  return tableCard(['target', ...counted.map(verdictCell), ...more], rows);
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
  const lists = tracks.map((track) => {
    const rows = runsOf(track.samples.map(stateOf)).flatMap(({ from, to }) => {
      const sample = track.samples.slice(from, to).reduce(worse);
      if (!sample) return [];
      const button = element('button', 'small', spanOf(from, to, frames));
      button.addEventListener('click', () => frames.seek(from));
      return [[[button], verdictCell(verdictOf(sample)), hiddenText(sample)]];
    });
    return tableDetails(`${track.name}, frame by frame`, ['frames', 'verdict', 'hidden'], rows);
  });
  return element('div', '', ...lists);
}

/** Neighbouring frames of one state are one row. */
const stateOf = (sample: TargetReport | null): string =>
  sample ? [verdictOf(sample), ...hidersOf(sample)].join() : '';

const spanOf = (from: number, to: number, { numberOf }: Frames): string =>
  to - from === 1 ? numberOf(from) : `${numberOf(from)} to ${numberOf(to - 1)}`;
