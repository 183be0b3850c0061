// SPDX-License-Identifier: Apache-2.0
// Colours and names of labels and verdicts. The palette is Okabe and Ito's, as in Penumbra's overlays:
// it suits the common colour vision deficiencies. Verdicts have shapes as well.
import type { FrameReport, TargetReport, Verdict } from '../api/types';

export const okabeIto = {
  orange: '#e69f00',
  sky: '#56b4e9',
  green: '#009e73',
  yellow: '#f0e442',
  blue: '#0072b2',
  vermillion: '#d55e00',
  purple: '#cc79a7',
} as const;

interface LabelStyle {
  readonly name: string;
  readonly color: string | null;
  /** For readers who do not know the name. */
  readonly plain: string;
}

/** By label value. */
export const labelStyles: readonly LabelStyle[] = [
  { name: 'clear', color: null, plain: 'no robot here' },
  { name: 'front', color: okabeIto.blue, plain: 'something in front of the robot' },
  { name: 'occluded', color: okabeIto.vermillion, plain: 'robot hides this' },
  { name: 'unknown', color: okabeIto.yellow, plain: 'robot, nothing measured' },
  { name: 'beyond', color: okabeIto.purple, plain: 'seen past the robot model' },
  { name: 'fringe', color: okabeIto.green, plain: 'edge of the robot, not trusted' },
];

const invalidLabelColor = '#ffffff'; // differs from all labels, and from clear

/** Returns the colour of a label value, or null for clear. */
export const labelColor = (value: number): string | null => {
  const style = labelStyles[value];
  return style ? style.color : invalidLabelColor;
};

export const labelName = (value: number): string => labelStyles[value]?.name ?? `label ${value}?`;

/** Returns whether a label is clear or front: the pixel does not show the robot. */
export const isSurroundings = (label: number): boolean => label === 0 || label === 1;

/** Returns whether the robot model is on the pixel's ray. */
export const isRobot = (label: number): boolean => label !== 0 && label !== 5;

export const verdictNames: Readonly<Record<Verdict, string>> = {
  visible: 'visible',
  partial: 'partly hidden',
  hidden: 'hidden',
  unknown: 'unknown',
  out_of_view: 'out of view',
  held: 'carried',
};

export const verdicts = Object.keys(verdictNames) as Verdict[];

/** Returns the verdict; `unknown` for one that this page does not know. */
export const verdictOf = ({ verdict }: Pick<TargetReport, 'verdict'>): Verdict =>
  verdict in verdictNames ? verdict : 'unknown';

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

/** Seven hues, then the same ones lighter and darker. */
export function linkColor(index: number): Rgb {
  const base = rgbOf(linkHues[index % linkHues.length] ?? okabeIto.sky);
  const round = Math.floor(index / linkHues.length) % 3;
  const end = round === 1 ? 255 : 0;
  const weight = round === 0 ? 0 : 0.45;
  return base.map((value) => Math.round(value + (end - value) * weight)) as unknown as Rgb;
}

/** Returns the names of link images' values, from 1: links, then attached bodies. */
export function linkNames(links: readonly string[], { attached = {} }: FrameReport): string[] {
  const names = [...links];
  for (const [name, value] of Object.entries(attached)) names[value - 1] = name;
  return Array.from(names, (name?: string) => name ?? '');
}
