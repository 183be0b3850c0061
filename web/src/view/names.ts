// SPDX-License-Identifier: Apache-2.0
// Names of targets, as text over the scene and the image.
import type { TargetReport } from '../api/types';
import { verdictOf } from '../model/labels';
import { element } from './dom';
import { verdictIcon } from './verdict_icon';

export interface PlacedName {
  readonly name: HTMLElement;
  readonly x: number;
  y: number;
}

export const targetName = (target: TargetReport): HTMLElement =>
  element('span', 'target-name', verdictIcon(verdictOf(target)), target.name);

/** Moves each name to its position, pixels; of two that overlap, the lower one moves down. */
export function placeNames(names: PlacedName[]): void {
  names.sort((a, b) => a.y - b.y);
  names.forEach((one, index) => moveBelow(one, names.slice(0, index)));
  for (const { name, x, y } of names)
    name.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
}

function moveBelow(one: PlacedName, others: readonly PlacedName[]): void {
  for (const other of others) {
    const left = one.x <= other.x ? one : other;
    const isApart = Math.abs(one.x - other.x) > left.name.offsetWidth;
    const height = other.name.offsetHeight + 1;
    if (!isApart && Math.abs(one.y - other.y) < height) one.y = other.y + height;
  }
}
