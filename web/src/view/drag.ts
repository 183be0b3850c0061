// SPDX-License-Identifier: Apache-2.0

const keyStep = 5; // percent

export interface Dragged {
  readonly axis: 'x' | 'y';
  /** What the handle moves in. */
  box(): DOMRect;
  /** Where the handle is, percent of the box. */
  at(): number;
  /** @param percent 0 to 100 */
  move(percent: number): void;
}

/** Moves a handle by pointer, by arrow keys, and to its ends by Home and End. */
export function bindDrag(handle: HTMLElement, { axis, box, at, move }: Dragged): void {
  const to = (percent: number): void => move(Math.min(100, Math.max(0, percent)));
  handle.addEventListener('pointerdown', (event) => {
    event.preventDefault();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
  });
  handle.addEventListener('pointermove', (event) => {
    if (!handle.hasPointerCapture(event.pointerId)) return;
    const { left, top, width, height } = box();
    to(
      axis === 'x'
        ? (100 * (event.clientX - left)) / width
        : (100 * (event.clientY - top)) / height,
    );
  });
  handle.addEventListener('keydown', (event) => {
    const places: Readonly<Record<string, number>> = {
      [axis === 'x' ? 'ArrowLeft' : 'ArrowUp']: at() - keyStep,
      [axis === 'x' ? 'ArrowRight' : 'ArrowDown']: at() + keyStep,
      Home: 0,
      End: 100,
    };
    const percent = places[event.key];
    if (percent === undefined) return;
    event.preventDefault();
    event.stopPropagation(); // elsewhere these keys step
    to(percent);
  });
}
