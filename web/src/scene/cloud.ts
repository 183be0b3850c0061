// SPDX-License-Identifier: Apache-2.0
// The point cloud: one buffer on the GPU, grown seldom and written again for each frame.
import {
  BufferGeometry,
  DynamicDrawUsage,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Points,
  ShaderMaterial,
  Vector3,
} from 'three';
import { pointBytes, type Cloud } from '../api/packet';
import type { Pose } from '../api/types';
import { labelColor, labelStyles, rgbOf } from '../model/labels';
import { copySurroundings, labelOffset } from '../model/surroundings';
import { place } from './robot';

export type CloudColors = 'label' | 'color';

const floatsOfPoint = pointBytes / 4;

const paletteSize = labelStyles.length + 1;

const vertexShader = /* glsl */ `
  const float robotSkin = 0.03; // metres
  attribute vec4 style; // label, r, g, b
  uniform vec3 palette[${paletteSize}]; // the last one's: labels that are not known
  uniform bool byLabel;
  uniform float metresPerDepth; // a point's size at 1 m: the pixels that it stands for
  uniform float pixelsHigh;
  varying vec3 shade;
  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    int label = int(style.x * 255.0 + 0.5);
    // Noise would hide every other point on the robot inside of it: those are drawn first in depth.
    float nearer = label == 2 ? 1.0 - min(robotSkin / length(seen.xyz), 0.5) : 1.0;
    gl_Position = projectionMatrix * vec4(seen.xyz * nearer, 1.0);
    float size = position.z * metresPerDepth * projectionMatrix[1][1] * pixelsHigh * 0.5;
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
  /** Points of the robot and of its fringe are left out of what is shown next. */
  withoutRobot = false;
  private bytes = new Uint8Array(0);
  private floats: InterleavedBuffer | null = null;
  private styles: InterleavedBuffer | null = null;

  constructor() {
    const palette = Array.from({ length: paletteSize }, (_, value) => {
      const [r, g, b] = rgbOf(labelColor(value) ?? '#808080');
      return new Vector3(r / 255, g / 255, b / 255);
    });
    const material = new ShaderMaterial({
      vertexShader,
      fragmentShader,
      uniforms: {
        palette: { value: palette },
        byLabel: { value: true },
        metresPerDepth: { value: 0.005 },
        pixelsHigh: { value: 1 },
      },
    });
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.visible = false;
  }

  /**
   * @param metresPerDepth pixels between points over the focal length
   * @returns how many points are shown
   */
  update(cloud: Cloud | undefined, cameraPose: Pose | null, metresPerDepth: number): number {
    place(this.points, cloud ? cameraPose : null);
    if (!cloud || !cameraPose) return 0;
    if (cloud.bytes.length > this.bytes.length) this.grow(cloud.bytes.length);
    const count = this.copy(cloud);
    for (const buffer of [this.floats, this.styles]) {
      if (!buffer) continue;
      buffer.clearUpdateRanges();
      buffer.addUpdateRange(0, count * buffer.stride);
      buffer.needsUpdate = true;
    }
    this.points.geometry.setDrawRange(0, count);
    this.set('metresPerDepth', metresPerDepth);
    return count;
  }

  setColors(colors: CloudColors): void {
    this.set('byLabel', colors === 'label');
  }

  setPixelsHigh(pixels: number): void {
    this.set('pixelsHigh', pixels);
  }

  private set(name: string, value: number | boolean): void {
    const uniform = this.points.material.uniforms[name];
    if (uniform) uniform.value = value;
  }

  private copy(cloud: Cloud): number {
    if (this.withoutRobot) return copySurroundings(cloud, this.bytes);
    this.bytes.set(cloud.bytes);
    return cloud.count;
  }

  private grow(bytes: number): void {
    const capacity = pointBytes * Math.ceil((1.25 * bytes) / pointBytes);
    this.bytes = new Uint8Array(capacity);
    this.points.geometry.dispose();
    const geometry = new BufferGeometry();
    this.floats = new InterleavedBuffer(new Float32Array(this.bytes.buffer), floatsOfPoint);
    this.styles = new InterleavedBuffer(this.bytes, pointBytes);
    for (const buffer of [this.floats, this.styles]) buffer.setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', new InterleavedBufferAttribute(this.floats, 3, 0));
    geometry.setAttribute(
      'style',
      new InterleavedBufferAttribute(this.styles, 4, labelOffset, true),
    );
    this.points.geometry = geometry;
  }
}
