// SPDX-License-Identifier: Apache-2.0
// Rows of targets, frame status, stage times and joint ages over one axis of frames, with a playhead
// and a tooltip at the pointer.
import type { FrameReport } from '../api/types';
import { forecastSpans } from '../model/forecast';
import { milliseconds, seconds, unknownText } from '../model/format';
import { verdictNames, verdictOf, verdicts } from '../model/labels';
import { hiddenText, larger, secondsOf, tracksOf, type Track } from '../model/timeline';
import { element, setText, swatch } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';
import {
  addPatterns,
  axisChart,
  forecastStrip,
  seriesChart,
  statusChart,
  targetChart,
} from './charts';

export interface TimelineHandlers {
  seek(frame: number): void;
  select(target: string): void;
}

interface Row {
  readonly head: HTMLElement;
  readonly chart: HTMLElement;
  draw(width: number): SVGSVGElement;
  /** Returns the tooltip's lines for a frame; each starts with a line break. */
  tooltip(frame: number): string;
  /** Returns the text of the head's last element, for example the largest value. */
  scale(): string;
}

export const stages = ['kinematics', 'render', 'classify', 'targets'] as const;
const stageHeight = 30;
const ageHeight = 18;

export class TimelineView {
  tracks: readonly Track[] = [];
  times: readonly (number | null)[] = [];
  frames: readonly FrameReport[] = [];
  private rows: readonly Row[] = [];
  private heads: ReadonlyMap<string, HTMLButtonElement> | null = null; // of targets, by name
  private current = 0;
  private report: FrameReport | undefined;
  private selected: string | null = null;
  private width = 0;
  private readonly grid = element('div', 'timeline-grid');
  private readonly playhead = element('div', 'playhead');
  private readonly tooltip = element('div', 'tooltip');

  constructor(
    private readonly host: HTMLElement,
    private readonly handlers: TimelineHandlers,
  ) {
    addPatterns();
    Object.assign(this.playhead, {
      role: 'slider',
      ariaLabel: 'Frame',
      ariaValueMin: '0',
      tabIndex: 0,
    });
    this.tooltip.hidden = true;
    host.replaceChildren(this.grid, this.playhead, this.tooltip);
    host.addEventListener('pointerdown', (event) => this.press(event));
    host.addEventListener('pointermove', (event) => this.move(event));
    host.addEventListener('pointerleave', () => (this.tooltip.hidden = true));
    new ResizeObserver(() => this.redraw(false)).observe(host);
  }

  setFrames(frames: readonly FrameReport[]): void {
    this.frames = frames;
    this.tracks = tracksOf(frames);
    this.times = secondsOf(frames);
    const names = this.tracks.map(({ name }) => name);
    if (!this.heads || names.join('\n') !== [...this.heads.keys()].join('\n')) this.build();
    this.redraw(true);
    this.setCurrent(this.current, this.report);
  }

  /** @param report the frame's report, if it is newer than the timeline's frames */
  setCurrent(frame: number, report = this.frames[frame]): void {
    this.current = frame;
    this.report = report;
    const count = Math.max(this.frames.length, 1);
    this.host.style.setProperty('--at', String((Math.min(frame, count - 1) + 0.5) / count));
    this.playhead.ariaValueMax = String(count - 1);
    this.playhead.ariaValueNow = String(frame);
    this.playhead.ariaValueText = this.titleOf(frame);
    for (const [name, head] of this.heads ?? []) {
      const target = report?.targets.find((one) => one.name === name);
      const verdict = target ? verdictOf(target) : 'unknown';
      const icon = head.querySelector('svg');
      if (!icon?.classList.contains(verdict)) icon?.replaceWith(verdictIcon(verdict));
    }
    this.showForecasts();
  }

  /** Draws the current frame's forecasts ahead of the playhead. */
  private showForecasts(): void {
    for (const { head, chart } of this.rows) {
      chart.querySelector('.forecast')?.remove();
      const name = [...(this.heads ?? [])].find(([, one]) => one === head)?.[0];
      const target = this.report?.targets.find((one) => one.name === name);
      if (!target?.forecast?.length || this.width === 0) continue;
      const spans = forecastSpans(target.forecast, this.times, this.current);
      chart.append(forecastStrip(spans, this.frames.length, this.width));
    }
  }

  select(target: string | null): void {
    this.selected = target;
    for (const [name, head] of this.heads ?? []) head.ariaPressed = String(name === target);
  }

  private build(): void {
    this.heads = new Map(this.tracks.map(({ name }) => [name, this.targetHead(name)]));
    const statusLine = (frame: number): string => this.statusLine(frame);
    this.rows = [
      ...[...this.heads].map(([name, head]) => this.targetRow(name, head)),
      plainRow('frames', 'Frames', {
        draw: (width) => statusChart(this.frames, width),
        tooltip: statusLine,
        scale: () => `${this.frames.filter((frame) => frame.status !== 'ok').length} bad`,
      }),
      plainRow('stages', 'Stages', {
        draw: (width) => seriesChart(this.stageTimes(), width, stageHeight, 'time of each stage'),
        tooltip: (frame) => {
          const times = this.frames[frame]?.timing_ms;
          return stages.map((stage) => `\n${stage} ${milliseconds(times?.[stage])}`).join('');
        },
        scale: () => maxOf(this.stageSums()),
      }),
      plainRow('ages', 'Joint age', {
        draw: (width) => seriesChart([this.ages()], width, ageHeight, 'age of the joint positions'),
        tooltip: (frame) => `\njoint age ${milliseconds(this.frames[frame]?.joint_age_ms)}`,
        scale: () => maxOf(this.ages()),
      }),
      plainRow('axis', '', {
        draw: (width) => axisChart(this.frames, this.times, width),
        tooltip: statusLine,
        scale: () => '',
      }),
    ];
    this.grid.replaceChildren(...this.rows.flatMap(({ head, chart }) => [head, chart]));
    this.select(this.selected);
  }

