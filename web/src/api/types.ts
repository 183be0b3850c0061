// SPDX-License-Identifier: Apache-2.0
// Types of report.json and of the server's JSON. Metres, seconds, radians.

export type Verdict = 'visible' | 'partial' | 'hidden' | 'unknown' | 'out_of_view' | 'held';
export type Source = 'measured' | 'predicted' | 'held' | 'lost';
export type Vec3 = readonly [number, number, number];
export type Quaternion = readonly [number, number, number, number];
/** x y z qx qy qz qw of a frame in the root link's frame. */
export type Pose = readonly [number, number, number, number, number, number, number];

export interface Handled {
  /** Seconds until the robot's plan hides it for longer than its timeout. */
  readonly lost_in_s?: number | null;
  readonly source: Source;
  readonly age_s: number | null;
  readonly position: Vec3 | null;
  readonly orientation: Quaternion | null;
  readonly sigma_m: number | null;
}

/** Fractions are of `inside`; null where they do not apply. Points are in the root link's frame. */
/** What a planned motion will do to a target, seconds from the frame. */
export interface ForecastInterval {
  readonly begin_s: number;
  readonly end_s: number;
  readonly verdict: Verdict;
  readonly by: string | null;
  readonly reason: string | null;
}

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
  /** Null or absent: there is no plan. */
  readonly forecast?: readonly ForecastInterval[] | null;
}

export interface FrameReport {
  readonly index: number;
  /** Nanoseconds, as text: more digits than a double holds. */
  readonly stamp_ns: string | null;
  readonly joint_age_ms?: number | null;
  readonly status: string;
  readonly message?: string | null;
  /** Of a camera's frame. */
  readonly pixels?: Readonly<Record<string, number | null>>;
  /** Of a scan: numbers by label. */
  readonly points?: Readonly<Record<string, number>>;
  readonly timing_ms?: Readonly<Record<string, number | null>> | null;
  /** Names of attached bodies, and their numbers in link images. */
  readonly attached?: Readonly<Record<string, number>>;
  readonly targets: readonly TargetReport[];
}

/** How far the camera is from its calibration; errors are of 95 %. */
export interface Calibration {
  readonly moved_mm: number;
  readonly moved_error_mm: number;
  readonly turned_degrees: number;
  readonly turned_error_degrees: number;
  readonly has_moved: boolean;
}

/** What is wrong with the setup. */
export interface Diagnosis {
  readonly cause: string;
  readonly message: string;
  /** Index of the frame that shows it most. */
  readonly frame: number;
}

/** Entries of `timing_ms` and `pixels` are null if no frame has them. */
export interface Summary {
  readonly bad_frames: number;
  readonly timing_ms: Readonly<Record<string, { median: number; p99: number; max: number } | null>>;
  readonly pixels?: Readonly<Record<string, number | null>>;
  readonly calibration?: Calibration | null;
  readonly diagnosis?: Diagnosis | null;
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
    readonly device?: string | null;
  };
  readonly frames: readonly FrameReport[];
  readonly summary: Summary | null;
}

export type PartName =
  'overlay' | 'labels' | 'links' | 'vdi' | 'depth' | 'color' | 'cloud' | 'outlines';
/** Residuals are measured minus virtual depth. */
export type Layer = Exclude<PartName, 'color' | 'cloud' | 'outlines'> | 'residual';

export interface CameraInfo {
  readonly width: number;
  readonly height: number;
  readonly fx: number;
  readonly fy: number;
  readonly cx: number;
  readonly cy: number;
}

export interface Session {
  /** Random number of the server process. */
  readonly server: string;
  readonly mode: 'stored' | 'live';
  readonly input: string;
  readonly complete: boolean;
  /** Number of frames after the run, if known. */
  readonly expected?: number | null;
  readonly scene_version: number;
  readonly links: readonly string[];
  readonly camera: CameraInfo | null;
  readonly parts: readonly PartName[];
  readonly missing: readonly string[];
  /** Names of all cameras; empty or absent: one without a name. */
  readonly cameras?: readonly string[];
  /** Only live. */
  readonly diagnostics?: readonly Diagnostic[];
}

export interface MeshIndex {
  readonly vertices: number;
  readonly triangles: number;
  readonly position_offset: number;
  readonly index_offset: number;
}

export interface SceneIndex {
  readonly links: readonly { readonly name: string; readonly meshes: readonly MeshIndex[] }[];
}

export interface Diagnostic {
  readonly level: string;
  readonly message: string;
}

/** Statistics of the live stream, as of one frame. */
export interface LiveStatus {
  readonly age_ms: number;
  readonly dropped: number;
  readonly rate_hz: number;
  readonly calibration?: Calibration | null;
  /** How far the camera's calibration is; empty: none was begun. */
  readonly calibrating?: string;
  readonly missing: readonly string[];
  readonly diagnostics: readonly Diagnostic[];
}
