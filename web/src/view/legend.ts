// SPDX-License-Identifier: Apache-2.0
import type { Layer } from '../api/types';
import { depthPercentiles, fullResidual, type DepthRange } from '../model/depth_colors';
import { metres } from '../model/format';
import { labelStyles, linkColor } from '../model/labels';
import { byId, element, swatch, term } from './dom';
import { outlineColors } from './painters';

let shown = '';

/** Explains the colours of a layer; updates the page only after a change. */
export function showLegend(
  layer: Layer,
  links: readonly string[],
  range: DepthRange | null,
  withoutRobot: boolean,
  hasOutlines: boolean,
): void {
  const key = [layer, withoutRobot, hasOutlines, ...(range ?? []).map(metres), ...links].join('|');
  if (key === shown) return;
  shown = key;
  const entries = entriesOf(layer, links, range);
  if (hasOutlines && layer === 'overlay')
    entries.push(
      ...['outline by the pose in use', 'by the found pose'].map((name, pose) =>
        entry(name, outlineColors[pose] as string),
      ),
    );
  if (withoutRobot) entries.push(element('span', 'hint', 'checkered: removed'));
  byId('image-legend').replaceChildren(...entries);
  byId('image-legend').classList.toggle('terms', layer === 'overlay' || layer === 'labels');
}

function entriesOf(layer: Layer, links: readonly string[], range: DepthRange | null): Node[] {
  if (layer === 'vdi')
    return depthEntries('distance of the robot model', range, 'transparent: no robot');
  if (layer === 'depth')
    return depthEntries('distance that the camera measured', range, 'striped: no measurement');
  if (layer === 'residual') return residualEntries();
  if (layer === 'links')
    return links.map((name, index) => entry(name, `rgb(${linkColor(index).join(' ')})`));
  return labelStyles.flatMap(({ name, color, plain }) =>
    color ? [entry(term(plain, name), color)] : [],
  );
}

function depthEntries(what: string, range: DepthRange | null, rest: string): HTMLElement[] {
  const [low, high] = depthPercentiles;
  const [near, far] = (range ?? [null, null]).map(metres) as [string, string];
  const scale = element('span', 'legend-entry', near, element('i', 'depth-bar'), far);
  scale.title = `${low}nd and ${high}th percentile of depth over the frames shown so far`;
  return [element('span', '', what), scale, element('span', 'hint', rest)];
}

function residualEntries(): HTMLElement[] {
  const most = `${1000 * fullResidual} mm`;
  return [
    element(
      'span',
      'legend-entry',
      `in front of the robot model −${most}`,
      element('i', 'residual-bar'),
      `+${most} behind it`,
    ),
    element('span', 'hint', 'striped: no measurement'),
  ];
}

const entry = (name: Node | string, color: string): HTMLElement =>
  element('span', 'legend-entry', swatch(color), name);
