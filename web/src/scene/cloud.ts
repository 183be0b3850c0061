// SPDX-License-Identifier: Apache-2.0
// The point cloud: one GPU buffer, which grows seldom and is overwritten by each frame.
import {
  BufferGeometry,
  DynamicDrawUsage,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Points,
  ShaderMaterial,
  Vector3,
} from 'three';
import { pointBytes } from '../api/packet';
import type { Pose } from '../api/types';
import { isSurroundings, labelColor, labelStyles, rgbOf } from '../model/labels';
import { applyPose } from './robot';

const labelOffset = 12; // bytes
const paletteSize = labelStyles.length + 1;

const vertexShader = /* glsl */ `
  const float robotSkin = 0.03; // metres
  attribute vec4 style; // label, r, g, b
  uniform vec3 palette[${paletteSize}]; // the last colour is for invalid labels
  uniform bool byLabel;
  uniform bool isScan; // in a sensor's frame, not in a camera's
  uniform float metresPerDepth; // distance of neighbouring points at 1 m
  uniform float pixelsHigh;
  varying vec3 shade;
  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    int label = int(style.x * 255.0 + 0.5);
    // Because of noise half of the points on the robot are inside it: these are moved to the front.
    float nearer = label == 2 ? 1.0 - min(robotSkin / length(seen.xyz), 0.5) : 1.0;
    gl_Position = projectionMatrix * vec4(seen.xyz * nearer, 1.0);
    float size = (isScan ? length(position) : position.z) * metresPerDepth * projectionMatrix[1][1] * pixelsHigh * 0.5;
    gl_PointSize = clamp(1.15 * size / -seen.z, 1.5, 24.0);
    vec3 color = style.yzw;
    if (byLabel) {
      float grey = dot(color, vec3(0.299, 0.587, 0.114));
      color = label == 0 ? mix(vec3(grey), color, 0.4) : palette[min(label, ${paletteSize - 1})] * (0.7 + 0.5 * grey);
    }
    shade = color;
  }`;

const fragmentShader = /* glsl */ `
  varying vec3 shade;
  void main() {
    gl_FragColor = vec4(shade, 1.0);
  }`;

export class CloudModel {
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  readonly uniforms = {
    palette: { value: palette() },
    byLabel: { value: true },
    isScan: { value: false },
    metresPerDepth: { value: 0.002 }, // of scans; small, so that they cover no robot
    pixelsHigh: { value: 1 },
  };
  /** The next update leaves out points of the robot and its fringe. */
  withoutRobot = false;
  private bytes = new Uint8Array(0);
  private buffers: readonly InterleavedBuffer[] = [];

  constructor() {
    const material = new ShaderMaterial({ vertexShader, fragmentShader, uniforms: this.uniforms });
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.visible = false;
  }

  /** @returns the number of points shown */
  update(cloud: Uint8Array | undefined, cameraPose: Pose | null): number {
    applyPose(this.points, cloud ? cameraPose : null);
    if (!cloud || !cameraPose) return 0;
    if (cloud.length > this.bytes.length) this.grow(cloud.length);
    const count = this.copy(cloud);
    for (const buffer of this.buffers) {
      buffer.clearUpdateRanges();
      buffer.addUpdateRange(0, count * buffer.stride);
      buffer.needsUpdate = true;
    }
    this.points.geometry.setDrawRange(0, count);
    return count;
  }

  private copy(cloud: Uint8Array): number {
    if (!this.withoutRobot) {
      this.bytes.set(cloud);
      return cloud.length / pointBytes;
    }
    let end = 0;
    for (let at = 0; at < cloud.length; at += pointBytes) {
      if (!isSurroundings(cloud[at + labelOffset] as number)) continue;
      this.bytes.set(cloud.subarray(at, at + pointBytes), end);
      end += pointBytes;
    }
    return end / pointBytes;
  }

  private grow(bytes: number): void {
    this.bytes = new Uint8Array(pointBytes * Math.ceil((1.25 * bytes) / pointBytes));
    this.points.geometry.dispose();
    const floats = new InterleavedBuffer(new Float32Array(this.bytes.buffer), pointBytes / 4);
    const styles = new InterleavedBuffer(this.bytes, pointBytes);
    this.buffers = [floats, styles];
    for (const buffer of this.buffers) buffer.setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new InterleavedBufferAttribute(floats, 3, 0));
    geometry.setAttribute('style', new InterleavedBufferAttribute(styles, 4, labelOffset, true));
    this.points.geometry = geometry;
  }
}

const palette = (): Vector3[] =>
  Array.from({ length: paletteSize }, (_, label) =>
    new Vector3(...rgbOf(labelColor(label) ?? '#808080')).divideScalar(255),
  );
