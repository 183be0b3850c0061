// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from 'three';
import type { CameraInfo } from '../api/types';

/** The camera's field of view as lines, in its optical frame; the short bar marks the upper side. */
export class Frustum {
  readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial());

  constructor() {
    this.lines.visible = false;
    this.lines.frustumCulled = false;
  }

  /** @param length metres from the camera to the drawn image plane */
  setCamera(camera: CameraInfo, length: number): void {
    const at = (u: number, v: number): [number, number, number] => [
      ((u - camera.cx) / camera.fx) * length,
      ((v - camera.cy) / camera.fy) * length,
      length,
    ];
    // The image ends half a pixel outside the centres of its outermost pixels.
    const right = camera.width - 0.5;
    const bottom = camera.height - 0.5;
    const corners = [at(-0.5, -0.5), at(right, -0.5), at(right, bottom), at(-0.5, bottom)];
    const segments: number[] = [];
    corners.forEach((corner, index) => {
      const next = corners[(index + 1) % corners.length] ?? corner;
      segments.push(0, 0, 0, ...corner, ...corner, ...next);
    });
    const middle = (camera.width - 1) / 2;
    const bar = -0.09 * camera.height;
    segments.push(...at(0.4 * camera.width, bar), ...at(0.6 * camera.width, bar));
    segments.push(...at(middle, -0.5), ...at(middle, bar));
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute(
      'position',
      new BufferAttribute(new Float32Array(segments), 3),
    );
  }
}
