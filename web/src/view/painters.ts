// SPDX-License-Identifier: Apache-2.0
// Draws the layers of the image view from a packet's parts.
import type { EncodedImage, Grid } from '../api/packet';
import { depthColors, residualColor, type DepthRange } from '../model/depth_colors';
import { isRobot, isSurroundings, labelColor, linkColor, rgbOf, type Rgb } from '../model/labels';
import { element } from './dom';

const rgba = ([r, g, b]: Rgb, alpha = 255): number =>
  ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;

const white = rgba([255, 255, 255]);
const black = rgba([0, 0, 0]);
const labelTable = (alpha: number): Uint32Array =>
  Uint32Array.from({ length: 256 }, (_, label) => {
    const color = labelColor(label);
    return color ? rgba(rgbOf(color), alpha) : 0;
  });
const opaqueLabels = labelTable(255);
const overlayLabels = labelTable(150);

/** Of the robot's outline by the camera's pose in use, and by the pose that was found. */
export const outlineColors: readonly string[] = ['rgb(230 40 40)', 'rgb(0 220 80)'];

/** Two colours, in stripes, of pixels without depth. */
type Stripes = readonly [number, number];
export const noRobot: Stripes = [0, 0];
export const noMeasurement: Stripes = [rgba([38, 38, 38]), rgba([92, 92, 92])];
const stripe = (stripes: Stripes, at: number, width: number): number => {
  const diagonal = (at % width) + Math.floor(at / width);
  return stripes[((diagonal >> 2) & 1) as 0 | 1];
};
const whiteDepth = 0.25; // metres: depth shown as white; grey falls with the square root
const depthTable = Uint32Array.from(depthColors, (color) => rgba(color));

/** Draws on canvases of the image's size; allocates its buffer once per size. */
export class Painter {
  private image: ImageData | null = null;
  private readonly mask = element('canvas');

  /** Draws and closes a bitmap. */
  bitmap(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
    resize(canvas, bitmap.width, bitmap.height);
    canvas.getContext('2d')?.drawImage(bitmap, 0, 0);
    bitmap.close();
  }

  labels(canvas: HTMLCanvasElement, labels: Grid<Uint8Array>): void {
    this.fill(canvas, labels, (label) => opaqueLabels[label] as number);
  }

  /** Draws labels half transparent, and the robot's outline: white inside, black outside. */
  overlay(canvas: HTMLCanvasElement, labels: Grid<Uint8Array>): void {
    const { width, height, values } = labels;
    const robot = (at: number): boolean => isRobot(values[at] as number);
    this.fill(canvas, labels, (label, at) => {
      const u = at % width;
      const here = isRobot(label);
      const isEdge =
        (u > 0 && robot(at - 1) !== here) ||
        (u + 1 < width && robot(at + 1) !== here) ||
        (at >= width && robot(at - width) !== here) ||
        (at + width < width * height && robot(at + width) !== here);
      return isEdge ? (here ? white : black) : (overlayLabels[label] as number);
    });
  }

  /** Adds the robot's outline by the camera's pose in use, red, and by the found one, green. */
  outlines(canvas: HTMLCanvasElement, { width, height, values }: Grid<Uint8Array>): void {
    const context = canvas.getContext('2d');
    if (!context) return;
    for (const [pose, color] of outlineColors.entries()) {
      context.fillStyle = color;
      for (let at = 0; at < width * height; ++at)
        if (values[at] === pose + 1)
          context.fillRect((at % width) - 1, Math.floor(at / width) - 1, 3, 3);
    }
  }

  /** Draws depth as a grey image. */
  grey(canvas: HTMLCanvasElement, depth: Grid<Float32Array>): void {
    this.fill(canvas, depth, (z) => {
      const grey = z > 0 ? Math.min(255, Math.round(255 * Math.sqrt(whiteDepth / z))) : 0;
      return rgba([grey, grey, grey]);
    });
  }

  /** Makes pixels transparent that are neither clear nor front. */
  removeRobot(canvas: HTMLCanvasElement, labels: Grid<Uint8Array>): void {
    this.fill(this.mask, labels, (label) => (isSurroundings(label) ? 0 : white));
    const context = canvas.getContext('2d');
    if (!context) return;
    context.save();
    context.imageSmoothingEnabled = false;
    context.globalCompositeOperation = 'destination-out';
    context.drawImage(this.mask, 0, 0, canvas.width, canvas.height);
    context.restore();
  }

  /** @param count number of links */
  links(canvas: HTMLCanvasElement, links: Grid<Uint16Array>, count: number): void {
    const colors = Array.from({ length: count }, (_, link) => rgba(linkColor(link)));
    this.fill(canvas, links, (value) => (value === 0 ? 0 : (colors[value - 1] ?? white)));
  }

  depth(
    canvas: HTMLCanvasElement,
    depth: Grid<Float32Array>,
    [near, far]: DepthRange,
    stripes: Stripes,
  ): void {
    const scale = 255 / Math.max(far - near, 1e-6);
    this.fill(canvas, depth, (z, at) => {
      if (!(z > 0 && z < Infinity)) return stripe(stripes, at, depth.width);
      const step = Math.round((z - near) * scale);
      return depthTable[Math.max(0, Math.min(255, step))] as number;
    });
  }

  /** Draws measured minus virtual depth on the robot; stripes where nothing is measured. */
  residual(
    canvas: HTMLCanvasElement,
    virtual: Grid<Float32Array>,
    measured: Grid<Float32Array>,
  ): void {
    this.fill(canvas, virtual, (z, at) => {
      if (!(z > 0)) return 0;
      const depth = measured.values[at] as number;
      const isMeasured = depth > 0 && depth < Infinity;
      return isMeasured ? rgba(residualColor(depth - z)) : stripe(noMeasurement, at, virtual.width);
    });
  }

  /** Draws one pixel per value. */
  private fill(
    canvas: HTMLCanvasElement,
    { width, height, values }: Grid<Uint8Array | Uint16Array | Float32Array>,
    colorOf: (value: number, at: number) => number,
  ): void {
    resize(canvas, width, height);
    if (this.image?.width !== width || this.image.height !== height)
      this.image = new ImageData(width, height);
    const pixels = new Uint32Array(this.image.data.buffer);
    for (let at = 0; at < pixels.length; ++at) pixels[at] = colorOf(values[at] as number, at);
    canvas.getContext('2d')?.putImageData(this.image, 0, 0);
  }
}

export const decode = async (image: EncodedImage | undefined): Promise<ImageBitmap | null> =>
  image ? createImageBitmap(new Blob([image.bytes], { type: image.type })) : null;

export function clear(canvas: HTMLCanvasElement): void {
  canvas.getContext('2d')?.clearRect(0, 0, canvas.width, canvas.height);
}

function resize(canvas: HTMLCanvasElement, width: number, height: number): void {
  if (canvas.width === width && canvas.height === height) clear(canvas);
  else Object.assign(canvas, { width, height });
}
