// SPDX-License-Identifier: Apache-2.0
import type { Layer } from '../api/types';
import { depthPercentiles, fullResidual, type DepthRange } from '../model/depth_colors';
import { metres } from '../model/format';
import { labelStyles, linkColor } from '../model/labels';
import { byId, element, swatch } from './dom';

let shown = '';

/** Explains the colours of a layer; updates the page only after a change. */
export function showLegend(
  layer: Layer,
  links: readonly string[],
  range: DepthRange | null,
  withoutRobot: boolean,
): void {
  const key = [layer, withoutRobot, ...(range ?? []).map(metres), ...links].join('|');
  if (key === shown) return;
  shown = key;
  const entries = entriesOf(layer, links, range);
  if (withoutRobot) entries.push(element('span', 'hint', 'checkered: removed'));
  byId('image-legend').replaceChildren(...entries);
}

function entriesOf(layer: Layer, links: readonly string[], range: DepthRange | null): Node[] {
  if (layer === 'vdi') return [...depthEntries(range), element('span', 'hint', 'clear: no robot')];
  if (layer === 'depth')
    return [...depthEntries(range), element('span', 'hint', 'striped: no measurement')];
  if (layer === 'residual') return residualEntries();
  if (layer === 'links')
    return links.map((name, index) => entry(name, `rgb(${linkColor(index).join(' ')})`));
  return labelStyles.flatMap(({ name, color, meaning }) =>
    color ? [entry(name, color, meaning)] : [],
  );
}

function depthEntries(range: DepthRange | null): HTMLElement[] {
  const [low, high] = depthPercentiles;
  const [near, far] = (range ?? [null, null]).map(metres) as [string, string];
  const scale = element('span', 'legend-entry', near, element('i', 'depth-bar'), far);
  scale.title = `${low}nd and ${high}th percentile of depth over the frames shown so far`;
  return [scale, element('span', 'hint', `percentiles ${low}–${high}`)];
}

function residualEntries(): HTMLElement[] {
  const most = `${1000 * fullResidual} mm`;
  return [
    element('span', 'legend-entry', `−${most}`, element('i', 'residual-bar'), `+${most}`),
    element('span', 'hint', 'red: measured behind the robot, striped: no measurement'),
  ];
}

function entry(name: string, color: string, meaning = ''): HTMLElement {
  const made = element('span', 'legend-entry', swatch(color), name);
  made.title = meaning;
  return made;
}
