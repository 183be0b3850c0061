// SPDX-License-Identifier: Apache-2.0

const keyStep = 5; // percent

/** A handle that moves along one axis of a box; positions are percentages of the box. */
export interface Handle {
  readonly axis: 'x' | 'y';
  box(): DOMRect;
  at(): number;
  move(percent: number): void;
}

/** Moves a handle by pointer, arrow keys, Home and End. */
export function bindDrag(handle: HTMLElement, { axis, box, at, move }: Handle): void {
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
    const positions: Readonly<Record<string, number>> = {
      [axis === 'x' ? 'ArrowLeft' : 'ArrowUp']: at() - keyStep,
      [axis === 'x' ? 'ArrowRight' : 'ArrowDown']: at() + keyStep,
      Home: 0,
      End: 100,
    };
    const percent = positions[event.key];
    if (percent === undefined) return;
    event.preventDefault();
    event.stopPropagation(); // else these keys step frames
    to(percent);
  });
}
