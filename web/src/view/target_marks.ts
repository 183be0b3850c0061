// SPDX-License-Identifier: Apache-2.0
// Outlines and names of a frame's targets over the image, in their verdicts' colours.
import type { Mark, Packet } from '../api/packet';
import { verdictOf } from '../model/labels';
import { byId, element, svg } from './dom';
import { placeNames, type Placed } from './names';
import { verdictIcon } from './verdict_icon';

const arm = 6; // of the cross where a handled target is, image pixels

interface Shown {
  readonly target: string;
  readonly name: HTMLElement;
  /** Upper left corner of the outline, image pixels. */
  readonly u: number;
  readonly v: number;
}

export class TargetMarks {
  private readonly lines = byId('picture-lines');
  private readonly names = byId('picture-names');
  private shown: readonly Shown[] = [];
  private size = { width: 1, height: 1 };

  constructor() {
    new ResizeObserver(() => this.place()).observe(this.names);
  }

  /** @param packet null: nothing is shown */
  show(packet: Packet | null, chosen: string | null, size: TargetMarks['size']): void {
    this.size = size;
    this.lines.setAttribute('viewBox', `-0.5 -0.5 ${size.width} ${size.height}`);
    const targets = packet?.frame.targets ?? [];
    const lines: SVGElement[] = [];
    this.shown = targets.flatMap(({ name, verdict }, index) => {
      const mark = packet?.marks[index];
      const corner = mark && cornerOf(mark);
      if (!mark || !corner) return [];
      const kind = verdictOf(verdict);
      const d = pathOf(mark);
      lines.push(svg('path', { d, class: 'rim' }), svg('path', { d, class: `outline ${kind}` }));
      const text = element('span', 'target-name', verdictIcon(kind), name);
      return [{ target: name, name: text, u: corner[0], v: corner[1] }];
    });
    this.lines.replaceChildren(...lines);
    this.names.replaceChildren(...this.shown.map(({ name }) => name));
    this.setChosen(chosen);
    this.place();
  }

  setChosen(chosen: string | null): void {
    for (const { target, name } of this.shown) name.classList.toggle('chosen', target === chosen);
  }

  /** Above the outlines, inside the image. */
  private place(): void {
    const { clientWidth, clientHeight } = this.names;
    const scale = clientWidth / this.size.width;
    const placed: Placed[] = this.shown.map(({ name, u, v }) => ({
      name,
      x: Math.max(0, Math.min(u * scale, clientWidth - name.offsetWidth)),
      y: Math.max(0, Math.min(v * scale, clientHeight) - name.offsetHeight - 2),
    }));
    placeNames(placed);
  }
}

function cornerOf({ outline }: Mark): readonly [number, number] | null {
  let [u, v] = [Infinity, Infinity];
  for (const line of outline)
    line.forEach((value, index) => {
      if (index % 2 === 0) u = Math.min(u, value);
      else v = Math.min(v, value);
    });
  return u < Infinity ? [u, v] : null;
}

/** A line of one point is a dot. */
function pathOf({ outline, place }: Mark): string {
  const lines = outline.map((line) => `M${line.join(' ')}${line.length === 2 ? 'h0' : ''}`);
  if (place) {
    const [u, v] = place;
    lines.push(`M${u - arm} ${v - arm}l${2 * arm} ${2 * arm}m0 ${-2 * arm}l${-2 * arm} ${2 * arm}`);
  }
  return lines.join('');
}
