// SPDX-License-Identifier: Apache-2.0
// Numbers with units. An unknown value is a dash, never a zero.
import type { Calibration } from '../api/types';

export const unknownText = '–';

const known = (value: number | null | undefined): value is number =>
  value !== null && value !== undefined && Number.isFinite(value);

export const percent = (fraction: number | null | undefined, digits = 1): string =>
  known(fraction) ? `${(100 * fraction).toFixed(digits)} %` : unknownText;

export const metres = (value: number | null | undefined): string =>
  known(value) ? `${value.toFixed(3)} m` : unknownText;

export const count = (value: number | null | undefined): string =>
  known(value) ? value.toLocaleString('en-US').replaceAll(',', '\u202f') : unknownText;

export function milliseconds(value: number | null | undefined): string {
  if (!known(value)) return unknownText;
  if (Math.abs(value) < 1) return `${value.toFixed(3)} ms`;
  return `${value.toFixed(Math.abs(value) < 100 ? 1 : 0)} ms`;
}

export const seconds = (value: number | null | undefined, digits = 2): string =>
  known(value) ? `${value.toFixed(digits)} s` : unknownText;

export const vector = (value: readonly number[] | null | undefined, digits = 3): string =>
  value ? value.map((part) => part.toFixed(digits)).join('  ') : unknownText;

/** @param scale what a value of 1 is shown as */
export const scaled = (
  value: number | null | undefined,
  scale: number,
  digits: number,
  unit: string,
): string => (known(value) ? `${(scale * value).toFixed(digits)}${unit}` : unknownText);

export const degrees = 180 / Math.PI;

export interface Estimate {
  readonly value: number;
  /** Standard deviation. */
  readonly sigma: number;
}

/** Returns the value with twice its standard deviation; null: it was not estimated. */
export const estimate = (
  of: Estimate | null | undefined,
  scale: number,
  digits: number,
  unit: string,
): string | null =>
  of ? `${withError(scale * of.value, 2 * scale * of.sigma, digits)}${unit}` : null;

const withError = (value: number, error: number, digits: number): string =>
  `${value.toFixed(digits)} ± ${error.toFixed(digits)}`;

/** Returns how far the camera has moved and turned. */
export const movedText = (of: Calibration | null | undefined): string =>
  of ? `${withError(of.moved_mm, of.moved_error_mm, 1)} mm` : unknownText;
export const turnedText = (of: Calibration | null | undefined): string =>
  of ? `${withError(of.turned_degrees, of.turned_error_degrees, 2)}°` : unknownText;

/** Returns nanoseconds since 1970 as UTC; stamps of clocks that start at zero as seconds. */
export function stamp(nanoseconds: string | null): string {
  if (nanoseconds === null) return unknownText;
  const value = BigInt(nanoseconds);
  const oneYear = 31_536_000_000_000_000n;
  if (value < oneYear) return `${(Number(value) / 1e9).toFixed(3)} s`;
  return new Date(Number(value / 1_000_000n)).toISOString().replace('T', ' ').replace('Z', '');
}
