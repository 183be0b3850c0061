// SPDX-License-Identifier: Apache-2.0
// One layer of the image view as RGBA pixels, from a packet's part.
import type { EncodedImage, Grid } from '../api/packet';
import { depthColors } from '../model/depth_colors';
import { labelColor, linkColor, rgbOf, type Rgb } from '../model/labels';
import { isRobot, isSurroundings } from '../model/surroundings';
import { element } from './dom';

const opaque = ([r, g, b]: Rgb, alpha = 255): number =>
  ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;

const white = opaque([255, 255, 255]);
const black = opaque([0, 0, 0]);
const tableOf = (alpha: number): Uint32Array =>
  Uint32Array.from({ length: 256 }, (_, value) => {
    const color = labelColor(value);
    return color ? opaque(rgbOf(color), alpha) : 0;
  });
export const labelTable = tableOf(255);
export const overlayTable = tableOf(150);
const leftOutTable = Uint32Array.from({ length: 256 }, (_, value) =>
  isSurroundings(value) ? 0 : white,
);
export const noRobot: readonly [number, number] = [0, 0];
export const noMeasurement: readonly [number, number] = [
  opaque([38, 38, 38]),
  opaque([92, 92, 92]),
];
const whiteDepth = 0.25; // metres that are drawn white; grey falls with the square root
const depthTable = Uint32Array.from(depthColors, (color) => opaque(color));

/** Draws on canvases whose pixels are the image's; its buffer is made once for each size. */
export class Painter {
  private image: ImageData | null = null;
  private linkTable = new Uint32Array(0);
  private readonly mask = element('canvas', '');

  /** The bitmap is used up. */
  bitmap(canvas: HTMLCanvasElement, bitmap: ImageBitmap): void {
    resize(canvas, bitmap.width, bitmap.height);
    canvas.getContext('2d')?.drawImage(bitmap, 0, 0);
    bitmap.close();
  }

  labels(canvas: HTMLCanvasElement, labels: Grid<Uint8Array>): void {
    this.indexed(canvas, labels, labelTable);
  }

  /** Half transparent, for the colour image below; the robot's outline is white within, black without. */
  overlay(canvas: HTMLCanvasElement, labels: Grid<Uint8Array>): void {
    const { width, height, values } = labels;
    const { pixels, image } = this.pixelsOf(canvas, labels);
    const robot = (at: number): boolean => isRobot(values[at] as number);
    for (let at = 0; at < pixels.length; ++at) {
      const u = at % width;
      const here = robot(at);
      const isEdge =
        (u > 0 && robot(at - 1) !== here) ||
        (u + 1 < width && robot(at + 1) !== here) ||
        (at >= width && robot(at - width) !== here) ||
        (at + width < width * height && robot(at + width) !== here);
      const color = overlayTable[values[at] as number] as number;
      pixels[at] = !isEdge ? color : here ? white : black;
    }
    canvas.getContext('2d')?.putImageData(image, 0, 0);
  }

  /** Depth in the place of a colour image. */
  grey(canvas: HTMLCanvasElement, depth: Grid<Float32Array>): void {
    const { pixels, image } = this.pixelsOf(canvas, depth);
    for (let at = 0; at < pixels.length; ++at) {
      const z = depth.values[at] as number;
      const grey = z > 0 ? Math.min(255, Math.round(255 * Math.sqrt(whiteDepth / z))) : 0;
      pixels[at] = opaque([grey, grey, grey]);
    }
    canvas.getContext('2d')?.putImageData(image, 0, 0);
  }

  /** Makes the canvas transparent where the labels do not show the surroundings. */
  withoutRobot(canvas: HTMLCanvasElement, labels: Grid<Uint8Array>): void {
    this.indexed(this.mask, labels, leftOutTable);
    const context = canvas.getContext('2d');
    if (!context) return;
    context.save();
    context.imageSmoothingEnabled = false;
    context.globalCompositeOperation = 'destination-out';
    context.drawImage(this.mask, 0, 0, canvas.width, canvas.height);
    context.restore();
  }

  links(canvas: HTMLCanvasElement, links: Grid<Uint16Array>, names: number): void {
    if (this.linkTable.length !== names + 1)
      this.linkTable = Uint32Array.from({ length: names + 1 }, (_, value) =>
        value === 0 ? 0 : opaque(linkColor(value - 1)),
      );
    this.indexed(canvas, links, this.linkTable);
  }

  /**
   * @param range nearest and farthest colour, metres
   * @param nothing colours, in stripes, of pixels that have no depth
   */
  depth(
    canvas: HTMLCanvasElement,
    depth: Grid<Float32Array>,
    [near, far]: readonly [number, number],
    nothing: readonly [number, number],
  ): void {
    const scale = 255 / Math.max(far - near, 1e-6);
    const { pixels, image } = this.pixelsOf(canvas, depth);
    for (let at = 0; at < pixels.length; ++at) {
      const z = depth.values[at] as number;
      if (z > 0 && z < Infinity) {
        const step = Math.round((z - near) * scale);
        pixels[at] = depthTable[Math.max(0, Math.min(255, step))] as number;
      } else {
        const diagonal = (at % depth.width) + Math.floor(at / depth.width);
        pixels[at] = nothing[(diagonal >> 2) & 1] as number;
      }
    }
    canvas.getContext('2d')?.putImageData(image, 0, 0);
  }

  private indexed(
    canvas: HTMLCanvasElement,
    grid: Grid<Uint8Array | Uint16Array>,
    table: Uint32Array,
  ): void {
    const { pixels, image } = this.pixelsOf(canvas, grid);
    for (let at = 0; at < pixels.length; ++at)
      pixels[at] = table[grid.values[at] as number] ?? white; // a value of a later Penumbra
    canvas.getContext('2d')?.putImageData(image, 0, 0);
  }

  private pixelsOf(
    canvas: HTMLCanvasElement,
    { width, height }: Grid<unknown>,
  ): { pixels: Uint32Array; image: ImageData } {
    resize(canvas, width, height);
    if (this.image?.width !== width || this.image.height !== height)
      this.image = new ImageData(width, height);
    return { pixels: new Uint32Array(this.image.data.buffer), image: this.image };
  }
}

/** null: there is none. */
export const decoded = async (picture: EncodedImage | undefined): Promise<ImageBitmap | null> =>
  picture ? createImageBitmap(new Blob([picture.bytes], { type: picture.type })) : null;

export function clear(canvas: HTMLCanvasElement): void {
  canvas.getContext('2d')?.clearRect(0, 0, canvas.width, canvas.height);
}

function resize(canvas: HTMLCanvasElement, width: number, height: number): void {
  if (canvas.width === width && canvas.height === height) clear(canvas);
  else Object.assign(canvas, { width, height });
}
