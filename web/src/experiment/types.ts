// SPDX-License-Identifier: Apache-2.0
// What an experiment's page holds: metrics.json as it is, and what else is shown.
import type { Source, Verdict } from '../api/types';

export interface Measured {
  /** Null: nothing was there to measure. */
  readonly value: number | null;
  /** Null: of a single seed, or all resamples are the same. */
  readonly ci95: readonly [number, number] | null;
}

/** Of metrics.json. */
export interface Metrics {
  readonly penumbra: string;
  readonly experiment: string;
  readonly settings: {
    readonly latency_s: readonly [number, number];
    readonly perception_every_frames: number;
    readonly joint_sigma_rad: number;
    readonly joint_latency_s: number;
  };
  /** From the first up to but without the second. */
  readonly seeds: readonly [number, number];
  readonly detections: Readonly<Record<string, Lane>>;
}

/** All methods with one kind of detection, by their keys. */
export interface Lane {
  readonly name: string;
  readonly methods: Readonly<
    Record<string, { readonly summary: Readonly<Record<string, Measured>> }>
  >;
}

export interface Measure {
  readonly key: string;
  readonly name: string;
  readonly unit: string;
  readonly digits: number;
}

export interface Method {
  readonly key: string;
  readonly name: string;
  readonly idea: string;
}

/** One for each frame; null: no pose is claimed. */
export interface Errors {
  readonly translation_mm: readonly (number | null)[];
  /** Not of points. */
  readonly rotation_deg?: readonly (number | null)[];
}

/** The first seed, frame by frame. */
export interface SeedRun {
  readonly seed: number;
  readonly frame_s: number;
  readonly goal: number | null;
  readonly time_s: readonly number[];
  /** Share of the target that the robot truly hides. */
  readonly hidden: readonly number[];
  readonly before_robot: readonly boolean[];
  readonly lanes: Readonly<
    Record<
      string,
      {
        readonly verdicts: readonly (Verdict | null)[];
        readonly sources: readonly Source[];
        readonly errors: Readonly<Record<string, Errors>>;
      }
    >
  >;
}

export interface Experiment {
  readonly title: string;
  readonly story: string;
  /** What happens in the run's frame `goal`. */
  readonly goal: string;
  /** One point a line. */
  readonly limits: string;
  readonly occluded_share: number;
  /** The measure that methods are compared by. */
  readonly compared: string;
  readonly measures: readonly Measure[];
  /** The last is ours. */
  readonly methods: readonly Method[];
  readonly run: SeedRun;
}
