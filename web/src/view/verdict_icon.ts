// SPDX-License-Identifier: Apache-2.0
import type { Verdict } from '../api/types';
import { svg } from './dom';

const ring = { cx: 8, cy: 8, r: 5.5, class: 'ring' };

/** Returns a shape per verdict: disc, half disc, cross, question mark, dashed ring, ring
 * around a dot. */
export function verdictIcon(verdict: Verdict): SVGSVGElement {
  const icon = svg('svg', {
    class: `verdict-icon ${verdict}`,
    viewBox: '0 0 16 16',
    'aria-hidden': 'true',
  });
  switch (verdict) {
    case 'visible':
      icon.append(svg('circle', { cx: 8, cy: 8, r: 6, class: 'full' }));
      break;
    case 'partial':
      icon.append(svg('circle', ring), svg('path', { d: 'M8 2a6 6 0 0 0 0 12z', class: 'full' }));
      break;
    case 'hidden':
      icon.append(
        svg('rect', { x: 2, y: 2, width: 12, height: 12, rx: 2, class: 'full' }),
        svg('path', { d: 'M5.2 5.2l5.6 5.6M10.8 5.2l-5.6 5.6', class: 'cut' }),
      );
      break;
    case 'unknown':
      icon.append(
        svg('path', { d: 'M8 1.2 14.8 8 8 14.8 1.2 8z', class: 'full' }),
        svg('text', { x: 8, y: 11.4, 'text-anchor': 'middle', class: 'mark' }, '?'),
      );
      break;
    case 'out_of_view':
      icon.append(svg('circle', { ...ring, 'stroke-dasharray': '2.2 2.2' }));
      break;
    case 'held':
      icon.append(svg('circle', ring), svg('circle', { cx: 8, cy: 8, r: 2.5, class: 'full' }));
  }
  return icon;
}
