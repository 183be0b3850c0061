// SPDX-License-Identifier: Apache-2.0
// A frame without the robot: the pixels and points whose label says that they show something else.
import { pointBytes, type Cloud } from '../api/packet';

/** Bytes of a point before its label. */
export const labelOffset = 12;

/** Returns whether a label is clear or front. */
export const isSurroundings = (label: number): boolean => label === 0 || label === 1;

/** Returns whether the robot is on the ray: a label is neither clear nor fringe. */
export const isRobot = (label: number): boolean => label !== 0 && label !== 5;

/**
 * Copies the points of the surroundings, one after another.
 * @param to has room for all points
 * @returns how many were copied
 */
export function copySurroundings(cloud: Cloud, to: Uint8Array): number {
  let count = 0;
  for (let at = 0; at < cloud.bytes.length; at += pointBytes) {
    if (!isSurroundings(cloud.bytes[at + labelOffset] as number)) continue;
    to.set(cloud.bytes.subarray(at, at + pointBytes), pointBytes * count++);
  }
  return count;
}
