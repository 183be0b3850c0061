// SPDX-License-Identifier: Apache-2.0
import { depthPercentiles } from '../model/depth_colors';
import { metres } from '../model/format';
import { labelStyles, linkColor } from '../model/labels';
import { byId, element, swatch } from './dom';
import type { Layer } from './image_view';

let shown = '';

/** What the layer's colours mean; made again only when that changes. */
export function layerLegend(
  layer: Layer,
  links: readonly string[],
  range: readonly [number, number] | null,
  withoutRobot: boolean,
): void {
  const key = [layer, withoutRobot, ...(range ?? []).map(metres), ...links].join('|');
  if (key === shown) return;
  shown = key;
  const entries =
    layer === 'vdi' || layer === 'depth'
      ? depthEntries(layer, range)
      : layer === 'links'
        ? links.map((name, index) => entry(name, `rgb(${linkColor(index).join(' ')})`))
        : labelStyles.flatMap(({ name, color, meaning }) =>
            color ? [entry(name, color, meaning)] : [],
          );
  if (withoutRobot) entries.push(element('span', 'hint', 'chequered: left out'));
  byId('picture-legend').replaceChildren(...entries);
}

/** Colours beyond the ends are those of the ends. */
function depthEntries(layer: Layer, range: readonly [number, number] | null): HTMLElement[] {
  const [low, high] = depthPercentiles;
  const ends = (range ?? [null, null]).map((end) => element('span', '', metres(end)));
  const scale = element('span', 'legend-entry', ends[0] ?? '', element('i', 'depth-bar'));
  scale.append(ends[1] ?? '');
  scale.title = `the ${low}nd and ${high}th percentile of the depths of the frames that were shown`;
  const nothing = layer === 'vdi' ? 'clear: no robot' : 'striped: no measurement';
  return [
    scale,
    element('span', 'hint', `percentiles ${low}–${high}`),
    element('span', 'hint', nothing),
  ];
}

function entry(name: string, color: string, meaning = ''): HTMLElement {
  const made = element('span', 'legend-entry', swatch(color), name);
  made.title = meaning;
  return made;
}
