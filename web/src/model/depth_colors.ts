// SPDX-License-Identifier: Apache-2.0
import type { Rgb } from './labels';

// Nine points of cividis (Nuñez, Anderton and Renslow 2018), which looks alike to all kinds of
// colour vision and rises evenly in lightness; between them it is near enough to linear.
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

/** Smallest and largest measured depth, or null where nothing is measured. Metres. */
export function depthRange(depth: Float32Array): readonly [number, number] | null {
  let near = Infinity;
  let far = 0;
  for (const z of depth) {
    if (!(z > 0) || z === Infinity) continue;
    if (z < near) near = z;
    if (z > far) far = z;
  }
  return far > 0 ? [near, far] : null;
}
