// SPDX-License-Identifier: Apache-2.0
import type { Object3D } from 'three';
import type { Pose } from '../api/types';

/** Places an object; without a pose it is not shown: nothing stands where nothing is known. */
export function place(object: Object3D, pose: Pose | null | undefined): void {
  object.visible = !!pose;
  if (!pose) return;
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
}
