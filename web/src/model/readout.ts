// SPDX-License-Identifier: Apache-2.0
// What stands under the pointer, in words.
import type { Packet } from '../api/packet';
import { labelName } from './labels';
import { metres, nothing } from './format';

export interface Readout {
  readonly pixel: string;
  readonly label: string;
  readonly labelValue: number | null;
  readonly link: string;
  readonly virtual: string;
  readonly measured: string;
  /** Measured less virtual. */
  readonly difference: string;
}

const isDepth = (z: number | undefined): z is number => z !== undefined && z > 0 && z < Infinity;

/** Parts that did not come are dashes; a depth of nothing says so. */
export function readoutAt(
  packet: Packet,
  links: readonly string[],
  u: number,
  v: number,
  width: number,
): Readout {
  const at = v * width + u;
  const label = packet.labels?.values[at];
  const link = packet.links?.values[at];
  const virtual = packet.vdi?.values[at];
  const measured = packet.depth?.values[at];
  const both = isDepth(virtual) && isDepth(measured);
  const millimetres = both ? 1000 * (measured - virtual) : 0;
  return {
    pixel: `${u}, ${v}`,
    label: label === undefined ? nothing : labelName(label),
    labelValue: label ?? null,
    link:
      link === undefined ? nothing : link === 0 ? 'no link' : (links[link - 1] ?? `link ${link}?`),
    virtual: virtual === undefined ? nothing : isDepth(virtual) ? metres(virtual) : 'none',
    measured: measured === undefined ? nothing : isDepth(measured) ? metres(measured) : 'none',
    difference: both
      ? `${millimetres >= 0 ? '+' : '−'}${Math.abs(millimetres).toFixed(0)} mm`
      : nothing,
  };
}
