// SPDX-License-Identifier: Apache-2.0
// Rows of all targets, the frames' status, stage times and joint ages over one axis of frames.
import type { FrameReport } from '../api/types';
import { milliseconds, percent, seconds } from '../model/format';
import { verdictOf } from '../model/labels';
import { largest, secondsOf, tracksOf, type Track } from '../model/timeline';
import { axisChart } from './axis';
import { seriesChart, statusChart } from './charts';
import { plainRow, TargetRow, TimeRows, verdictLine, type Row } from './time_rows';

export interface TimelineHandlers {
  seek(frame: number): void;
  choose(target: string): void;
}

export const stages = ['kinematics', 'render', 'classify', 'targets'] as const;
const stageHeight = 30;
const ageHeight = 18;

export class TimelineView {
  tracks: readonly Track[] = [];
  times: readonly (number | null)[] = [];
  private frames: readonly FrameReport[] = [];
  private drops: readonly number[] | null = null;
  private targets: TargetRow[] | null = null;
  private current = 0;
  private report: FrameReport | undefined;
  private chosen: string | null = null;
  private readonly rows: TimeRows;

  constructor(
    host: HTMLElement,
    private readonly handlers: TimelineHandlers,
  ) {
    this.rows = new TimeRows(host, {
      seek: (frame) => handlers.seek(frame),
      titleOf: (frame) => this.titleOf(frame),
    });
  }

  /** @param drops frames dropped before each of these; null: not a live view */
  setFrames(frames: readonly FrameReport[], drops: readonly number[] | null = null): void {
    this.frames = frames;
    this.drops = drops;
    this.tracks = tracksOf(frames);
    this.times = secondsOf(frames);
    const names = (rows: readonly { name: string }[]): string =>
      rows.map(({ name }) => name).join('\n');
    if (!this.targets || names(this.tracks) !== names(this.targets)) this.build();
    this.rows.setCount(frames.length);
    this.setCurrent(this.current, this.report);
  }

  /** @param report the frame's own, where it is newer than those of the timeline */
  setCurrent(frame: number, report = this.frames[frame]): void {
    this.current = frame;
    this.report = report;
    this.rows.setCurrent(frame);
    for (const row of this.targets ?? []) {
      const target = report?.targets.find((one) => one.name === row.name);
      row.setVerdict(verdictOf(target?.verdict ?? 'unknown')); // not told of: not known
    }
  }

  setChosen(target: string | null): void {
    this.chosen = target;
    for (const row of this.targets ?? []) row.setChosen(row.name === target);
  }

  private build(): void {
    this.targets = this.tracks.map(({ name }) => this.targetRow(name));
    const tip = (frame: number): string => this.statusTip(frame);
    const rows: Row[] = [
      ...this.targets,
      plainRow('frames', 'Frames', (width) => statusChart(this.frames, width), {
        tip,
        scale: () => `${this.frames.filter((frame) => frame.status !== 'ok').length} bad`,
      }),
      plainRow('stages', 'Stages', (width) => this.stagesChart(width), {
        tip: (frame) =>
          stages.map((one) => `\n${one} ${milliseconds(this.timeOf(frame, one))}`).join(''),
        scale: () => this.stagesScale(),
      }),
      plainRow('ages', 'Joint age', (width) => this.agesChart(width), {
        tip: (frame) => `\njoint age ${milliseconds(this.frames[frame]?.joint_age_ms)}`,
        scale: () => this.agesScale(),
      }),
    ];
    if (this.drops)
      rows.push(
        plainRow('drops', 'Dropped', (width) => this.dropsChart(width), {
          tip,
          scale: () => `${(this.drops ?? []).reduce((sum, drops) => sum + drops, 0)}`,
        }),
      );
    rows.push(plainRow('axis', '', (width) => axisChart(this.times, width), { tip }));
    this.rows.setRows(rows);
    this.setChosen(this.chosen);
  }

  private targetRow(name: string): TargetRow {
    return new TargetRow(
      name,
      () => this.handlers.choose(name),
      () => this.tracks.find((track) => track.name === name),
      (frame) => this.targetTip(frame, name),
    );
  }

  private timeOf(frame: number, stage: (typeof stages)[number]): number | null {
    return this.frames[frame]?.timing_ms?.[stage] ?? null;
  }

  private stagesChart(width: number): SVGSVGElement {
    const series = stages.map((name) => ({
      name,
      values: this.frames.map((_, frame) => this.timeOf(frame, name)),
    }));
    return seriesChart(series, width, stageHeight, 'time of each stage');
  }

  private stagesScale(): string {
    const sums = this.frames.map((_, frame) =>
      stages.reduce((sum, stage) => sum + (this.timeOf(frame, stage) ?? 0), 0),
    );
    const most = largest(sums) ?? 0;
    return most > 0 ? `≤ ${milliseconds(most)}` : 'not told';
  }

  private agesChart(width: number): SVGSVGElement {
    return seriesChart(
      [{ name: 'age', values: this.ages() }],
      width,
      ageHeight,
      'age of the joint positions',
    );
  }

  private ages(): (number | null)[] {
    return this.frames.map(({ joint_age_ms: ms }) => ms && Math.abs(ms));
  }

  private agesScale(): string {
    const age = largest(this.ages());
    return age === null ? 'not known' : `≤ ${milliseconds(age)}`;
  }

  private dropsChart(width: number): SVGSVGElement {
    return seriesChart(
      [{ name: 'drops', values: this.drops ?? [] }],
      width,
      ageHeight,
      'dropped frames',
    );
  }

  titleOf(frame: number): string {
    const time = this.times[frame];
    const number = this.frames[frame]?.index ?? frame;
    return `frame ${number}${time === null || time === undefined ? '' : ` · ${seconds(time, 3)}`}`;
  }

  private statusTip(frame: number): string {
    const report = this.frames[frame];
    return !report || report.status === 'ok' ? '' : `\n${report.status}: ${report.message ?? ''}`;
  }

  private targetTip(frame: number, name: string): string {
    const target = this.frames[frame]?.targets.find((one) => one.name === name);
    if (!target) return this.statusTip(frame);
    const blame = (target.blame ?? [])
      .map((one) => `${one.link} ${percent(one.fraction, 0)}`)
      .join(', ');
    const occluded = `by robot ${percent(target.occluded_fraction)}`;
    const other = target.hidden_by_other_fraction;
    const others = other ? `by others ${percent(other)}` : '';
    return verdictLine(name, verdictOf(target.verdict), occluded, blame, others, target.reason);
  }
}
