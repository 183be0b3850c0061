// SPDX-License-Identifier: Apache-2.0
// The first seed over time: for each kind of detection the target's row as in a run's report, with
// the hidden share that is true and our verdict, and below it the error of every method.
import { percent, seconds } from '../model/format';
import { verdictOf } from '../model/labels';
import type { Sample, Track } from '../model/timeline';
import { axisChart } from '../timeline/axis';
import { plainRow, TargetRow, TimeRows, verdictLine, type Row } from '../timeline/time_rows';
import { errorChart } from './error_chart';
import type { Experiment, SeedRun } from './types';

export const errorText = (millimetres: number | null | undefined): string =>
  millimetres === null || millimetres === undefined ? 'no pose' : `${millimetres.toFixed(1)} mm`;

/** `amodal_eager` as people read it. */
export const laneTitle = (key: string): string => key.replaceAll('_', ', ');

export function tracksOfRun(run: SeedRun): Track[] {
  return Object.entries(run.lanes).map(([key, lane]) => ({
    name: laneTitle(key),
    samples: run.time_s.map((_, frame): Sample | null => {
      const verdict = lane.verdicts[frame];
      return {
        verdict: verdictOf(verdict ?? 'unknown'),
        occluded: run.hidden[frame] ?? null,
        other: null,
        unknown: null,
        blame: null,
        source: lane.sources[frame] ?? null,
      };
    }),
  }));
}

export class ExperimentTimeline {
  readonly tracks: readonly Track[];
  private readonly targets: TargetRow[] = [];
  private readonly rows: TimeRows;
  private method: string;

  constructor(
    host: HTMLElement,
    private readonly experiment: Experiment,
    handlers: { seek(frame: number): void; choose(lane: string): void },
  ) {
    const { run, methods } = experiment;
    this.method = methods.at(-1)?.key ?? '';
    this.tracks = tracksOfRun(run);
    this.rows = new TimeRows(host, {
      seek: (frame) => handlers.seek(frame),
      titleOf: (frame) => this.titleOf(frame),
    });
    const rows: Row[] = [];
    this.tracks.forEach((track, i) => {
      const key = Object.keys(run.lanes)[i] ?? '';
      const target = new TargetRow(
        track.name,
        () => handlers.choose(key),
        () => track,
        (frame) => this.targetTip(track, frame),
      );
      this.targets.push(target);
      rows.push(target, this.errorRow(key));
    });
    rows.push(plainRow('axis', '', (width) => axisChart(run.time_s, width)));
    this.rows.setRows(rows);
    this.rows.setCount(run.time_s.length);
  }

  setCurrent(frame: number): void {
    this.rows.setCurrent(frame);
    this.targets.forEach((row, i) =>
      row.setVerdict(this.tracks[i]?.samples[frame]?.verdict ?? 'unknown'),
    );
  }

  /** @param lane by its key
   * @param method whose line stands out */
  setChosen(lane: string, method: string): void {
    for (const row of this.targets) row.setChosen(row.name === laneTitle(lane));
    if (method === this.method) return;
    this.method = method;
    this.rows.redraw(true);
  }

  titleOf(frame: number): string {
    return `frame ${frame} · ${seconds(this.experiment.run.time_s[frame], 3)}`;
  }

  private targetTip(track: Track, frame: number): string {
    const sample = track.samples[frame];
    if (!sample) return '';
    const hidden = `${percent(sample.occluded)} hidden`;
    return verdictLine(track.name, sample.verdict, hidden, sample.source);
  }

  private errorRow(lane: string): Row {
    const { run, occluded_share, goal: goalName } = this.experiment;
    const errors = run.lanes[lane]?.errors ?? {};
    const lines = Object.entries(errors).map(([key, { translation_mm }]) => ({
      key,
      errors: translation_mm,
    }));
    const hidden = run.hidden.map((share) => share > occluded_share);
    const draw = (width: number): SVGSVGElement =>
      errorChart(lines, this.method, { hidden, goal: run.goal, goalName }, width);
    const tip = (frame: number): string =>
      this.experiment.methods
        .map(({ key, name }) => `\n${name}: ${errorText(errors[key]?.translation_mm[frame])}`)
        .join('');
    return plainRow('errors', 'Errors', draw, { tip });
  }
}
