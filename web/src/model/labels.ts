// SPDX-License-Identifier: Apache-2.0
// Colours: Okabe and Ito's palette, told apart with the common forms of colour blindness, and the
// same as in Penumbra's overlays. Nothing is told by colour alone: verdicts have a shape as well.
import type { Verdict } from '../api/types';

export const okabeIto = {
  orange: '#e69f00',
  sky: '#56b4e9',
  green: '#009e73',
  yellow: '#f0e442',
  blue: '#0072b2',
  vermillion: '#d55e00',
  purple: '#cc79a7',
} as const;

export interface LabelStyle {
  readonly name: string;
  readonly color: string | null;
  readonly meaning: string;
}

/** By label value. */
export const labelStyles: readonly LabelStyle[] = [
  { name: 'clear', color: null, meaning: 'no robot on this ray' },
  { name: 'front', color: okabeIto.blue, meaning: 'something real stands before the robot' },
  { name: 'occluded', color: okabeIto.vermillion, meaning: 'the sensor sees the robot' },
  { name: 'unknown', color: okabeIto.yellow, meaning: 'robot on the ray, no measurement' },
  { name: 'beyond', color: okabeIto.purple, meaning: 'the sensor sees past the model' },
  { name: 'fringe', color: okabeIto.green, meaning: 'beside the robot, depth not to be trusted' },
];

/** Of labels of a later Penumbra: like none of ours, and never like clear. */
export const strangeLabelColor = '#ffffff';

/** null: clear. */
export const labelColor = (value: number): string | null =>
  value < labelStyles.length ? (labelStyles[value]?.color ?? null) : strangeLabelColor;

export const labelName = (value: number): string => labelStyles[value]?.name ?? `label ${value}?`;

export const verdictNames: Readonly<Record<Verdict, string>> = {
  visible: 'visible',
  partial: 'partial',
  hidden: 'hidden',
  unknown: 'unknown',
  out_of_view: 'out of view',
};

/** A verdict of a later Penumbra is not taken for one of ours: it is unknown. */
export const verdictOf = (verdict: string): Verdict =>
  verdict in verdictNames ? (verdict as Verdict) : 'unknown';

export type Rgb = readonly [number, number, number];

export function rgbOf(color: string): Rgb {
  const value = Number.parseInt(color.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

const linkHues = [
  okabeIto.sky,
  okabeIto.orange,
  okabeIto.green,
  okabeIto.yellow,
  okabeIto.blue,
  okabeIto.vermillion,
  okabeIto.purple,
];

/** Seven hues, then the same again lighter and darker: neighbours differ, names tell the rest. */
export function linkColor(index: number): Rgb {
  const base = rgbOf(linkHues[index % linkHues.length] ?? okabeIto.sky);
  const round = Math.floor(index / linkHues.length) % 3;
  const towards = round === 1 ? 255 : 0;
  const share = round === 0 ? 0 : 0.45;
  return base.map((value) => Math.round(value + (towards - value) * share)) as unknown as Rgb;
}
