// SPDX-License-Identifier: Apache-2.0
import type { Verdict } from '../api/types';
import { svg } from '../view/dom';

/** Fills that differ without colour too: plain, stripes, grid, dots, nothing. */
export function addPatterns(): void {
  if (document.getElementById('timeline-patterns')) return;
  const defs = svg(
    'defs',
    {},
    pattern('p-partial', 6, svg('path', { d: 'M-1 7 7-1M2 10 10 2M-4 4 4-4' })),
    pattern('p-hidden', 5, svg('path', { d: 'M0 0 5 5M5 0 0 5' })),
    pattern('p-unknown', 5, svg('circle', { cx: 2.5, cy: 2.5, r: 1.15 })),
    pattern('p-none', 6, svg('path', { d: 'M-1 1 1-1M0 6 6 0M5 7 7 5' })),
    pattern('p-fault', 6, svg('path', { d: 'M0 0 6 6M6 0 0 6' })),
  );
  document.body.append(
    svg('svg', { id: 'timeline-patterns', width: 0, height: 0, 'aria-hidden': 'true' }, defs),
  );
}

function pattern(id: string, size: number, ...marks: SVGElement[]): SVGPatternElement {
  const ground = svg('rect', { width: size, height: size, class: 'ground' });
  const units = { patternUnits: 'userSpaceOnUse', width: size, height: size };
  return svg('pattern', { id, class: id, ...units }, ground, ...marks);
}

export const verdictFill: Readonly<Record<Verdict, string>> = {
  visible: 'var(--v-visible)',
  partial: 'url(#p-partial)',
  hidden: 'url(#p-hidden)',
  unknown: 'url(#p-unknown)',
  out_of_view: 'none',
};
