// SPDX-License-Identifier: Apache-2.0
// A recording or its results: any frame at any time.
import { ApiError, fetchPacket, fetchReport, fetchSession } from './api/client';
import type { FrameReport, Report, Session } from './api/types';
import { FrameCache } from './model/frame_cache';
import { Player } from './model/player';
import { onsets } from './model/timeline';
import { bindCommands } from './view/commands';
import { cover, coverReplaced, showMode, showNotes, showPlaying, uncover } from './view/page';
import { Viewer } from './viewer';

const cacheBytes = 192 * 2 ** 20;
const restMilliseconds = 180; // standing still this long, a frame's values are fetched too
const addressMilliseconds = 300;
const pollMilliseconds = 1500;
const answerMilliseconds = 10_000; // frames of an hour are some megabytes
const mostUnanswered = 2; // questions, until that is told

export class StoredView {
  private current = 0;
  private shown = 0;
  private wish = 0;
  private resting = 0;
  private keeping = 0;
  private complete = false;
  private unanswered = 0; // questions, one after another
  private frames: readonly FrameReport[] = [];
  private readonly viewer: Viewer;
  private readonly player: Player;
  private readonly cache: FrameCache;

  constructor(session: Session, report: Report) {
    this.viewer = new Viewer(session, {
      seek: (frame) => void this.seek(frame),
      wantsChanged: () => this.wantsChanged(),
      chosen: () => {
        if (this.viewer.packet) this.keepPlace();
      },
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
    bindCommands(this.viewer, {
      toggle: () => this.player.toggle(),
      seek: (frame) => void this.seek(frame),
      current: () => this.current,
      speed: (speed) => (this.player.speed = speed),
    });
    this.take(session, report);
    if (!report.summary) void this.follow();
  }

  async start(): Promise<void> {
    const place = new URLSearchParams(location.hash.slice(1));
    const [frame, target] = [Number(place.get('frame')), place.get('target')];
    const { tracks } = this.viewer.timeline;
    const occluded = tracks.find((track) => onsets([track]).length > 0);
    const known = tracks.find((track) => track.name === target) ?? occluded ?? tracks[0];
    if (known) this.viewer.choose(known.name);
    await this.go(
      Math.max(
        0,
        this.frames.findIndex(({ index }) => index >= frame),
      ),
    );
  }

  /** Frame (its number of the report) and target in the address: a link leads to the same place. */
  private keepPlace(): void {
    window.clearTimeout(this.keeping);
    this.keeping = window.setTimeout(() => {
      const state = new URLSearchParams({ frame: `${this.frames[this.current]?.index ?? 0}` });
      if (this.viewer.chosen) state.set('target', this.viewer.chosen);
      history.replaceState(null, '', `#${state.toString()}`);
    }, addressMilliseconds);
  }

  private async seek(frame: number): Promise<void> {
    this.player.pause();
    await this.go(frame);
  }

  private async go(frame: number): Promise<void> {
    const last = this.viewer.timeline.times.length - 1;
    if (last < 0)
      return cover(this.complete ? 'There are no frames.' : 'Judging the first frame …', [], false);
    this.current = Math.max(0, Math.min(frame, last));
    const wish = ++this.wish;
    window.clearTimeout(this.resting);
    try {
      await this.fetchAndShow(wish, false);
      if (wish !== this.wish) return;
      uncover();
    } catch (error) {
      if (error instanceof DOMException && error.name === 'AbortError') return;
      const wanted = this.current;
      this.player.pause();
      this.fail(error, wanted);
      return;
    }
    this.keepPlace();
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
    if (packet.server !== this.viewer.session.server) return this.replaced();
    const before = this.shown;
    this.shown = index; // pausing keeps what is being drawn
    try {
      await this.viewer.show(packet, index);
    } catch (error) {
      if (this.shown === index) this.shown = before;
      throw error;
    }
  }

  /** Another program answers on this port: nothing of it belongs to what is shown. */
  private replaced(): void {
    this.player.pause();
    ++this.wish;
    coverReplaced();
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
    if (error instanceof ApiError && error.status > 0) void this.look();
    const back = ['Back to the frame before', () => void this.go(this.shown)] as const;
    cover(error, [['Try again', () => void this.go(frame)], ...(this.viewer.packet ? [back] : [])]);
  }

  /** What was not had may be so as another input is served. */
  private async look(): Promise<void> {
    const session = await fetchSession().catch(() => null);
    if (session && session.server !== this.viewer.session.server) this.replaced();
  }

  private playingChanged(): void {
    showPlaying(this.player.playing);
    if (this.player.playing) return;
    this.current = this.shown; // what is on its way is not waited for
    this.rest(++this.wish);
  }

  /** @param report with the frames that are new */
  private take(session: Session, report: Report): void {
    this.complete = report.summary !== null;
    this.viewer.setSession(session);
    if (report.frames.length > 0) {
      this.frames = this.frames.concat(report.frames);
      this.viewer.timeline.setFrames(this.frames);
    }
    const judged = this.frames.length;
    const isPart = (session.expected ?? judged) > judged;
    const of = isPart ? ` of ${session.expected}` : '';
    const text = `${judged}${of} frames${this.complete ? '' : ', judging'}`;
    showMode(text, this.complete ? text : 'judging', this.complete && isPart);
    const notes = report.summary?.notes ?? [];
    showNotes([...session.missing, ...notes], session.missing.length ? 'Not there' : 'Notes');
  }

  /** A run that is still going on: more frames come. */
  private async follow(): Promise<void> {
    for (;;) {
      await new Promise((resolve) => window.setTimeout(resolve, pollMilliseconds));
      // The session after the report: what it says was missing is of all of its frames.
      const signal = AbortSignal.timeout(answerMilliseconds);
      const report = await fetchReport(this.frames.length, signal).catch(() => null);
      const session = report && (await fetchSession(signal).catch(() => null));
      this.unanswered = session ? 0 : this.unanswered + 1;
      if (this.unanswered === mostUnanswered) this.showUnanswered();
      if (!session || !report) continue;
      if (session.server !== this.viewer.session.server) return this.replaced();
      const first = this.viewer.timeline.times.length === 0;
      this.take(session, report);
      if (first) await this.start();
      if (this.complete) return;
    }
  }

  private showUnanswered(): void {
    const judged = this.frames.length;
    const said = 'the server does not answer';
    showMode(`${said} · ${judged} frames so far`, said, true);
    if (judged === 0) cover(`${said}: is penumbra view still running?`, []);
  }
}