  private targetHead(name: string): HTMLButtonElement {
    const text = element('span', '', name);
    const head = element('button', 'row-head', verdictIcon('unknown'), text);
    head.type = 'button';
    head.title = name;
    head.addEventListener('click', () => this.handlers.select(name));
    return head;
  }

  private targetRow(name: string, head: HTMLElement): Row {
    const track = (): Track =>
      this.tracks.find((one) => one.name === name) ?? { name, samples: [] };
    return {
      head,
      chart: element('div', 'row-body target-row'),
      draw: (width) => targetChart(track(), width, `${name}: occluded fraction and verdict`),
      tooltip: (frame) => this.targetLine(frame, name),
      scale: () => name,
    };
  }

  private stageTimes(): (number | null)[][] {
    return stages.map((stage) => this.frames.map((frame) => frame.timing_ms?.[stage] ?? null));
  }

  private stageSums(): (number | null)[] {
    return this.frames.map(({ timing_ms }) => {
      const times = stages.flatMap((stage) => timing_ms?.[stage] ?? []);
      return times.length > 0 ? times.reduce((a, b) => a + b) : null;
    });
  }

  private ages(): (number | null)[] {
    return this.frames.map(({ joint_age_ms: ms }) => (ms == null ? null : Math.abs(ms)));
  }

  private titleOf(frame: number): string {
    const time = this.times[frame] ?? null;
    const number = this.frames[frame]?.index ?? frame;
    return `frame ${number}${time === null ? '' : ` · ${seconds(time, 3)}`}`;
  }

  private statusLine(frame: number): string {
    const report = this.frames[frame];
    return !report || report.status === 'ok' ? '' : `\n${report.status}: ${report.message ?? ''}`;
  }

  private targetLine(frame: number, name: string): string {
    const target = this.frames[frame]?.targets.find((one) => one.name === name);
    if (!target) return this.statusLine(frame);
    const parts = [verdictNames[verdictOf(target)], hiddenText(target), target.reason];
    return `\n${name}: ${parts.filter(Boolean).join(' · ')}`;
  }

  /** @param always even if the width did not change */
  private redraw(always: boolean): void {
    const width = this.rows[0]?.chart.clientWidth ?? 0;
    if (width === 0 || (width === this.width && !always) || this.frames.length === 0) return;
    this.width = width;
    for (const { head, chart, draw, scale } of this.rows) {
      chart.replaceChildren(draw(width));
      setText(head.lastElementChild as HTMLElement, scale());
    }
    this.showForecasts();
  }

  private frameAt(clientX: number): number | null {
    const box = this.rows[0]?.chart.getBoundingClientRect();
    if (!box || clientX < box.left - 4 || clientX > box.right + 4) return null;
    const frame = Math.floor(((clientX - box.left) / box.width) * this.frames.length);
    return Math.min(Math.max(frame, 0), this.frames.length - 1);
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0 || (event.target as Element).closest('button')) return;
    const frame = this.frameAt(event.clientX);
    if (frame === null) return;
    if (event.pointerType === 'mouse') this.host.setPointerCapture(event.pointerId);
    this.handlers.seek(frame);
  }

  private move(event: PointerEvent): void {
    const frame = this.frameAt(event.clientX);
    if (frame !== null && event.buttons === 1 && frame !== this.current) this.handlers.seek(frame);
    this.tooltip.hidden = frame === null || event.pointerType === 'touch';
    if (frame === null) return;
    const hovered = this.rows.find(({ chart }) => {
      const { top, bottom } = chart.getBoundingClientRect();
      return event.clientY >= top && event.clientY <= bottom;
    });
    setText(this.tooltip, `${this.titleOf(frame)}${hovered?.tooltip(frame) ?? ''}`);
    const box = this.host.getBoundingClientRect();
    this.tooltip.style.left = `${event.clientX - box.left}px`;
    this.tooltip.style.top = `${event.clientY - box.top + this.host.scrollTop}px`;
    this.tooltip.classList.toggle('left', event.clientX > box.left + 0.65 * box.width);
  }
}

const maxOf = (values: readonly (number | null)[]): string => {
  const max = values.reduce(larger, null);
  return max === null ? unknownText : `≤ ${milliseconds(max)}`;
};

function plainRow(kind: string, title: string, rest: Pick<Row, 'draw' | 'tooltip' | 'scale'>): Row {
  const names = [element('span', '', title), element('span', 'scale')];
  const head = element('div', `row-head plain ${kind}`, ...names);
  return { head, chart: element('div', `row-body ${kind}`), ...rest };
}

/** Returns the legend of verdicts, areas and lines. */
export function timelineLegend(): HTMLElement[] {
  const group = (title: string, entries: readonly (readonly [Element, string])[]): HTMLElement => {
    const spans = entries.map(([box, name]) => element('span', 'legend-entry', box, name));
    return element('div', 'legend-group', element('b', '', title), ...spans);
  };
  const line = (source: string): Element => element('i', `swatch line ${source}`);
  return [
    group(
      'Verdict',
      verdicts.map((verdict) => [verdictIcon(verdict), verdictNames[verdict]]),
    ),
    group('Hidden', [
      [swatch('--l-occluded'), 'by robot'],
      [swatch('--l-other'), 'by others'],
      [swatch('--l-unknown'), 'unknown'],
    ]),
    group('Position', [
      [line('measured'), 'measured'],
      [line('predicted'), 'predicted'],
      [line('held'), 'kept'],
    ]),
  ];
}
