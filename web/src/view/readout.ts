// SPDX-License-Identifier: Apache-2.0
// The values under the pointer.
import type { Packet } from '../api/packet';
import { metres, nothing } from '../model/format';
import { labelName } from '../model/labels';
import { byId, setText } from './dom';

export interface Readout {
  readonly pixel: string;
  readonly label: string;
  readonly link: string;
  readonly virtual: string;
  readonly measured: string;
  /** Measured less virtual. */
  readonly difference: string;
}

const isDepth = (z: number | undefined): z is number => z !== undefined && z > 0 && z < Infinity;
const depthText = (z: number | undefined): string =>
  z === undefined ? nothing : isDepth(z) ? metres(z) : 'none';

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
    link:
      link === undefined ? nothing : link === 0 ? 'no link' : (links[link - 1] ?? `link ${link}?`),
    virtual: depthText(virtual),
    measured: depthText(measured),
    difference: both
      ? `${millimetres >= 0 ? '+' : '−'}${Math.abs(millimetres).toFixed(0)} mm`
      : nothing,
  };
}

const fields = ['pixel', 'label', 'link', 'virtual', 'measured', 'difference'] as const;

/** null: the pointer is not over the image. */
export function showReadout(readout: Readout | null): void {
  for (const field of fields) setText(byId(`read-${field}`), readout?.[field] ?? nothing);
  const swatch = byId('read-swatch');
  swatch.style.background = `var(--l-${readout?.label})`;
  swatch.hidden = !readout || [nothing, 'clear'].includes(readout.label);
}
