// SPDX-License-Identifier: Apache-2.0
import type { Report } from '../api/types';
import { milliseconds } from '../model/format';
import { verdictOf } from '../model/labels';
import { timelineLegend, TimelineView } from '../timeline/timeline_view';
import { element } from '../view/dom';
import { frameDetails } from '../view/frame_panel';
import { targetDetails, targetList } from '../view/target_panel';
import { verdictIcon } from '../view/verdict_icon';
import { card, section, tableCard, type Picture } from './parts';
import { diagnosisOf, notesOf, runHead, targetTiles, tilesOf } from './summary';
import { targetsTable, verdictList } from './targets_table';

/** The report of a run; its timeline, tables and images select a frame and a target. */
export class ReportPage {
  private frame = 0;
  private target: string | null;
  readonly content: readonly Node[];
  private readonly details = element('div', 'report-details');
  private readonly timeline: TimelineView;

  constructor(
    private readonly report: Report,
    images: readonly Picture[],
  ) {
    const chart = element('div');
    chart.id = 'timeline';
    const legend = element('div', '', ...timelineLegend());
    legend.id = 'timeline-legend';
    this.timeline = new TimelineView(chart, {
      seek: (frame) => this.seek(frame),
      select: (name) => this.select(name),
    });
    this.target = report.frames[0]?.targets[0]?.name ?? null;
    this.timeline.setFrames(report.frames);
    const frames = {
      numberOf: (frame: number) => this.numberOf(frame),
      seek: (frame: number) => this.seek(frame),
    };
    this.content = [
      runHead(report),
      ...diagnosisOf(report, (index) =>
        this.seek(report.frames.findIndex((frame) => frame.index === index)),
      ),
      ...notesOf(report),
      targetTiles(this.timeline.tracks),
      tilesOf(report),
      section('Timeline', element('div', 'panel', legend, chart), this.details),
      section(
        'Targets',
        targetsTable(this.timeline.tracks, frames),
        verdictList(this.timeline.tracks, frames),
      ),
      ...(images.length ? [section('Key frames', this.gallery(images))] : []),
      section('Stage times', stageTable(report)),
    ];
    this.select(this.target);
    document.addEventListener('keydown', (event) => this.key(event));
  }

  private numberOf(frame: number): string {
    return String(this.report.frames[frame]?.index ?? frame);
  }

  /** Returns the key frames; a click shows a frame in the timeline. */
  private gallery(images: readonly Picture[]): HTMLElement {
    const figures = images.flatMap(({ index, image }) => {
      const frame = this.report.frames[index];
      if (!frame) return [];
      const verdicts = frame.targets.map((target) =>
        element('span', 'legend-entry', verdictIcon(verdictOf(target)), target.name),
      );
      const title = `frame ${frame.index}`;
      const picture = element('img');
      picture.src = image;
      picture.alt = `overlay of ${title}`;
      const open = element('button', 'image', picture);
      open.title = 'Show in the timeline';
      open.addEventListener('click', () => this.seek(index));
      const caption = element('figcaption', '', element('b', '', title), ...verdicts);
      return [element('figure', 'panel', open, caption)];
    });
    return element('div', 'gallery', ...figures);
  }

  /** Arrow keys step. Home and End go to the ends if the playhead has the focus; else they scroll. */
  private key(event: KeyboardEvent): void {
    const { key, target } = event;
    if (key === 'ArrowRight' || key === 'ArrowLeft')
      this.seek(this.frame + (key === 'ArrowRight' ? 1 : -1));
    const isPlayhead = target instanceof Element && target.closest('[role=slider]') !== null;
    if (!isPlayhead || (key !== 'Home' && key !== 'End')) return;
    event.preventDefault();
    this.seek(key === 'Home' ? 0 : Infinity);
  }

  /** @param frame any number: shows the nearest frame */
  private seek(frame: number): void {
    this.frame = Math.max(0, Math.min(frame, this.report.frames.length - 1));
    this.show();
  }

  private select(name: string | null): void {
    this.target = name;
    this.timeline.select(name);
    this.show();
  }

  private show(): void {
    const frame = this.report.frames[this.frame];
    this.timeline.setCurrent(this.frame);
    if (!frame) return;
    const target = frame.targets.find((one) => one.name === this.target);
    const list = targetList(frame, this.target, (name) => this.select(name));
    this.details.replaceChildren(
      card('Targets', list),
      ...(target ? [card(target.name, targetDetails(target))] : []),
      card(`Frame ${frame.index}`, frameDetails(frame)),
    );
  }
}

const stageTable = ({ summary }: Report): HTMLElement =>
  tableCard(
    ['stage', 'median', 'p99', 'max'],
    Object.entries(summary?.timing_ms ?? {}).map(([stage, time]) => [
      stage,
      ...[time?.median, time?.p99, time?.max].map(milliseconds),
    ]),
  );
