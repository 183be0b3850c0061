// SPDX-License-Identifier: Apache-2.0
// Several cameras that look at one robot. Each has its page and its answers below /camera/NAME.
import type { Vec3, Verdict } from './types';

/** The start of this page's paths; empty: of the only camera, or the first one. */
export const ownRoot = /^\/camera\/[^/]+/.exec(location.pathname)?.[0] ?? '';

export const rootOf = (camera: string): string => `/camera/${encodeURIComponent(camera)}`;

/** Returns which of the cameras this page shows. */
export const ownCamera = (cameras: readonly string[]): string =>
  cameras.find((camera) => rootOf(camera) === ownRoot) ?? cameras[0] ?? '';

/** A target over all cameras, as in views.json. */
export interface FusedTarget {
  readonly name: string;
  readonly verdict: Verdict;
  readonly reason: string | null;
  readonly best: string | null;
  readonly point: Vec3 | null;
  /** Null: the cameras agree. */
  readonly contradiction: object | null;
  readonly views: readonly { readonly camera: string; readonly verdict: Verdict }[];
}

/** The targets that were judged at one stamp. */
export interface FusedFrame {
  readonly stamp_ns: string;
  readonly targets: readonly FusedTarget[];
}

/** views.json. */
export interface Views {
  readonly penumbra: string;
  readonly input: string;
  readonly cameras: readonly string[];
  readonly frames: readonly FusedFrame[];
}

/** Returns the target's newest result at a stamp, nanoseconds; null: there is none yet. */
export function fusedAt(
  frames: readonly FusedFrame[],
  stamp: bigint,
  name: string,
): FusedTarget | null {
  for (let i = frames.length - 1; i >= 0; --i) {
    const frame = frames[i] as FusedFrame;
    if (BigInt(frame.stamp_ns) > stamp) continue;
    const target = frame.targets.find((one) => one.name === name);
    if (target) return target;
  }
  return null;
}

/** Returns the position of the stamp that is nearest; null for no stamps. */
export function nearest(stamps: readonly (bigint | null)[], stamp: bigint): number | null {
  let best: number | null = null;
  let least = 0n;
  stamps.forEach((one, index) => {
    if (one === null) return;
    const apart = one > stamp ? one - stamp : stamp - one;
    if (best !== null && apart >= least) return;
    best = index;
    least = apart;
  });
  return best;
}
