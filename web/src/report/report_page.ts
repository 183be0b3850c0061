// SPDX-License-Identifier: Apache-2.0
import type { Report } from '../api/types';
import { milliseconds } from '../model/format';
import { verdictOf } from '../model/labels';
import { TimelineView } from '../timeline/timeline_view';
import { element } from '../view/dom';
import { frameDetails } from '../view/frame_panel';
import { targetDetails, targetList } from '../view/target_panel';
import { verdictIcon } from '../view/verdict_icon';
import { keyFrames, type KeyFrame } from './key_frames';
import { card, onFrameKeys, row, section, timelinePanel } from './parts';
import { headOf, notesOf, tilesOf } from './summary';
import { targetsTable } from './targets_table';

/** The whole page; a frame and a target are chosen in its timeline, tables and pictures. */
export class ReportPage {
  private frame = 0;
  private target: string | null;
  private readonly details = element('div', 'report-details');
  private readonly timeline: TimelineView;

  constructor(
    host: HTMLElement,
    private readonly report: Report,
    pictures: readonly KeyFrame[],
  ) {
    const [chart, panel] = timelinePanel();
    this.timeline = new TimelineView(chart, {
      seek: (frame) => this.seek(frame),
      choose: (name) => this.choose(name),
    });
    this.target = report.frames[0]?.targets[0]?.name ?? null;
    this.timeline.setFrames(report.frames);
    const frames = {
      numberOf: (frame: number) => this.numberOf(frame),
      seek: (frame: number) => this.seek(frame),
    };
    host.replaceChildren(
      headOf(report),
      tilesOf(report),
      ...notesOf(report),
      section('Timeline', panel, this.details),
      section('Targets', targetsTable(this.timeline.tracks, frames)),
      ...(pictures.length ? [section('Key frames', this.pictures(pictures))] : []),
      stageTable(report),
    );
    this.choose(this.target);
    onFrameKeys(
      () => this.frame,
      (frame) => this.seek(frame),
    );
  }

  private numberOf(frame: number): string {
    return String(this.report.frames[frame]?.index ?? frame);
  }

  private pictures(pictures: readonly KeyFrame[]): HTMLElement {
    const captionOf = ({ index }: KeyFrame): (Node | string)[] => {
      const targets = this.report.frames[index]?.targets ?? [];
      const verdicts = targets.map(({ name, verdict }) =>
        element('span', 'legend-entry', verdictIcon(verdictOf(verdict)), name),
      );
      return [element('b', '', `frame ${this.numberOf(index)}`), ...verdicts];
    };
    const known = pictures.filter(({ index }) => this.report.frames[index]);
    return keyFrames(known, captionOf, (frame) => this.seek(frame));
  }

  private seek(frame: number): void {
    this.frame = Math.max(0, Math.min(frame, this.report.frames.length - 1));
    this.show();
  }

  private choose(name: string | null): void {
    this.target = name;
    this.timeline.setChosen(name);
    this.show();
  }

  private show(): void {
    const frame = this.report.frames[this.frame];
    this.timeline.setCurrent(this.frame);
    if (!frame) return;
    const target = frame.targets.find((one) => one.name === this.target);
    this.details.replaceChildren(
      card(`Frame ${frame.index}`, frameDetails(frame)),
      card(
        'Targets',
        targetList(frame, this.target, (name) => this.choose(name)),
      ),
      ...(target ? [card(target.name, targetDetails(target))] : []),
    );
  }
}

function stageTable({ summary }: Report): HTMLElement {
  const table = element('table', '', row('th', ['stage', 'median', 'p99', 'max']));
  for (const [stage, time] of Object.entries(summary?.timing_ms ?? {}))
    table.append(row('td', [stage, ...[time?.median, time?.p99, time?.max].map(milliseconds)]));
  return section('Stage times', element('div', 'panel card scroll', table));
}
