// SPDX-License-Identifier: Apache-2.0
import type { Packet } from '../api/packet';

/**
 * Why robot or camera are not where they should be in the scene; null: they are.
 * @param missing what is not there in any frame, in the server's words
 */
export function reasonOfNoRobot(packet: Packet, missing: readonly string[]): string | null {
  const { frame, linkPoses, cameraPose } = packet;
  const noPose = linkPoses.length > 0 && linkPoses.every((pose) => pose === null);
  if (frame.status === 'ok' && missing.length > 0 && (noPose || cameraPose === null))
    return missing.join('; ');
  const because = frame.status === 'ok' ? '' : `: ${frame.message ?? frame.status}`;
  if (noPose) return `No robot in this frame, as its pose is not known${because}`;
  const without = linkPoses.filter((pose) => pose === null).length;
  if (without > 0) return `${without} of ${linkPoses.length} links have no pose${because}`;
  if (cameraPose === null) return `The camera's pose is not known: no points${because}`;
  return frame.status === 'ok' ? null : `${frame.status}${because}`;
}
