// SPDX-License-Identifier: Apache-2.0
// A recording with two cameras.
import { cpSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { example } from './browser.mjs';

/**
 * Makes the shipped example with a second camera, 0.1 s later and turned aside.
 * @param right the second camera's name
 */
export function makeCell(cell, { right = 'right' } = {}) {
  cpSync(example, cell, { recursive: true });
  const files =
    '{info: camera_info.yaml, parent: base_link, pose: POSE, depth: "depth/%d.png", color: "color/%d.png"}';
  const pose = readFileSync(path.join(example, 'camera_pose.csv'), 'utf8');
  const rows = pose.trim().split('\n');
  const moved = rows.map((row, index) => {
    const values = row.split(',');
    if (index === 0) values[3] = String(Number(values[3]) + 0.2);
    return values.join(',');
  });
  writeFileSync(path.join(cell, 'aside.csv'), `${moved.join('\n')}\n`);
  writeFileSync(
    path.join(cell, 'recording.yaml'),
    `robot:
  urdf: arm_description/arm.urdf
  packages: {arm_description: arm_description}
cameras:
  left: ${files.replace('POSE', 'camera_pose.csv')}
  ${JSON.stringify(right)}: ${files.replace('POSE', 'aside.csv')}
frames: {joints: joint_states.csv}
targets: targets.yaml
`,
  );
}
