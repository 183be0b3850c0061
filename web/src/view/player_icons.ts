// SPDX-License-Identifier: Apache-2.0
import { svg } from './dom';

const paths: Readonly<Record<string, readonly string[]>> = {
  'previous-occlusion': ['M5 5v14', 'M19 5 9 12l10 7z'],
  'step-back': ['M15.5 6 8 12l7.5 6z'],
  play: ['M7 4.5v15l12-7.5z'],
  pause: ['M7 5h3.5v14H7zM13.5 5H17v14h-3.5z'],
  'step-forward': ['M8.5 6 16 12l-7.5 6z'],
  'next-occlusion': ['M19 5v14', 'M5 5l10 7-10 7z'],
};

/** Play and pause are both there; the style sheet shows one. */
export function playerIcon(id: string): SVGSVGElement {
  const icon = svg('svg', { viewBox: '0 0 24 24', 'aria-hidden': 'true', class: 'player-icon' });
  for (const d of paths[id] ?? [])
    icon.append(svg('path', { d, class: id === 'play' ? 'when-paused' : '' }));
  if (id === 'play')
    icon.append(svg('path', { d: paths['pause']?.[0] ?? '', class: 'when-playing' }));
  return icon;
}
