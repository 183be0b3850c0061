// SPDX-License-Identifier: Apache-2.0
// The colour image and one layer over it, with a divider and the values under the pointer.
import type { Packet } from '../api/packet';
import type { Layer, PartName } from '../api/types';
import { depthRange, type DepthRange } from '../model/depth_colors';
import { bindDrag } from './drag';
import { byId, setText } from './dom';
import { showLegend } from './legend';
import { fitScene } from './panes';
import { Painter, clear, decode, noMeasurement, noRobot } from './painters';
import { Readout, type Pixel } from './readout';
import { TargetMarks } from './target_marks';

/** Returns the parts that a layer is drawn from. */
export const partsOf = (layer: Layer): readonly PartName[] =>
  layer === 'residual' ? ['vdi', 'depth'] : [layer];

export class ImageView {
  layer: Layer = 'overlay';
  /** The next frame leaves out pixels of the robot and its fringe. */
  withoutRobot = false;
  private readonly frame = byId('image-frame');
  private readonly below = byId<HTMLCanvasElement>('image-below');
  private readonly above = byId<HTMLCanvasElement>('image-above');
  private readonly painter = new Painter();
  private readonly marks = new TargetMarks();
  private readonly readout = new Readout();
  private packet: Packet | null = null;
  private links: readonly string[] = [];
  private range: DepthRange | null = null;
  private pointer: Pixel | null = null;

  /** @param hovered the pointer entered or left the image */
  constructor(private readonly hovered: (inside: boolean) => void) {
    this.bindDivider();
    for (const type of ['pointermove', 'pointerdown'] as const)
      this.frame.addEventListener(type, (event) => this.point(event));
    this.frame.addEventListener('pointerleave', (event) => {
      if (event.pointerType === 'touch') return; // keeps the values of the last touch
      this.pointer = null;
      this.hovered(false);
      this.updateReadout();
    });
  }

  /** Returns the parts that the layer needs. */
  requestedParts(available: readonly PartName[]): PartName[] {
    const hasOverlay = available.includes('overlay');
    const layer = this.layer === 'overlay' && !hasOverlay ? 'labels' : this.layer;
    const parts: PartName[] = ['color', ...partsOf(layer)];
    if (this.layer === 'overlay' && available.includes('outlines')) parts.push('outlines');
    if (this.withoutRobot) parts.push('labels');
    if (this.packet && !this.packet.color) parts.push('depth'); // replaces the colour image
    return parts;
  }

  /** Decodes both images before it draws one: image and layer are always of the same frame. */
  async show(packet: Packet, links: readonly string[], selected: string | null): Promise<void> {
    this.packet = null;
    const overlay = this.layer === 'overlay' ? packet.overlay : undefined;
    const images = await Promise.all([decode(packet.color), decode(overlay)]).catch((error) => {
      for (const canvas of [this.below, this.above]) clear(canvas);
      throw error;
    });
    this.packet = packet;
    this.links = links;
    this.paint(packet, ...images);
    showLegend(this.layer, links, this.range, this.withoutRobot, Boolean(packet.outlines));
    const { width, height } = this.below;
    this.frame.style.setProperty('--ratio', `${width} / ${height}`);
    fitScene(width / height);
    this.marks.show(this.layer === 'overlay' ? packet : null, selected, width, height);
    setText(byId('image-note'), this.noteOf(packet));
    this.updateReadout();
  }

  select(target: string | null): void {
    this.marks.setSelected(target);
  }

  /** The divider between colour image (left) and layer (right). */
  private bindDivider(): void {
    const handle = byId('image-handle');
    let at = 0;
    const move = (percent: number): void => {
      at = percent;
      this.frame.style.setProperty('--split', percent.toFixed(2));
      handle.setAttribute('aria-valuenow', percent.toFixed(0));
      handle.setAttribute('aria-valuetext', `${percent.toFixed(0)} % colour image`);
    };
    const box = (): DOMRect => this.frame.getBoundingClientRect();
    bindDrag(handle, { axis: 'x', box, at: () => at, move });
    move(0);
  }

  private paint(packet: Packet, color: ImageBitmap | null, overlay: ImageBitmap | null): void {
    if (color) this.painter.bitmap(this.below, color);
    else if (packet.depth) this.painter.grey(this.below, packet.depth);
    else {
      const { width, height } = packet.labels ?? packet.vdi ?? this.above;
      Object.assign(this.below, { width, height }); // clears it, too
    }
    if (overlay) this.painter.bitmap(this.above, overlay);
    else this.paintLayer(packet);
    if (this.withoutRobot) this.removeRobot(packet);
    if (this.layer === 'overlay' && packet.outlines)
      this.painter.outlines(this.above, packet.outlines);
  }

  private paintLayer(packet: Packet): void {
    const { above, painter, layer } = this;
    if (layer === 'overlay' && packet.labels) return painter.overlay(above, packet.labels);
    if (layer === 'labels' && packet.labels) return painter.labels(above, packet.labels);
    if (layer === 'links' && packet.links)
      return painter.links(above, packet.links, this.links.length);
    if (layer === 'residual' && packet.vdi && packet.depth)
      return painter.residual(above, packet.vdi, packet.depth);
    const depth = layer === 'vdi' ? packet.vdi : layer === 'depth' ? packet.depth : null;
    if (!depth) return clear(above);
    this.widen(depthRange(depth.values));
    painter.depth(above, depth, this.range ?? [0, 1], layer === 'vdi' ? noRobot : noMeasurement);
  }

  /** Labels, links and virtual depth keep the robot: they are not measured. */
  private removeRobot({ labels }: Packet): void {
    const isMeasured = this.layer === 'overlay' || this.layer === 'depth';
    for (const canvas of isMeasured ? [this.below, this.above] : [this.below])
      if (labels) this.painter.removeRobot(canvas, labels);
      else clear(canvas);
  }

  /** All frames and both depths share one scale, so that their colours can be compared. */
  private widen(range: DepthRange | null): void {
    if (!range) return;
    const [near, far] = this.range ?? range;
    this.range = [Math.min(near, range[0]), Math.max(far, range[1])];
  }

  private noteOf(packet: Packet): string {
    if (this.withoutRobot && !packet.labels)
      return 'no labels for this frame: cannot remove the robot';
    if (!packet.color)
      return `no colour image for this frame${packet.depth ? ': showing depth in grey' : ''}`;
    const isDrawn =
      partsOf(this.layer).every((part) => packet[part]) ||
      (this.layer === 'overlay' && packet.labels);
    return isDrawn ? '' : 'this layer is not available for this frame';
  }

  private point(event: PointerEvent): void {
    const { width, height } = this.below;
    const box = this.frame.getBoundingClientRect();
    const u = Math.floor(((event.clientX - box.left) / box.width) * width);
    const v = Math.floor(((event.clientY - box.top) / box.height) * height);
    if (u < 0 || v < 0 || u >= width || v >= height) return;
    if (!this.pointer) this.hovered(true);
    this.pointer = { u, v, at: v * width + u };
    this.updateReadout();
  }

  private updateReadout(): void {
    this.readout.show(this.packet, this.links, this.pointer);
  }
}
