// SPDX-License-Identifier: Apache-2.0
// The page of `penumbra cloud --port`: a sensor that measures points, without images.
import assert from 'node:assert/strict';
import { cpSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { desktop, example, phone, showsFrame } from './browser.mjs';
import { served } from './served.mjs';

// Before the arm's base, behind it, and far from it, as seen from (1.5, 0, 0.1) in the base.
const cloud = `FIELDS x y z
SIZE 4 4 4
TYPE F F F
WIDTH 3
HEIGHT 1
DATA ascii
-0.5 0 0
-2.5 0 0
0 2 0
`;
const recording = `robot: {urdf: arm_description/arm.urdf, packages: {arm_description: arm_description}}
sensor: {pose: pose.csv}
frames: {joints: joint_states.csv, cloud: clouds/%d.pcd}
`;

const folder = mkdtempSync(path.join(tmpdir(), 'penumbra-clouds-'));
after(() => rmSync(folder, { recursive: true }));
for (const name of ['arm_description', 'joint_states.csv'])
  cpSync(path.join(example, name), path.join(folder, name), { recursive: true });
writeFileSync(path.join(folder, 'pose.csv'), '1,0,0,1.5\n0,1,0,0\n0,0,1,0.1\n0,0,0,1\n');
writeFileSync(path.join(folder, 'recording.yaml'), recording);
mkdirSync(path.join(folder, 'clouds'));
for (let frame = 0; frame < 12; ++frame)
  writeFileSync(path.join(folder, `clouds/${frame}.pcd`), cloud);
const { withPage } = served(folder, 'cloud');

for (const [name, device] of Object.entries({ desktop, phone }))
  test(`on a ${name} there are points and their labels, and no image`, () =>
    withPage('/', device, async (page) => {
      await showsFrame(page, 0, 'cloud');
      const canvas = page.locator('#scene-canvas');
      assert.equal(await canvas.getAttribute('data-points'), '3');
      const box = await canvas.boundingBox();
      assert.ok(box.width > 300 && box.height > 200, JSON.stringify(box));
      for (const hidden of ['#image', '#view-tabs', '.row-head.stages', '[data-key=c]'])
        assert.equal(await page.locator(hidden).first().isVisible(), false, hidden);
      const numbers = page.locator('#frame-details');
      for (const label of ['front', 'beyond', 'clear'])
        assert.equal(await numbers.locator(`[data-key=${label}]`).getAttribute('data-value'), '1');
      await page.keyboard.press('w');
      await page.locator('#scene-canvas[data-points="2"]').waitFor();
      await page.keyboard.press('ArrowRight');
      await showsFrame(page, 1, 'cloud');
    }));
