// SPDX-License-Identifier: Apache-2.0
import { Color, Vector3, type Camera, type Scene } from 'three';
import type { TargetReport, Verdict } from '../api/types';
import { okabeIto, verdictOf } from '../model/labels';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';
import { TargetMark } from './targets';

const colors: Readonly<Record<Verdict, Color>> = {
  visible: new Color(okabeIto.green),
  partial: new Color(okabeIto.orange),
  hidden: new Color(okabeIto.vermillion),
  unknown: new Color(okabeIto.yellow),
  out_of_view: new Color('#8b949e'),
};

interface Entry {
  readonly mark: TargetMark;
  readonly name: HTMLElement;
  verdict: Verdict | null;
}

interface Placed {
  readonly name: HTMLElement;
  readonly x: number;
  y: number;
}

const nameHeight = 23; // pixels

/** No name covers another: the lower one gives way. */
function moveBelow(one: Placed, others: readonly Placed[]): void {
  for (const other of others) {
    const left = one.x <= other.x ? one : other;
    const apart = Math.abs(one.x - other.x) > left.name.offsetWidth;
    if (!apart && Math.abs(one.y - other.y) < nameHeight) one.y = other.y + nameHeight;
  }
}

/** Marks of all targets, made once for each name, and their names as text over the scene. */
export class TargetLayer {
  private readonly entries = new Map<string, Entry>();
  private ink = new Color('#ffffff');

  constructor(
    private readonly scene: Scene,
    private readonly names: HTMLElement,
  ) {}

  setInk(ink: Color): void {
    this.ink = ink;
  }

  show(targets: readonly TargetReport[], chosen: string | null): void {
    const shown = new Set(targets.map((target) => target.name));
    for (const [name, entry] of this.entries) if (!shown.has(name)) this.remove(name, entry);
    for (const target of targets) {
      const entry = this.entryOf(target.name);
      const verdict = verdictOf(target.verdict);
      entry.mark.update(target, colors[verdict], this.ink, target.name === chosen);
      entry.name.classList.toggle('chosen', target.name === chosen);
      if (entry.verdict !== verdict) {
        entry.verdict = verdict;
        entry.name.replaceChildren(verdictIcon(verdict), target.name);
      }
    }
  }

  placeNames(eye: Camera, canvas: HTMLCanvasElement): void {
    const at = new Vector3();
    const shown: Placed[] = [];
    for (const { mark, name } of this.entries.values()) {
      if (mark.anchor) at.copy(mark.anchor).project(eye);
      name.hidden = !mark.anchor || at.z >= 1 || Math.abs(at.x) >= 1 || Math.abs(at.y) >= 1;
      if (name.hidden) continue;
      const x = ((at.x + 1) / 2) * canvas.clientWidth;
      shown.push({ name, x, y: ((1 - at.y) / 2) * canvas.clientHeight });
    }
    shown.sort((a, b) => a.y - b.y);
    shown.forEach((one, index) => moveBelow(one, shown.slice(0, index)));
    for (const { name, x, y } of shown)
      name.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  private entryOf(name: string): Entry {
    const known = this.entries.get(name);
    if (known) return known;
    const entry = { mark: new TargetMark(), name: element('span', 'scene-name'), verdict: null };
    this.scene.add(entry.mark.root);
    this.names.append(entry.name);
    this.entries.set(name, entry);
    return entry;
  }

  private remove(name: string, entry: Entry): void {
    this.scene.remove(entry.mark.root);
    entry.mark.dispose();
    entry.name.remove();
    this.entries.delete(name);
  }
}
