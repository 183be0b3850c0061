// SPDX-License-Identifier: Apache-2.0
// Outlines and names of a frame's targets over the image, in the colours of their verdicts.
import type { Mark, Packet } from '../api/packet';
import { verdictOf } from '../model/labels';
import { byId, svg } from './dom';
import { placeNames, targetName } from './names';

const arm = 6; // image pixels: of the cross at a handled target

interface Shown {
  readonly target: string;
  readonly name: HTMLElement;
  /** Upper left corner of the outline, image pixels. */
  readonly u: number;
  readonly v: number;
}

export class TargetMarks {
  private readonly lines = byId('image-lines');
  private readonly names = byId('image-names');
  private shown: readonly Shown[] = [];
  private width = 1; // of the image

  constructor() {
    new ResizeObserver(() => this.place()).observe(this.names);
  }

  /** @param packet null: removes all marks */
  show(packet: Packet | null, selected: string | null, width: number, height: number): void {
    this.width = width;
    this.lines.setAttribute('viewBox', `-0.5 -0.5 ${width} ${height}`);
    const lines: SVGElement[] = [];
    this.shown = (packet?.frame.targets ?? []).flatMap((target, index) => {
      const mark = packet?.marks?.[index];
      const points = mark?.outline.flat() ?? [];
      if (!mark || points.length === 0) return [];
      const d = pathOf(mark);
      lines.push(
        svg('path', { d, class: 'rim' }),
        svg('path', { d, class: `outline ${verdictOf(target)}` }),
      );
      const least = (offset: number): number =>
        points.reduce(
          (min, value, at) => (at % 2 === offset ? Math.min(min, value) : min),
          Infinity,
        );
      return [{ target: target.name, name: targetName(target), u: least(0), v: least(1) }];
    });
    this.lines.replaceChildren(...lines);
    this.names.replaceChildren(...this.shown.map(({ name }) => name));
    this.setSelected(selected);
    this.place();
  }

  setSelected(selected: string | null): void {
    for (const { target, name } of this.shown)
      name.classList.toggle('selected', target === selected);
  }

  /** Moves the names above the outlines, inside the image. */
  private place(): void {
    const { clientWidth, clientHeight } = this.names;
    const scale = clientWidth / this.width;
    const placed = this.shown.map(({ name, u, v }) => ({
      name,
      x: Math.max(0, Math.min(u * scale, clientWidth - name.offsetWidth)),
      y: Math.max(0, Math.min(v * scale, clientHeight) - name.offsetHeight - 2),
    }));
    placeNames(placed);
  }
}

/** Returns an SVG path; a line of one point is a dot. */
function pathOf({ outline, place }: Mark): string {
  const lines = outline.map((line) => `M${line.join(' ')}${line.length === 2 ? 'h0' : ''}`);
  if (place) {
    const [u, v] = place;
    lines.push(`M${u - arm} ${v - arm}l${2 * arm} ${2 * arm}m0 ${-2 * arm}l${-2 * arm} ${2 * arm}`);
  }
  return lines.join('');
}
