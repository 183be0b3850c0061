// SPDX-License-Identifier: Apache-2.0
// The parts of a report's page.
import { timelineLegend } from '../timeline/legend';
import { element } from '../view/dom';

export const section = (title: string, ...content: (Node | string)[]): HTMLElement =>
  element('section', '', element('h2', '', title), ...content);

export const card = (title: string, content: Node): HTMLElement =>
  element('div', 'panel card', element('h3', '', title), content);

export function tile(name: string, value: string, more: string, fault = false): HTMLElement {
  const strong = element('strong', '', value);
  const lines = [element('span', 'hint', name), strong, element('span', 'hint', more)];
  return element('div', `panel tile${fault ? ' fault' : ''}`, ...lines);
}

export const row = (tag: 'th' | 'td', cells: readonly string[]): HTMLTableRowElement =>
  element('tr', '', ...cells.map((cell) => element(tag, '', cell)));

/** Returns the element that a timeline is drawn in, and the panel that holds it below its legend. */
export function timelinePanel(): [HTMLElement, HTMLElement] {
  const chart = element('div', '');
  chart.id = 'timeline';
  const legend = element('div', '', ...timelineLegend());
  legend.id = 'timeline-legend';
  return [chart, element('div', 'panel', legend, chart)];
}

/**
 * The arrow keys go from frame to frame; on the playhead Home and End to the first and the last one.
 * Elsewhere these scroll.
 * @param seek takes any number, and goes to the nearest frame
 */
export function onFrameKeys(current: () => number, seek: (frame: number) => void): void {
  document.addEventListener('keydown', (event) => {
    const { key, target } = event;
    const by = key === 'ArrowRight' ? 1 : key === 'ArrowLeft' ? -1 : 0;
    const ends: Readonly<Record<string, number>> = { Home: 0, End: Infinity };
    const isPlayhead = target instanceof Element && target.closest('[role=slider]') !== null;
    const end = isPlayhead ? ends[key] : undefined;
    if (end !== undefined) event.preventDefault();
    if (end !== undefined || by !== 0) seek(end ?? current() + by);
  });
}
