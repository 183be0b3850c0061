// SPDX-License-Identifier: Apache-2.0
import { metres } from '../model/format';
import { labelStyles, linkColor } from '../model/labels';
import { byId, element } from './dom';
import type { Layer } from './image_view';

let shown = '';

/** What the layer's colours mean; made again only when that changes. */
export function layerLegend(
  layer: Layer,
  links: readonly string[],
  [near, far]: readonly [number, number],
  withoutRobot: boolean,
): void {
  const key = `${layer}|${links.join()}|${near.toFixed(3)}|${far.toFixed(3)}|${withoutRobot}`;
  if (key === shown) return;
  shown = key;
  const legend = byId('picture-legend');
  if (layer === 'vdi' || layer === 'depth') {
    const bar = element('span', 'depth-bar');
    legend.replaceChildren(metres(far > 0 ? near : null), bar, metres(far > 0 ? far : null));
    legend.append(
      element('span', 'hint', layer === 'vdi' ? 'clear: no robot' : 'striped: no measurement'),
    );
  } else if (layer === 'links') {
    legend.replaceChildren(...links.map((name, index) => swatch(name, rgb(index), '')));
  } else {
    const styles = labelStyles.filter((style) => style.color !== null);
    legend.replaceChildren(
      ...styles.map((style) => swatch(style.name, style.color ?? '', style.meaning)),
    );
  }
  if (withoutRobot) legend.append(element('span', 'hint', 'chequered: left out'));
}

const rgb = (index: number): string => `rgb(${linkColor(index).join(' ')})`;

function swatch(name: string, color: string, meaning: string): HTMLElement {
  const box = element('i', 'swatch');
  box.style.backgroundColor = color;
  const entry = element('span', 'legend-entry', box, name);
  if (meaning) entry.title = meaning;
  return entry;
}
