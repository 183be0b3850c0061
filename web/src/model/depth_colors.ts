// SPDX-License-Identifier: Apache-2.0
import type { Rgb } from './labels';

// Nine points of cividis (Nuñez, Anderton and Renslow 2018): suits all kinds of colour vision, and its
// lightness rises evenly.
const cividis: readonly Rgb[] = [
  [0, 34, 78],
  [25, 57, 111],
  [66, 78, 108],
  [95, 100, 109],
  [125, 124, 120],
  [155, 148, 118],
  [188, 175, 107],
  [222, 203, 86],
  [254, 232, 56],
];

/** 256 colours, the nearest depth lightest. */
export const depthColors: readonly Rgb[] = Array.from({ length: 256 }, (_, index) => {
  const at = ((255 - index) / 255) * (cividis.length - 1);
  const low = Math.min(Math.floor(at), cividis.length - 2);
  const a = cividis[low] as Rgb;
  const b = cividis[low + 1] as Rgb;
  return a.map((value, k) =>
    Math.round(value + ((b[k] as number) - value) * (at - low)),
  ) as unknown as Rgb;
});

/** Nearest and farthest depth of the colour scale, metres. */
export type DepthRange = readonly [number, number];

/** The percentiles of a frame's depths at the ends of the colour scale. */
export const depthPercentiles = [2, 98] as const;
const maxSamples = 20_000;

/** Returns the depths at both percentiles, or null if nothing is measured. */
export function depthRange(depth: Float32Array): DepthRange | null {
  const step = Math.ceil(depth.length / maxSamples);
  const known = depth.filter((z, at) => at % step === 0 && z > 0 && z < Infinity).sort();
  if (known.length === 0) return null;
  const at = (percentile: number): number =>
    known[Math.round((percentile / 100) * (known.length - 1))] as number;
  return [at(depthPercentiles[0]), at(depthPercentiles[1])];
}

/** Metres that have the full colour. */
export const fullResidual = 0.02;

/** Blue where the measured point is before the robot's surface, red where it is behind. */
export function residualColor(residual: number): Rgb {
  const pale = Math.round(255 * (1 - Math.min(1, Math.abs(residual) / fullResidual)));
  return residual < 0 ? [pale, pale, 255] : [255, pale, pale];
}
