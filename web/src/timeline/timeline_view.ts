// SPDX-License-Identifier: Apache-2.0
// Rows of all targets, the frames' status, stage times and joint ages over one axis of frames.
import type { FrameReport } from '../api/types';
import { milliseconds, percent, seconds } from '../model/format';
import { verdictNames, verdictOf } from '../model/labels';
import { largest, secondsOf, tracksOf, type Track } from '../model/timeline';
import { element, setText } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';
import { rowSvg, seriesChart, statusChart, targetChart } from './charts';
import { addPatterns } from './patterns';
import { axisChart } from './axis';

export interface TimelineHandlers {
  seek(frame: number): void;
  choose(target: string): void;
}

export const stages = ['kinematics', 'render', 'classify', 'targets'] as const;
const stageHeight = 30;
const ageHeight = 18;

interface Row {
  readonly head: HTMLElement;
  readonly chart: HTMLElement;
  draw(width: number): SVGSVGElement;
}

export class TimelineView {
  tracks: readonly Track[] = [];
  times: readonly (number | null)[] = [];
  private frames: readonly FrameReport[] = [];
  private drops: readonly number[] | null = null;
  private rows: Row[] = [];
  private heads = new Map<string, HTMLButtonElement>();
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
    this.playhead.tabIndex = 0;
    this.tip.hidden = true;
    host.replaceChildren(this.grid, this.playhead, this.tip);
    host.addEventListener('pointerdown', (event) => this.press(event));
    host.addEventListener('pointermove', (event) => this.move(event));
    host.addEventListener('pointerleave', () => (this.tip.hidden = true));
    new ResizeObserver(() => this.redraw()).observe(host);
  }

  /** @param drops frames dropped before each of these; null: not a live view */
  setFrames(frames: readonly FrameReport[], drops: readonly number[] | null = null): void {
    this.frames = frames;
    this.drops = drops;
    this.tracks = tracksOf(frames);
    this.times = secondsOf(frames);
    const names = this.tracks.map((track) => track.name).join('\n');
    if (names !== [...this.heads.keys()].join('\n') || this.rows.length === 0) this.build();
    this.width = 0;
    this.redraw();
  }

  /** @param report the frame's own, where it is newer than those of the timeline */
  setCurrent(frame: number, report = this.frames[frame]): void {
    this.current = frame;
    this.report = report;
    const count = Math.max(this.frames.length, 1);
    this.host.style.setProperty('--at', String((Math.min(frame, count - 1) + 0.5) / count));
    this.playhead.setAttribute('aria-valuemin', '0');
    this.playhead.setAttribute('aria-valuemax', String(count - 1));
    this.playhead.setAttribute('aria-valuenow', String(frame));
    this.playhead.setAttribute('aria-valuetext', this.titleOf(frame));
    for (const [name, head] of this.heads) {
      const target = report?.targets.find((one) => one.name === name);
      const verdict = verdictOf(target?.verdict ?? 'unknown'); // not told of: not known
      const icon = head.querySelector('svg');
      if (icon && !icon.classList.contains(verdict)) icon.replaceWith(verdictIcon(verdict));
    }
  }

  setChosen(target: string | null): void {
    this.chosen = target;
    for (const [name, head] of this.heads)
      head.setAttribute('aria-pressed', String(name === target));
    for (const row of this.rows)
      row.chart.classList.toggle('chosen', row.head === this.heads.get(target ?? ''));
  }

  private build(): void {
    this.heads = new Map();
    this.rows = this.tracks.map((track) => this.targetRow(track.name));
    this.rows.push(
      this.plainRow('frames', 'Frames', (width) => statusChart(this.frames, width)),
      this.plainRow('stages', 'Stages', (width) => this.stagesChart(width)),
      this.plainRow('ages', 'Joint age', (width) => this.agesChart(width)),
    );
    if (this.drops)
      this.rows.push(this.plainRow('drops', 'Dropped', (width) => this.dropsChart(width)));
    this.rows.push(this.plainRow('axis', '', (width) => axisChart(this.times, width)));
    this.grid.replaceChildren(...this.rows.flatMap((row) => [row.head, row.chart]));
    this.setChosen(this.chosen);
  }

  private targetRow(name: string): Row {
    const head = element('button', 'row-head', verdictIcon('unknown'), element('span', '', name));
    head.type = 'button';
    head.title = name;
    head.addEventListener('click', () => this.handlers.choose(name));
    this.heads.set(name, head);
    const chart = element('div', 'row-body target-row');
    const draw = (width: number): SVGSVGElement => {
      const track = this.tracks.find((one) => one.name === name);
      return track
        ? targetChart(track, width, `${name}: occluded fraction and verdict`)
        : rowSvg(width, 1, name);
    };
    return { head, chart, draw };
  }

  private plainRow(kind: string, title: string, draw: Row['draw']): Row {
    const names = [element('span', '', title), element('span', 'scale')];
    const head = element('div', `row-head plain ${kind}`, ...names);
    return { head, chart: element('div', `row-body ${kind}`), draw };
  }

  private stagesChart(width: number): SVGSVGElement {
    const series = stages.map((name) => ({
      name,
      values: this.frames.map((frame) => frame.timing_ms?.[name] ?? null),
    }));
    return seriesChart(series, width, stageHeight, 'time of each stage');
  }

  private agesChart(width: number): SVGSVGElement {
    const values = this.frames.map((frame) => frame.joint_age_ms && Math.abs(frame.joint_age_ms));
    return seriesChart([{ name: 'age', values }], width, ageHeight, 'age of the joint positions');
  }

  private dropsChart(width: number): SVGSVGElement {
    return seriesChart(
      [{ name: 'drops', values: this.drops ?? [] }],
      width,
      ageHeight,
      'dropped frames',
    );
  }

  private redraw(): void {
    const width = this.rows[0]?.chart.clientWidth ?? 0;
    if (width === 0 || width === this.width || this.frames.length === 0) return;
    this.width = width;
    for (const row of this.rows) row.chart.replaceChildren(row.draw(width));
    this.writeScales();
    this.setCurrent(this.current, this.report);
  }

  /** The largest value of each chart that has a scale, beside its name. */
  private writeScales(): void {
    const sums = this.frames.map((frame) =>
      stages.reduce((sum, stage) => sum + (frame.timing_ms?.[stage] ?? 0), 0),
    );
    const time = largest(sums) ?? 0;
    const age = largest(this.frames.map(({ joint_age_ms: ms }) => ms && Math.abs(ms)));
    const texts: Readonly<Record<string, string>> = {
      stages: time > 0 ? `≤ ${milliseconds(time)}` : 'not told',
      ages: age === null ? 'not known' : `≤ ${milliseconds(age)}`,
      drops: this.drops ? `${this.drops.reduce((sum, drops) => sum + drops, 0)}` : '',
      frames: `${this.frames.filter((frame) => frame.status !== 'ok').length} bad`,
    };
    for (const { head, chart } of this.rows) {
      const text = texts[chart.className.replace('row-body ', '')];
      if (text !== undefined && head.lastElementChild) head.lastElementChild.textContent = text;
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
    const name = [...this.heads].find(([, head]) => head === hovered?.head)?.[0];
    setText(this.tip, `${this.titleOf(frame)}${this.detailOf(frame, name, hovered)}`);
    const box = this.host.getBoundingClientRect();
    const right = event.clientX > box.left + 0.6 * box.width;
    this.tip.classList.toggle('left', right);
    this.tip.style.left = `${event.clientX - box.left}px`;
    this.tip.style.top = `${event.clientY - box.top + this.host.scrollTop}px`;
  }

  titleOf(frame: number): string {
    const time = this.times[frame];
    const number = this.frames[frame]?.index ?? frame;
    return `frame ${number}${time === null || time === undefined ? '' : ` · ${seconds(time, 3)}`}`;
  }

  private detailOf(frame: number, name: string | undefined, row: Row | undefined): string {
    const report = this.frames[frame];
    if (!report) return '';
    const target = report.targets.find((one) => one.name === name);
    if (target) {
      const verdict = verdictNames[verdictOf(target.verdict)];
      const blame = (target.blame ?? [])
        .map((one) => `${one.link} ${percent(one.fraction, 0)}`)
        .join(', ');
      const parts = [
        verdict,
        `occluded ${percent(target.occluded_fraction)}`,
        blame,
        target.reason,
      ];
      return `\n${name}: ${parts.filter(Boolean).join(' · ')}`;
    }
    if (row?.chart.classList.contains('stages'))
      return stages.map((one) => `\n${one} ${milliseconds(report.timing_ms?.[one])}`).join('');
    if (row?.chart.classList.contains('ages'))
      return `\njoint age ${milliseconds(report.joint_age_ms)}`;
    return report.status === 'ok' ? '' : `\n${report.status}: ${report.message ?? ''}`;
  }
}
