// SPDX-License-Identifier: Apache-2.0
// Rows of all targets, the frames' status, stage times and joint ages over one axis of frames, with
// a playhead and a tip under the pointer.
import type { FrameReport, Verdict } from '../api/types';
import { milliseconds, seconds } from '../model/format';
import { verdictNames, verdictOf } from '../model/labels';
import { hiddenWords, largest, secondsOf, tracksOf, type Track } from '../model/timeline';
import { element, setText, swatch } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';
import { addPatterns, axisChart, seriesChart, statusChart, targetChart } from './charts';

export interface TimelineHandlers {
  seek(frame: number): void;
  choose(target: string): void;
}

interface Row {
  readonly head: HTMLElement;
  readonly chart: HTMLElement;
  draw(width: number): SVGSVGElement;
  /** What is said of a frame under the pointer; each line begins with a line break. */
  tip(frame: number): string;
  /** What stands beside the name, as the largest value. */
  scale(): string;
}

export const stages = ['kinematics', 'render', 'classify', 'targets'] as const;
const stageHeight = 30;
const ageHeight = 18;

export class TimelineView {
  tracks: readonly Track[] = [];
  times: readonly (number | null)[] = [];
  private frames: readonly FrameReport[] = [];
  private rows: readonly Row[] = [];
  private heads: ReadonlyMap<string, HTMLButtonElement> | null = null; // of targets, by name
  private current = 0;
  private report: FrameReport | undefined;
  private chosen: string | null = null;
  private width = 0;
  private readonly grid = element('div', 'timeline-grid');
  private readonly playhead = element('div', 'playhead');
  private readonly tip = element('div', 'tip');

  constructor(
    private readonly host: HTMLElement,
    private readonly handlers: TimelineHandlers,
  ) {
    addPatterns();
    this.playhead.setAttribute('role', 'slider');
    this.playhead.setAttribute('aria-label', 'Frame');
    this.playhead.setAttribute('aria-valuemin', '0');
    this.playhead.tabIndex = 0;
    this.tip.hidden = true;
    host.replaceChildren(this.grid, this.playhead, this.tip);
    host.addEventListener('pointerdown', (event) => this.press(event));
    host.addEventListener('pointermove', (event) => this.move(event));
    host.addEventListener('pointerleave', () => (this.tip.hidden = true));
    new ResizeObserver(() => this.redraw(false)).observe(host);
  }

