// SPDX-License-Identifier: Apache-2.0
// The values under the pointer.
import type { Packet } from '../api/packet';
import { metres, unknownText } from '../model/format';
import { labelName } from '../model/labels';
import { byId, element, setText } from './dom';

/** The values, and their titles. */
const titles = {
  px: 'pixel',
  label: 'label',
  link: 'link',
  virtual: 'model',
  measured: 'measured',
  diff: 'difference',
} as const;
type Name = keyof typeof titles;
const names = Object.keys(titles) as Name[];
type Values = Readonly<Record<Name, string>>;

export interface Pixel {
  readonly u: number;
  readonly v: number;
  /** Index in the image. */
  readonly at: number;
}

export class Readout {
  private readonly swatch = element('i', 'swatch');

  constructor() {
    const fields = names.map((name) => {
      const value = element('span');
      value.id = `read-${name}`;
      const mark = name === 'label' ? [this.swatch] : [];
      return element('div', '', element('dt', '', titles[name]), element('dd', '', ...mark, value));
    });
    byId('readout').replaceChildren(...fields);
  }

  /** @param pixel null: the pointer is outside the image */
  show(packet: Packet | null, links: readonly string[], pixel: Pixel | null): void {
    const values = packet && pixel ? valuesOf(packet, links, pixel) : null;
    for (const name of names) setText(byId(`read-${name}`), values?.[name] ?? unknownText);
    this.swatch.style.background = `var(--l-${values?.label})`;
    this.swatch.hidden = !values || ['clear', unknownText].includes(values.label);
  }
}

/** Returns the values of a pixel; a dash for a part that the packet does not have. */
function valuesOf(packet: Packet, links: readonly string[], { u, v, at }: Pixel): Values {
  const label = packet.labels?.values[at];
  const link = packet.links?.values[at];
  const virtual = packet.vdi?.values[at];
  const measured = packet.depth?.values[at];
  const difference = isDepth(virtual) && isDepth(measured) ? 1000 * (measured - virtual) : null;
  return {
    px: `${u}, ${v}`,
    label: label === undefined ? unknownText : labelName(label),
    link: link === undefined ? unknownText : link ? (links[link - 1] ?? `link ${link}?`) : 'none',
    virtual: depthText(virtual),
    measured: depthText(measured),
    diff: difference === null ? unknownText : signed(difference),
  };
}

const isDepth = (z: number | undefined): z is number => z !== undefined && z > 0 && z < Infinity;

const depthText = (z: number | undefined): string =>
  z === undefined ? unknownText : isDepth(z) ? metres(z) : 'none';

const signed = (millimetres: number): string =>
  `${millimetres < 0 ? '−' : '+'}${Math.abs(millimetres).toFixed(0)} mm`;
