// SPDX-License-Identifier: Apache-2.0
// What the server and report.json say; DESIGN's schema, in its own names. Metres, seconds, radians.

export type Verdict = 'visible' | 'partial' | 'hidden' | 'unknown' | 'out_of_view';
export type Source = 'measured' | 'predicted' | 'held' | 'lost';
export type Vec3 = readonly [number, number, number];
export type Quaternion = readonly [number, number, number, number];
/** x y z qx qy qz qw: maps from the named thing's frame to the root link's. */
export type Pose = readonly [number, number, number, number, number, number, number];

export interface Handled {
  readonly source: Source;
  readonly age_s: number | null;
  readonly position: Vec3 | null;
  readonly orientation: Quaternion | null;
  readonly sigma_m: number | null;
}

/** Fractions are of `inside`; null where they do not apply. Points are in the root link's frame. */
export interface TargetReport {
  readonly name: string;
  readonly covered: number | null;
  readonly inside: number | null;
  readonly occluded_fraction: number | null;
  readonly front_fraction: number | null;
  readonly clear_fraction: number | null;
  readonly unknown_fraction: number | null;
  readonly hidden_by_other_fraction: number | null;
  readonly measured_fraction?: number | null;
  readonly seen_past_fraction?: number | null;
  readonly verdict: Verdict;
  readonly blame: readonly { readonly link: string; readonly fraction: number }[] | null;
  readonly point: Vec3 | null;
  readonly point_pixels: number | null;
  readonly point_spread_m: number | null;
  readonly handled: Handled | null;
  readonly estimate?: string | null;
  readonly reason?: string | null;
}

export interface FrameReport {
  readonly index: number;
  /** Nanoseconds, as text: more digits than a double holds. */
  readonly stamp_ns: string | null;
  readonly joint_age_ms: number | null;
  readonly status: string;
  readonly message?: string | null;
  readonly pixels: Readonly<Record<string, number | null>>;
  readonly timing_ms: Readonly<Record<string, number | null>> | null;
  readonly targets: readonly TargetReport[];
}

export interface StageTime {
  readonly median: number;
  readonly p99: number;
  readonly max: number;
}

export interface Summary {
  readonly frames: number;
  readonly bad_frames: number;
  /** null: the stage took place in no frame. */
  readonly timing_ms: Readonly<Record<string, StageTime | null>>;
  /** null: known of no frame. */
  readonly pixels?: Readonly<Record<string, number | null>>;
  readonly missing_links?: readonly unknown[];
  readonly notes?: readonly string[];
  readonly faults?: readonly unknown[];
}

export interface Report {
  readonly penumbra: string;
  readonly input: string;
  readonly renderer?: {
    readonly backend: string;
    readonly isa?: string | null;
    readonly threads?: number | null;
    readonly device?: string | null;
  };
  readonly settings?: Readonly<Record<string, unknown>>;
  readonly links: readonly string[];
  readonly frames: readonly FrameReport[];
  readonly summary: Summary | null;
}

export const parts = ['color', 'overlay', 'labels', 'links', 'vdi', 'depth', 'cloud'] as const;
export type PartName = (typeof parts)[number];

export interface CameraInfo {
  readonly width: number;
  readonly height: number;
  readonly fx: number;
  readonly fy: number;
  readonly cx: number;
  readonly cy: number;
  readonly image: 'raw' | 'rectified';
}

export interface Session {
  readonly penumbra: string;
  /** Which process serves: another one on the same port has another. */
  readonly server: string;
  readonly mode: 'stored' | 'live';
  readonly input: string;
  readonly complete: boolean;
  /** That are judged so far. */
  readonly frames: number;
  /** That there will be, where it is known. */
  readonly expected?: number | null;
  readonly scene_version: number;
  readonly links: readonly string[];
  readonly camera: CameraInfo | null;
  readonly parts: readonly string[];
  readonly missing: readonly string[];
  /** Live alone. */
  readonly diagnostics?: readonly Diagnostic[];
}

export interface SceneIndex {
  readonly server: string;
  readonly version: number;
  readonly root: string;
  readonly links: readonly {
    readonly name: string;
    readonly meshes: readonly {
      readonly vertices: number;
      readonly triangles: number;
      readonly position_offset: number;
      readonly index_offset: number;
    }[];
  }[];
}

export interface Diagnostic {
  readonly level: string;
  readonly message: string;
}

export interface LiveState {
  readonly age_ms: number;
  readonly dropped: number;
  readonly rate_hz: number;
  readonly missing: readonly string[];
  readonly diagnostics: readonly Diagnostic[];
}
