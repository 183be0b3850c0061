// SPDX-License-Identifier: Apache-2.0
// The colour image and one layer over it, with a divider and the values under the pointer.
import type { Packet } from '../api/packet';
import type { PartName } from '../api/types';
import { depthRange } from '../model/depth_colors';
import { bindDrag } from './drag';
import { byId, setText } from './dom';
import { layerLegend } from './legend';
import { Painter, clear, decoded, noMeasurement, noRobot } from './painters';
import { readoutAt, showReadout } from './readout';
import { TargetMarks } from './target_marks';

export type Layer = 'overlay' | 'labels' | 'links' | 'vdi' | 'depth';

/** Layers that can be drawn from the parts that can be had. */
export function layersOf(parts: readonly string[]): Layer[] {
  const all: Layer[] = ['overlay', 'labels', 'links', 'vdi', 'depth'];
  return all.filter(
    (layer) => parts.includes(layer) || (layer === 'overlay' && parts.includes('labels')),
  );
}

export class ImageView {
  layer: Layer = 'overlay';
  /** Pixels of the robot and of its fringe are left out of what is shown next. */
  withoutRobot = false;
  private readonly frame = byId('picture-frame');
  private readonly below = byId<HTMLCanvasElement>('picture-below');
  private readonly above = byId<HTMLCanvasElement>('picture-above');
  private readonly note = byId('picture-note');
  private readonly painter = new Painter();
  private readonly marks = new TargetMarks();
  private packet: Packet | null = null;
  private links: readonly string[] = [];
  private range: readonly [number, number] | null = null;
  private pointer: { u: number; v: number } | null = null;

  /** @param hovered the pointer came to the image, or left it */
  constructor(private readonly hovered: (inside: boolean) => void) {
    this.bindDivider();
    this.frame.addEventListener('pointermove', (event) => this.point(event));
    this.frame.addEventListener('pointerdown', (event) => this.point(event));
    this.frame.addEventListener('pointerleave', (event) => {
      if (event.pointerType === 'touch') return; // the value stays where the finger was
      this.pointer = null;
      this.hovered(false);
      this.readOut();
    });
  }

  /** Parts that the layer is drawn from. */
  wanted(available: readonly string[]): PartName[] {
    const layer: PartName =
      this.layer === 'overlay' && !available.includes('overlay') ? 'labels' : this.layer;
    const wanted: PartName[] = ['color', layer];
    if (this.withoutRobot) wanted.push('labels');
    if (this.packet && !this.packet.color) wanted.push('depth'); // is shown in its place
    return wanted.filter((part) => available.includes(part));
  }

  /** Both are decoded before either is drawn: no layer is ever over another frame's picture. */
  async show(packet: Packet, links: readonly string[], chosen: string | null): Promise<void> {
    const overlay = this.layer === 'overlay' ? packet.overlay : undefined;
    let bitmaps: readonly (ImageBitmap | null)[];
    try {
      bitmaps = await Promise.all([decoded(packet.color), decoded(overlay)]);
    } catch (error) {
      this.packet = null;
      for (const canvas of [this.below, this.above]) clear(canvas);
      throw error;
    }
    this.packet = packet;
    this.links = links;
    const [color, layer] = bitmaps;
    if (color) this.painter.bitmap(this.below, color);
    else if (packet.depth) this.painter.grey(this.below, packet.depth);
    else clear(this.below);
    if (layer) this.painter.bitmap(this.above, layer);
    else this.showLayer(packet);
    if (this.withoutRobot) this.leaveOutRobot(packet);
    layerLegend(this.layer, this.links, this.range, this.withoutRobot);
    if (!packet.color && !packet.depth) {
      const { width, height } = packet.labels ?? packet.vdi ?? this.above;
      Object.assign(this.below, { width, height });
    }
    const { width, height } = this.below;
    this.frame.style.setProperty('--ratio', `${width} / ${height}`);
    this.marks.show(this.layer === 'overlay' ? packet : null, chosen, { width, height });
    setText(this.note, this.noteOf(packet));
    this.readOut();
  }

  showChosen(name: string | null): void {
    this.marks.setChosen(name);
  }

  /** Between colour image (left) and layer (right). */
  private bindDivider(): void {
    const handle = byId('picture-handle');
    let at = 0;
    const move = (percent: number): void => {
      at = percent;
      this.frame.style.setProperty('--split', percent.toFixed(2));
      handle.setAttribute('aria-valuenow', percent.toFixed(0));
      handle.setAttribute('aria-valuetext', `${percent.toFixed(0)} % colour image`);
    };
    bindDrag(handle, {
      axis: 'x',
      box: () => this.frame.getBoundingClientRect(),
      at: () => at,
      move,
    });
    move(0);
  }

  private showLayer(packet: Packet): void {
    const { above, painter } = this;
    if (this.layer === 'overlay' && packet.labels) return painter.overlay(above, packet.labels);
    if (this.layer === 'labels' && packet.labels) return painter.labels(above, packet.labels);
    if (this.layer === 'links' && packet.links)
      return painter.links(above, packet.links, this.links.length);
    const depth = this.layer === 'vdi' ? packet.vdi : this.layer === 'depth' ? packet.depth : null;
    if (!depth) return clear(above);
    this.widen(depthRange(depth.values));
    const nothing = this.layer === 'vdi' ? noRobot : noMeasurement;
    painter.depth(above, depth, this.range ?? [0, 1], nothing);
  }

  /** Labels, links and virtual depth are not of the sensor: they show what is left out. */
  private leaveOutRobot({ labels }: Packet): void {
    const isMeasured = this.layer === 'overlay' || this.layer === 'depth';
    for (const canvas of isMeasured ? [this.below, this.above] : [this.below])
      if (labels) this.painter.withoutRobot(canvas, labels);
      else clear(canvas);
  }

  /** One scale for all frames and both depths, so that colours can be compared. */
  private widen(range: readonly [number, number] | null): void {
    if (!range) return;
    const [near, far] = this.range ?? range;
    this.range = [Math.min(near, range[0]), Math.max(far, range[1])];
  }

  private noteOf(packet: Packet): string {
    if (this.withoutRobot && !packet.labels)
      return 'this frame has no labels to leave the robot out by';
    if (!packet.color)
      return `no colour image of this frame${packet.depth ? ': its depth in grey' : ''}`;
    const drawn = packet.has.has(this.layer) || (this.layer === 'overlay' && packet.labels);
    return drawn ? '' : 'this layer is not there for this frame';
  }

  private point(event: PointerEvent): void {
    const box = this.frame.getBoundingClientRect();
    const u = Math.floor(((event.clientX - box.left) / box.width) * this.below.width);
    const v = Math.floor(((event.clientY - box.top) / box.height) * this.below.height);
    if (u < 0 || v < 0 || u >= this.below.width || v >= this.below.height) return;
    if (!this.pointer) this.hovered(true);
    this.pointer = { u, v };
    this.readOut();
  }

  private readOut(): void {
    const { packet, pointer } = this;
    if (!packet || !pointer) return showReadout(null);
    showReadout(readoutAt(packet, this.links, pointer.u, pointer.v, this.below.width));
  }
}
