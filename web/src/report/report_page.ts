// SPDX-License-Identifier: Apache-2.0
import type { Report } from '../api/types';
import { milliseconds } from '../model/format';
import { timelineLegend } from '../timeline/legend';
import { TimelineView } from '../timeline/timeline_view';
import { element } from '../view/dom';
import { frameDetails } from '../view/frame_panel';
import { targetDetails, targetList } from '../view/target_panel';
import { keyFrames, type KeyFrame } from './key_frames';
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
    const chart = element('div', '');
    chart.id = 'timeline';
    this.timeline = new TimelineView(chart, {
      seek: (frame) => this.seek(frame),
      choose: (name) => this.choose(name),
    });
    this.target = report.frames[0]?.targets[0]?.name ?? null;
    this.timeline.setFrames(report.frames);
    const legend = element('div', '', ...timelineLegend());
    legend.id = 'timeline-legend';
    const seek = (frame: number): void => this.seek(frame);
    host.replaceChildren(
      headOf(report),
      tilesOf(report),
      ...notesOf(report),
      section('Timeline', element('div', 'panel', legend, chart), this.details),
      section('Targets', targetsTable(report, this.timeline.tracks, seek)),
      ...(pictures.length ? [section('Key frames', keyFrames(pictures, report, seek))] : []),
      stageTable(report),
    );
    this.choose(this.target);
    document.addEventListener('keydown', (event) => this.key(event));
  }

  private key(event: KeyboardEvent): void {
    const by = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (by !== 0) this.seek(this.frame + by);
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

const section = (title: string, ...content: (Node | string)[]): HTMLElement =>
  element('section', '', element('h2', '', title), ...content);

const card = (title: string, content: Node): HTMLElement =>
  element('div', 'panel card', element('h3', '', title), content);

function stageTable({ summary }: Report): HTMLElement {
  const table = element('table', '', row('th', ['stage', 'median', 'p99', 'max']));
  for (const [stage, time] of Object.entries(summary?.timing_ms ?? {}))
    table.append(row('td', [stage, ...[time?.median, time?.p99, time?.max].map(milliseconds)]));
  return section('Stage times', element('div', 'panel card scroll', table));
}

const row = (tag: 'th' | 'td', cells: readonly string[]): HTMLTableRowElement =>
  element('tr', '', ...cells.map((cell) => element(tag, '', cell)));
