// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them; what is not known is a dash, never a zero.

export const nothing = '–';

const known = (value: number | null | undefined): value is number =>
  value !== null && value !== undefined && Number.isFinite(value);

export const percent = (fraction: number | null | undefined, digits = 1): string =>
  known(fraction) ? `${(100 * fraction).toFixed(digits)} %` : nothing;

export const metres = (value: number | null | undefined): string =>
  known(value) ? `${value.toFixed(3)} m` : nothing;

export const count = (value: number | null | undefined): string =>
  known(value) ? value.toLocaleString('en-US').replaceAll(',', '\u202f') : nothing;

export function milliseconds(value: number | null | undefined): string {
  if (!known(value)) return nothing;
  if (Math.abs(value) < 1) return `${value.toFixed(3)} ms`;
  return `${value.toFixed(Math.abs(value) < 100 ? 1 : 0)} ms`;
}

export const seconds = (value: number | null | undefined, digits = 2): string =>
  known(value) ? `${value.toFixed(digits)} s` : nothing;

export const vector = (value: readonly number[] | null | undefined, digits = 3): string =>
  value ? value.map((part) => part.toFixed(digits)).join('  ') : nothing;

/** Nanoseconds since 1970 as UTC; stamps of clocks that start at zero stay seconds. */
export function stamp(nanoseconds: string | null): string {
  if (nanoseconds === null) return nothing;
  const value = BigInt(nanoseconds);
  const oneYear = 31_536_000_000_000_000n;
  if (value < oneYear) return `${(Number(value) / 1e9).toFixed(3)} s`;
  return new Date(Number(value / 1_000_000n)).toISOString().replace('T', ' ').replace('Z', '');
}
