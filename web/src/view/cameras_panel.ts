// SPDX-License-Identifier: Apache-2.0
// All cameras side by side at the instant that is shown, and what they say together of the selected
// target.
import { fusedAt, nearest, ownCamera, rootOf, type FusedFrame } from '../api/cameras';
import { fetchPacket, fetchReport, fetchSession, fetchViews } from '../api/client';
import type { Packet } from '../api/packet';
import type { CameraInfo, FrameReport, PartName, Pose, Session } from '../api/types';
import { verdictNames, verdictOf } from '../model/labels';
import { byId, element } from './dom';
import { decode, Painter } from './painters';
import { verdictIcon } from './verdict_icon';

const shownParts: readonly PartName[] = ['color', 'depth', 'labels', 'overlay'];
const pollMilliseconds = 1500;

/** Receives a camera's place at the instant that is shown; null: it is not known. */
export type Placed = (camera: string, info: CameraInfo | null, pose: Pose | null) => void;

/** One camera's picture; a link to its page. */
class CameraTile {
  readonly link: HTMLAnchorElement;
  private readonly below = element('canvas');
  private readonly above = element('canvas', 'camera-over');
  private readonly caption = element('span');
  private readonly painter = new Painter();
  private session: Session | null = null;
  private frames: FrameReport[] = [];
  private isComplete = false;
  private shown = '';

  constructor(
    readonly name: string,
    isOwn: boolean,
    private readonly placed: Placed,
  ) {
    this.link = element('a', 'camera', this.below, this.above, this.caption);
    this.link.dataset['camera'] = name;
    if (isOwn) this.link.setAttribute('aria-current', 'true');
  }

  /** Fetches the frames that were judged since the last call. */
  async update(): Promise<void> {
    if (this.isComplete) return;
    const root = rootOf(this.name);
    this.session ??= await fetchSession(undefined, root);
    const report = await fetchReport(this.frames.length, undefined, root);
    this.frames = this.frames.concat(report.frames);
    this.isComplete = report.summary !== null;
  }

  async show(stamp: bigint, selected: string | null): Promise<void> {
    const stamps = this.frames.map(({ stamp_ns: own }) => (own === null ? null : BigInt(own)));
    const at = nearest(stamps, stamp);
    const frame = at === null ? undefined : this.frames[at];
    if (at === null || !frame || !this.session) return this.setCaption(null, selected);
    this.setCaption(frame, selected);
    const place = new URLSearchParams({ frame: `${frame.index}` });
    if (selected) place.set('target', selected);
    this.link.href = `${rootOf(this.name)}/#${place.toString()}`;
    if (this.shown === String(at)) return;
    const parts = this.session.parts.filter((part) => shownParts.includes(part));
    const wanted = parts.includes('overlay') ? (['overlay'] as const) : parts;
    const packet = await fetchPacket(at, wanted, 1, undefined, rootOf(this.name));
    this.shown = String(at);
    await this.paint(packet);
    this.placed(this.name, this.session.camera, packet.camera_pose);
  }

  private async paint(packet: Packet): Promise<void> {
    const image = await decode(packet.overlay ?? packet.color);
    if (image) this.painter.bitmap(this.below, image);
    else if (packet.depth) this.painter.grey(this.below, packet.depth);
    if (!packet.overlay && packet.labels) this.painter.overlay(this.above, packet.labels);
  }

  private setCaption(frame: FrameReport | null, selected: string | null): void {
    const target = frame?.targets.find(({ name }) => name === selected);
    const verdict = target && verdictOf(target);
    const what = verdict ? verdictNames[verdict] : frame ? frame.status : 'no frame';
    this.caption.replaceChildren(...(verdict ? [verdictIcon(verdict)] : []), this.name);
    this.link.title = `${this.name}: ${what}`;
  }
}

export class CamerasPanel {
  private readonly tiles: readonly CameraTile[];
  private readonly fused = element('p');
  private frames: readonly FusedFrame[] | null = null;
  private wanted: { readonly stamp: bigint; readonly selected: string | null } | null = null;
  private isBusy = false;

  constructor(cameras: readonly string[], placed: Placed) {
    const own = ownCamera(cameras);
    this.tiles = cameras.map((name) => new CameraTile(name, name === own, placed));
    byId('cameras').replaceChildren(...this.tiles.map(({ link }) => link), this.fused);
    byId('cameras').hidden = false;
    void this.poll();
  }

  show(frame: FrameReport, selected: string | null): void {
    if (frame.stamp_ns === null) return;
    this.wanted = { stamp: BigInt(frame.stamp_ns), selected };
    this.showFused();
    void this.draw();
  }

  /** Fetches frames until all cameras are judged, then the verdicts over all of them. */
  private async poll(): Promise<void> {
    for (;;) {
      await Promise.all(this.tiles.map((tile) => tile.update())).catch(() => undefined);
      const views = await fetchViews().catch(() => null);
      this.frames = views?.frames ?? null;
      this.showFused();
      void this.draw();
      if (views) return;
      await new Promise((resolve) => window.setTimeout(resolve, pollMilliseconds));
    }
  }

  /** Draws the newest instant that was wanted; those meanwhile are left out. */
  private async draw(): Promise<void> {
    if (this.isBusy) return;
    this.isBusy = true;
    for (let drawn = null; this.wanted && drawn !== this.wanted;) {
      drawn = this.wanted;
      const { stamp, selected } = drawn;
      await Promise.all(this.tiles.map((tile) => tile.show(stamp, selected))).catch(
        () => undefined,
      );
    }
    this.isBusy = false;
  }

  private showFused(): void {
    if (!this.wanted?.selected) return this.fused.replaceChildren();
    const { stamp, selected } = this.wanted;
    const target = this.frames && fusedAt(this.frames, stamp, selected);
    if (!target) {
      const text = this.frames ? 'not judged yet' : 'judging all cameras …';
      return this.fused.replaceChildren(`${selected}: ${text}`);
    }
    const verdict = verdictOf(target);
    const best = target.best ? `, best from ${target.best}` : '';
    const reason = target.reason ? `: ${target.reason}` : '';
    this.fused.replaceChildren(
      verdictIcon(verdict),
      `${selected} over all cameras: ${verdictNames[verdict]}${best}${reason}`,
    );
    this.fused.dataset['verdict'] = target.verdict;
  }
}
