// SPDX-License-Identifier: Apache-2.0
// Scales by powers of ten, as shares from 0 to 1.

export interface LogScale {
  readonly low: number;
  readonly high: number;
}

/** Values beyond the ends lie on them. */
export function shareOf({ low, high }: LogScale, value: number): number {
  const inside = Math.min(Math.max(value, low), high);
  return Math.log(inside / low) / Math.log(high / low);
}

/** The powers of ten that hold all values, at least one between them; null: nothing is above 0. */
export function scaleOf(values: readonly number[]): LogScale | null {
  const shown = values.filter((value) => value > 0);
  if (shown.length === 0) return null;
  const low = 10 ** Math.floor(Math.log10(Math.min(...shown)));
  return { low, high: Math.max(10 ** Math.ceil(Math.log10(Math.max(...shown))), 10 * low) };
}

export function ticksOf({ low, high }: LogScale): number[] {
  const ticks = [];
  for (let tick = low; tick <= high * 1.001; tick *= 10) ticks.push(tick);
  return ticks;
}

/** 0.1 mm, 1 mm, 1 cm, 1 m: a power of ten of millimetres. */
export function lengthName(millimetres: number): string {
  const value = Number(millimetres.toPrecision(6));
  if (value < 10) return `${value} mm`;
  return value < 1000 ? `${value / 10} cm` : `${value / 1000} m`;
}