  /** The number of the newest frame. */
  get lastIndex(): number {
    return this.frames.at(-1)?.index ?? 0;
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

  /** @param report the frame's own, where it is newer than those of the timeline */
  setCurrent(frame: number, report = this.frames[frame]): void {
    this.current = frame;
    this.report = report;
    const count = Math.max(this.frames.length, 1);
    this.host.style.setProperty('--at', String((Math.min(frame, count - 1) + 0.5) / count));
    this.playhead.setAttribute('aria-valuemax', String(count - 1));
    this.playhead.setAttribute('aria-valuenow', String(frame));
    this.playhead.setAttribute('aria-valuetext', this.titleOf(frame));
    for (const [name, head] of this.heads ?? []) {
      const target = report?.targets.find((one) => one.name === name);
      const verdict = verdictOf(target?.verdict ?? 'unknown'); // not told of: not known
      const icon = head.querySelector('svg');
      if (!icon?.classList.contains(verdict)) icon?.replaceWith(verdictIcon(verdict));
    }
  }

  setChosen(target: string | null): void {
    this.chosen = target;
    for (const [name, head] of this.heads ?? [])
      head.setAttribute('aria-pressed', String(name === target));
  }

  private build(): void {
    this.heads = new Map(this.tracks.map(({ name }) => [name, this.targetHead(name)]));
    const statusTip = (frame: number): string => this.statusTip(frame);
    this.rows = [
      ...[...this.heads].map(([name, head]) => this.targetRow(name, head)),
      plainRow('frames', 'Frames', {
        draw: (width) => statusChart(this.frames, width),
        tip: statusTip,
        scale: () => `${this.frames.filter((frame) => frame.status !== 'ok').length} bad`,
      }),
      plainRow('stages', 'Stages', {
        draw: (width) => seriesChart(this.stageTimes(), width, stageHeight, 'time of each stage'),
        tip: (frame) => {
          const times = this.frames[frame]?.timing_ms;
          return stages.map((stage) => `\n${stage} ${milliseconds(times?.[stage])}`).join('');
        },
        scale: () => this.stagesScale(),
      }),
      plainRow('ages', 'Joint age', {
        draw: (width) => seriesChart([this.ages()], width, ageHeight, 'age of the joint positions'),
        tip: (frame) => `\njoint age ${milliseconds(this.frames[frame]?.joint_age_ms)}`,
        scale: () => atMost(largest(this.ages())),
      }),
      plainRow('axis', '', {
        draw: (width) => axisChart(this.frames, this.times, width),
        tip: statusTip,
        scale: () => '',
      }),
    ];
    this.grid.replaceChildren(...this.rows.flatMap(({ head, chart }) => [head, chart]));
    this.setChosen(this.chosen);
  }

  private targetHead(name: string): HTMLButtonElement {
    const head = element('button', 'row-head', verdictIcon('unknown'), element('span', '', name));
    head.type = 'button';
    head.title = name;
    head.addEventListener('click', () => this.handlers.choose(name));
    return head;
  }

  private targetRow(name: string, head: HTMLElement): Row {
    const track = (): Track =>
      this.tracks.find((one) => one.name === name) ?? { name, samples: [] };
    return {
      head,
      chart: element('div', 'row-body target-row'),
      draw: (width) => targetChart(track(), width, `${name}: occluded fraction and verdict`),
      tip: (frame) => this.targetTip(frame, name),
      scale: () => name,
    };
  }

  private stageTimes(): (number | null)[][] {
    return stages.map((stage) => this.frames.map((frame) => frame.timing_ms?.[stage] ?? null));
  }

  private stagesScale(): string {
    const times = this.stageTimes();
    const sums = this.frames.map((_, frame) =>
      times.reduce((sum, stage) => sum + (stage[frame] ?? 0), 0),
    );
    return atMost(largest(sums) || null);
  }

  private ages(): (number | null)[] {
    return this.frames.map(({ joint_age_ms: ms }) => ms && Math.abs(ms));
  }

  private titleOf(frame: number): string {
    const time = this.times[frame] ?? null;
    const number = this.frames[frame]?.index ?? frame;
    return `frame ${number}${time === null ? '' : ` · ${seconds(time, 3)}`}`;
  }

  private statusTip(frame: number): string {
    const report = this.frames[frame];
    return !report || report.status === 'ok' ? '' : `\n${report.status}: ${report.message ?? ''}`;
  }

  private targetTip(frame: number, name: string): string {
    const target = this.frames[frame]?.targets.find((one) => one.name === name);
    if (!target) return this.statusTip(frame);
    const words = [verdictNames[verdictOf(target.verdict)], hiddenWords(target), target.reason];
    return `\n${name}: ${words.filter(Boolean).join(' · ')}`;
  }

  /** @param always also where the width is what it was */
  private redraw(always: boolean): void {
    const width = this.rows[0]?.chart.clientWidth ?? 0;
    if (width === 0 || (width === this.width && !always) || this.frames.length === 0) return;
    this.width = width;
    for (const { head, chart, draw, scale } of this.rows) {
      chart.replaceChildren(draw(width));
      setText(head.lastElementChild as HTMLElement, scale());
    }
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
    this.tip.hidden = frame === null || event.pointerType === 'touch';
    if (frame === null) return;
    const hovered = this.rows.find(({ chart }) => {
      const { top, bottom } = chart.getBoundingClientRect();
      return event.clientY >= top && event.clientY <= bottom;
    });
    setText(this.tip, `${this.titleOf(frame)}${hovered?.tip(frame) ?? ''}`);
    const box = this.host.getBoundingClientRect();
    this.tip.style.left = `${event.clientX - box.left}px`;
    this.tip.style.top = `${event.clientY - box.top + this.host.scrollTop}px`;
    this.tip.classList.toggle('left', event.clientX > box.left + 0.65 * box.width);
  }
}

const atMost = (milliseconds_: number | null): string =>
  milliseconds_ === null ? 'not known' : `≤ ${milliseconds(milliseconds_)}`;

function plainRow(kind: string, title: string, rest: Pick<Row, 'draw' | 'tip' | 'scale'>): Row {
  const names = [element('span', '', title), element('span', 'scale')];
  const head = element('div', `row-head plain ${kind}`, ...names);
  return { head, chart: element('div', `row-body ${kind}`), ...rest };
}

/** Verdicts by shape and colour, then what the areas and lines are. */
export function timelineLegend(): HTMLElement[] {
  const group = (title: string, ...entries: HTMLElement[]): HTMLElement =>
    element('div', 'legend-group', element('b', '', title), ...entries);
  const entry = (box: Element, name: string): HTMLElement =>
    element('span', 'legend-entry', box, name);
  const line = (border: string): HTMLElement => {
    const box = element('i', 'swatch line');
    box.style.borderTop = border;
    return box;
  };
  const verdicts = (Object.keys(verdictNames) as Verdict[]).map((verdict) =>
    entry(verdictIcon(verdict), verdictNames[verdict]),
  );
  return [
    group('Verdict', ...verdicts),
    group(
      'Hidden',
      entry(swatch('--l-occluded'), 'by robot'),
      entry(swatch('--l-other'), 'by others'),
      entry(swatch('--l-unknown'), 'unknown'),
    ),
    group(
      'Handled',
      entry(line('2px solid var(--v-visible)'), 'measured'),
      entry(line('2px dashed var(--accent)'), 'predicted'),
      entry(line('2px dotted var(--v-partial)'), 'held'),
    ),
  ];
}
