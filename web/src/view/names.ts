// SPDX-License-Identifier: Apache-2.0
// Names of targets, as text over the scene and the image.

export interface Placed {
  readonly name: HTMLElement;
  readonly x: number;
  y: number;
}

/** Moves each name to its place, in pixels; the lower one of two that overlap gives way. */
export function placeNames(names: Placed[]): void {
  names.sort((a, b) => a.y - b.y);
  names.forEach((one, index) => moveBelow(one, names.slice(0, index)));
  for (const { name, x, y } of names)
    name.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
}

function moveBelow(one: Placed, others: readonly Placed[]): void {
  for (const other of others) {
    const left = one.x <= other.x ? one : other;
    const apart = Math.abs(one.x - other.x) > left.name.offsetWidth;
    const height = other.name.offsetHeight + 1;
    if (!apart && Math.abs(one.y - other.y) < height) one.y = other.y + height;
  }
}
