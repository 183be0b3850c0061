// SPDX-License-Identifier: Apache-2.0
// A recording or its results: any frame at any time.
import { fetchPacket, fetchReport, fetchSession } from './api/client';
import type { Report, Session } from './api/types';
import { FrameCache } from './model/frame_cache';
import { onsets } from './model/occlusions';
import { Player } from './model/player';
import { bindControls } from './view/controls';
import { cover, coverWaiting, uncover } from './view/cover';
import { byId, setText } from './view/dom';
import { fragmentState, setFragment } from './view/fragment';
import { showMissing } from './view/missing';
import { Viewer } from './viewer';

const cacheBytes = 192 * 2 ** 20;
const restMilliseconds = 180; // standing still this long, a frame's values are fetched too
const pollMilliseconds = 1500;

export class StoredView {
  private current = 0;
  private shown = 0;
  private wish = 0;
  private resting = 0;
  private complete = false;
  private readonly viewer: Viewer;
  private readonly player: Player;
  private readonly cache: FrameCache;

  constructor(session: Session, report: Report) {
    this.viewer = new Viewer(session, {
      seek: (frame) => void this.seek(frame),
      wantsChanged: () => this.wantsChanged(),
    });
    this.cache = new FrameCache(
      (index, wanted, signal) => fetchPacket(index, wanted, this.viewer.step, signal),
      cacheBytes,
    );
    this.player = new Player(
      () => this.viewer.timeline.times,
      () => this.current,
      (frame) => this.go(frame),
      () => this.playingChanged(),
    );
    bindControls(this.viewer, {
      toggle: () => this.player.toggle(),
      seek: (frame) => void this.seek(frame),
      current: () => this.current,
      speed: (speed) => (this.player.speed = speed),
    });
    this.take(session, report);
    if (!report.summary) void this.follow();
  }

  async start(): Promise<void> {
    const { frame, target } = fragmentState();
    const { tracks } = this.viewer.timeline;
    const occluded = tracks.find((track) => onsets([track]).length > 0);
    const known = tracks.find((track) => track.name === target) ?? occluded ?? tracks[0];
    if (known) this.viewer.choose(known.name);
    await this.go(frame);
  }

  private async seek(frame: number): Promise<void> {
    this.player.pause();
    await this.go(frame);
  }

  private async go(frame: number): Promise<void> {
    const last = this.viewer.timeline.times.length - 1;
    if (last < 0)
      return coverWaiting(this.complete ? 'There are no frames.' : 'Judging the first frame …');
    this.current = Math.max(0, Math.min(frame, last));
    const wish = ++this.wish;
    window.clearTimeout(this.resting);
    try {
      await this.fetchAndShow(wish, false);
      uncover();
    } catch (error) {
      if (error instanceof DOMException && error.name === 'AbortError') return;
      const wanted = this.current;
      this.player.pause();
      this.fail(error, wanted);
      return;
    }
    if (wish !== this.wish) return;
    setFragment(this.current, this.viewer.chosen);
    if (this.player.playing) this.ahead();
    else this.rest(wish);
  }

  /** Another layer: a frame that stands still has all of them at once. */
  private wantsChanged(): void {
    if (this.player.playing || !this.viewer.packet) return;
    window.clearTimeout(this.resting);
    this.fill(++this.wish);
  }

  private async fetchAndShow(wish: number, withValues: boolean): Promise<void> {
    const index = this.current;
    this.cache.abortAllBut(index);
    const packet = await this.cache.get(index, this.viewer.wanted(withValues));
    if (wish !== this.wish) return;
    this.shown = index;
    await this.viewer.show(packet, index);
  }

  private ahead(): void {
    const next = this.current + 1;
    if (next < this.viewer.timeline.times.length)
      this.cache.get(next, this.viewer.wanted(false)).catch(() => undefined); // said when it is shown
  }

  private rest(wish: number): void {
    this.resting = window.setTimeout(() => this.fill(wish), restMilliseconds);
  }

  private fill(wish: number): void {
    this.fetchAndShow(wish, true).catch((error: unknown) => {
      if (error instanceof DOMException && error.name === 'AbortError') return;
      this.fail(error, this.current);
    });
  }

  private fail(error: unknown, frame: number): void {
    const back = (): void => void this.go(this.shown);
    cover(error, () => void this.go(frame), this.viewer.packet ? back : undefined);
  }

  private playingChanged(): void {
    document.documentElement.classList.toggle('playing', this.player.playing);
    if (this.player.playing) return;
    this.current = this.shown; // what is on its way is not waited for
    this.rest(++this.wish);
  }

  private take(session: Session, report: Report): void {
    this.complete = report.summary !== null;
    this.viewer.setSession(session);
    this.viewer.timeline.setFrames(report.frames);
    const judged = report.frames.length;
    const of = session.expected ? ` of ${session.expected}` : '';
    setText(byId('mode'), this.complete ? `${judged} frames` : `${judged}${of} frames, judging`);
    showMissing(session.missing, 'Not there');
  }

  /** A run that is still going on: more frames come. */
  private async follow(): Promise<void> {
    for (;;) {
      await new Promise((resolve) => window.setTimeout(resolve, pollMilliseconds));
      const [session, report] = await Promise.all([fetchSession(), fetchReport()]).catch(() => []);
      if (!session || !report) continue; // said when a frame is asked for
      const first = this.viewer.timeline.times.length === 0;
      this.take(session, report);
      if (first) await this.start();
      if (this.complete) return;
    }
  }
}
