// SPDX-License-Identifier: Apache-2.0
// Charts in rows over one axis of frames, with a playhead and a tip under the pointer. What the rows
// show is their own affair.
import { verdictNames } from '../model/labels';
import type { Track } from '../model/timeline';
import type { Verdict } from '../api/types';
import { element, setText } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';
import { targetChart } from './charts';
import { addPatterns } from './patterns';

export interface Row {
  readonly head: HTMLElement;
  readonly chart: HTMLElement;
  draw(width: number): SVGSVGElement;
  /** What is said of a frame under the pointer; each line begins with a line break. */
  tip?(frame: number): string;
  /** What stands beside the name, as the largest value. */
  scale?(): string;
}

export interface TimeRowsHandlers {
  seek(frame: number): void;
  /** A frame in words: its number and time. */
  titleOf(frame: number): string;
}

export class TimeRows {
  private rows: readonly Row[] = [];
  private count = 0;
  private current = 0;
  private width = 0;
  private readonly grid = element('div', 'timeline-grid');
  private readonly playhead = element('div', 'playhead');
  private readonly tip = element('div', 'tip');

  constructor(
    private readonly host: HTMLElement,
    private readonly handlers: TimeRowsHandlers,
  ) {
    addPatterns();
    this.playhead.setAttribute('role', 'slider');
    this.playhead.setAttribute('aria-label', 'Frame');
    this.playhead.tabIndex = 0;
    this.tip.hidden = true;
    host.replaceChildren(this.grid, this.playhead, this.tip);
    host.addEventListener('pointerdown', (event) => this.press(event));
    host.addEventListener('pointermove', (event) => this.move(event));
    host.addEventListener('pointerleave', () => (this.tip.hidden = true));
    new ResizeObserver(() => this.redraw(false)).observe(host);
  }

  setRows(rows: readonly Row[]): void {
    this.rows = rows;
    this.grid.replaceChildren(...rows.flatMap((row) => [row.head, row.chart]));
  }

  /** Draws the rows for so many frames. */
  setCount(count: number): void {
    this.count = count;
    this.redraw(true);
  }

  setCurrent(frame: number): void {
    this.current = frame;
    const count = Math.max(this.count, 1);
    this.host.style.setProperty('--at', String((Math.min(frame, count - 1) + 0.5) / count));
    this.playhead.setAttribute('aria-valuemin', '0');
    this.playhead.setAttribute('aria-valuemax', String(count - 1));
    this.playhead.setAttribute('aria-valuenow', String(frame));
    this.playhead.setAttribute('aria-valuetext', this.handlers.titleOf(frame));
  }

  /** @param always also where the width is what it was */
  redraw(always: boolean): void {
    const width = this.rows[0]?.chart.clientWidth ?? 0;
    if (width === 0 || (width === this.width && !always) || this.count === 0) return;
    this.width = width;
    for (const row of this.rows) {
      row.chart.replaceChildren(row.draw(width));
      if (row.scale && row.head.lastElementChild)
        row.head.lastElementChild.textContent = row.scale();
    }
  }

  private frameAt(clientX: number): number | null {
    const box = this.rows[0]?.chart.getBoundingClientRect();
    if (!box || clientX < box.left - 4 || clientX > box.right + 4) return null;
    const frame = Math.floor(((clientX - box.left) / box.width) * this.count);
    return Math.min(Math.max(frame, 0), this.count - 1);
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0 || (event.target as Element).closest('button')) return;
    const frame = this.frameAt(event.clientX);
    if (frame === null) return;
    if (event.pointerType === 'mouse') this.host.setPointerCapture(event.pointerId);
    this.handlers.seek(frame);
  }

  private move(event: PointerEvent): void {
    const frame = this.frameAt(event.clientX);
    if (frame !== null && event.buttons === 1 && frame !== this.current) this.handlers.seek(frame);
    this.tip.hidden = frame === null || event.pointerType === 'touch';
    if (frame === null) return;
    const hovered = this.rows.find(({ chart }) => {
      const { top, bottom } = chart.getBoundingClientRect();
      return event.clientY >= top && event.clientY <= bottom;
    });
    setText(this.tip, `${this.handlers.titleOf(frame)}${hovered?.tip?.(frame) ?? ''}`);
    const box = this.host.getBoundingClientRect();
    const right = event.clientX > box.left + 0.6 * box.width;
    this.tip.classList.toggle('left', right);
    this.tip.style.left = `${event.clientX - box.left}px`;
    this.tip.style.top = `${event.clientY - box.top + this.host.scrollTop}px`;
  }
}

/** A row with a name, and its scale beside it. */
export function plainRow(
  kind: string,
  title: string,
  draw: Row['draw'],
  more: Pick<Row, 'tip' | 'scale'> = {},
): Row {
  const names = [element('span', '', title), element('span', 'scale')];
  const head = element('div', `row-head plain ${kind}`, ...names);
  return { head, chart: element('div', `row-body ${kind}`), draw, ...more };
}

/** A target's row: its name is a button that chooses it, with the verdict of the current frame. */
export class TargetRow implements Row {
  readonly head: HTMLButtonElement;
  readonly chart = element('div', 'row-body target-row');

  constructor(
    readonly name: string,
    choose: () => void,
    private readonly track: () => Track | undefined,
    readonly tip: (frame: number) => string,
  ) {
    this.head = element('button', 'row-head', verdictIcon('unknown'), element('span', '', name));
    this.head.type = 'button';
    this.head.title = name;
    this.head.addEventListener('click', choose);
  }

  draw(width: number): SVGSVGElement {
    const track = this.track() ?? { name: this.name, samples: [] };
    return targetChart(track, width, `${this.name}: occluded fraction and verdict`);
  }

  setVerdict(verdict: Verdict): void {
    const icon = this.head.querySelector('svg');
    if (icon && !icon.classList.contains(verdict)) icon.replaceWith(verdictIcon(verdict));
  }

  setChosen(chosen: boolean): void {
    this.head.setAttribute('aria-pressed', String(chosen));
    this.chart.classList.toggle('chosen', chosen);
  }
}

/** `name: verdict · more · more`, without what is empty. */
export const verdictLine = (
  name: string,
  verdict: Verdict,
  ...more: readonly (string | null | undefined)[]
): string => `\n${name}: ${[verdictNames[verdict], ...more].filter(Boolean).join(' · ')}`;
