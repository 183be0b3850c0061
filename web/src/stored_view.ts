// SPDX-License-Identifier: Apache-2.0
// Shows a recording or the folder of a run: any frame, or all in turn.
import { ApiError, fetchPacket, fetchReport, fetchSession } from './api/client';
import type { Report, Session } from './api/types';
import { FrameCache } from './model/frame_cache';
import { notesOf } from './model/notes';
import { Throttle } from './model/throttle';
import { onsets, waitOf } from './model/timeline';
import { bindCommands } from './view/commands';
import {
  cover,
  coverReplaced,
  showDiagnosis,
  showNotes,
  showPlaying,
  showState,
  uncover,
} from './view/page';
import { Viewer, type FrameSource } from './viewer';

const cacheBytes = 192 * 2 ** 20;
const restMilliseconds = 180; // a frame that is shown this long gets all of its values
const addressMilliseconds = 300;
const pollMilliseconds = 1500;
const answerMilliseconds = 10_000; // a report of one hour has some megabytes

const sleep = (milliseconds: number): Promise<void> =>
  new Promise((resolve) => window.setTimeout(resolve, milliseconds));

export class StoredView implements FrameSource {
  current = 0;
  private newest = 0; // number of the newest call of show(): it replaces earlier ones
  private playback = 0; // number of the newest playback
  private isPlaying = false;
  private speed = 1;
  private isComplete = false;
  private readonly viewer: Viewer;
  private readonly cache: FrameCache;
  private readonly address = new Throttle(addressMilliseconds, () => this.updateAddress());

  constructor(session: Session, report: Report) {
    this.viewer = new Viewer(session, this);
    this.cache = new FrameCache(
      (index, parts, signal) => fetchPacket(index, parts, this.viewer.step, signal),
      cacheBytes,
    );
    bindCommands(this.viewer, this);
    this.receive(session, report);
    if (!report.summary) void this.poll();
  }

  /** Shows the frame and target of the page's address, or the first target that gets occluded. */
  async start(): Promise<void> {
    const place = new URLSearchParams(location.hash.slice(1));
    const [frame, target] = [Number(place.get('frame')), place.get('target')];
    const { tracks, frames } = this.viewer.timeline;
    const occluded = tracks.find((track) => onsets([track]).length > 0);
    const track = tracks.find(({ name }) => name === target) ?? occluded ?? tracks[0];
    if (track) this.viewer.select(track.name);
    await this.show(frames.findIndex(({ index }) => index >= frame));
  }

  seek(frame: number): void {
    this.stop();
    void this.show(frame);
  }

  togglePlaying(): void {
    if (this.isPlaying) this.seek(this.current);
    else void this.play();
  }

  setSpeed(factor: number): void {
    this.speed = factor;
  }

  partsChanged(): void {
    if (!this.isPlaying && this.viewer.packet) void this.show(this.current, 0);
  }

  targetChanged(): void {
    if (this.viewer.packet) this.address.request();
  }

  private get last(): number {
    return this.viewer.timeline.frames.length - 1;
  }

  private async play(): Promise<void> {
    const playback = ++this.playback;
    this.isPlaying = true;
    showPlaying(true);
    if (this.current >= this.last) await this.show(0);
    while (playback === this.playback && this.current < this.last) {
      await sleep(1000 * waitOf(this.viewer.timeline.times, this.current, this.speed));
      if (playback === this.playback) await this.show(this.current + 1);
    }
    if (playback === this.playback) this.seek(this.current);
  }

  private stop(): void {
    ++this.playback;
    this.isPlaying = false;
    showPlaying(false);
  }

  /**
   * Shows a frame, first with the parts that its layer needs, later with all values.
   * @param frame any number: the nearest frame is shown
   * @param rest milliseconds until all values are fetched; 0: at once
   */
  private async show(frame: number, rest = restMilliseconds): Promise<void> {
    if (this.last < 0)
      return cover(this.isComplete ? 'No frames.' : 'Judging the first frame …', [], false);
    this.current = Math.max(0, Math.min(frame, this.last));
    const number = ++this.newest;
    try {
      if (rest > 0) await this.fetchAndShow(number, false);
      if (this.isPlaying) return this.prefetch();
      await sleep(rest);
      if (number === this.newest) await this.fetchAndShow(number, true);
    } catch (error) {
      if (number !== this.newest || (error instanceof DOMException && error.name === 'AbortError'))
        return;
      this.stop();
      this.fail(error, this.current);
    }
  }

  private async fetchAndShow(number: number, withValues: boolean): Promise<void> {
    const index = this.current;
    this.cache.abortExcept(index);
    const packet = await this.cache.get(index, this.viewer.requestedParts(withValues));
    if (number !== this.newest) return;
    if (packet.server !== this.viewer.session.server) return this.replaced();
    await this.viewer.show(packet, index);
    if (number !== this.newest) return;
    uncover();
    this.address.request();
  }

  private prefetch(): void {
    const parts = this.viewer.requestedParts(false);
    if (this.current < this.last) this.cache.get(this.current + 1, parts).catch(() => undefined); // show() reports the error
  }

  private fail(error: unknown, frame: number): void {
    if (error instanceof ApiError && error.status > 0) void this.checkServer();
    const back = ['Back to the previous frame', () => this.seek(this.viewer.position)] as const;
    cover(error, [['Try again', () => this.seek(frame)], ...(this.viewer.packet ? [back] : [])]);
  }

  /** An error can mean that another program now uses the port. */
  private async checkServer(): Promise<void> {
    const session = await fetchSession().catch(() => null);
    if (session && session.server !== this.viewer.session.server) this.replaced();
  }

  private replaced(): void {
    this.stop();
    ++this.newest;
    coverReplaced();
  }

  private updateAddress(): void {
    const { timeline, selected, position } = this.viewer;
    const state = new URLSearchParams({ frame: `${timeline.frames[position]?.index ?? 0}` });
    if (selected) state.set('target', selected);
    history.replaceState(null, '', `#${state.toString()}`);
  }

  /** @param report its frames are added to the received ones */
  private receive(session: Session, report: Report): void {
    const { timeline } = this.viewer;
    this.isComplete = report.summary !== null;
    this.viewer.setSession(session);
    if (report.frames.length > 0) timeline.setFrames(timeline.frames.concat(report.frames));
    this.viewer.setCalibration(report.summary?.calibration ?? null);
    showDiagnosis(report.summary?.diagnosis ?? null, (index) =>
      this.seek(timeline.frames.findIndex((frame) => frame.index === index)),
    );
    const judged = timeline.frames.length;
    const isPart = (session.expected ?? judged) > judged;
    const text = `${judged}${isPart ? ` of ${session.expected}` : ''} frames`;
    if (this.isComplete) showState({ name: text, isFault: isPart });
    else showState({ name: 'judging', numbers: ` · ${text}` });
    showNotes({
      title: session.missing.length ? 'Missing data' : 'Notes',
      level: 'warn',
      lines: [...session.missing, ...notesOf(report.summary)],
    });
  }

  /** Fetches new frames until the run is complete. */
  private async poll(): Promise<void> {
    while (!this.isComplete) {
      await sleep(pollMilliseconds);
      const signal = AbortSignal.timeout(answerMilliseconds);
      const from = this.last + 1;
      const report = await fetchReport(from, signal).catch(() => null);
      // Fetched after the report: its missing data is that of all frames of the report.
      const session = report && (await fetchSession(signal).catch(() => null));
      if (!session) {
        this.showNoAnswer();
        continue;
      }
      if (session.server !== this.viewer.session.server) return this.replaced();
      this.receive(session, report);
      if (from === 0) await this.start();
    }
  }

  private showNoAnswer(): void {
    const name = 'the server does not respond';
    showState({ name, numbers: ` · ${this.last + 1} frames so far`, isFault: true });
    if (this.last < 0) cover('The server does not respond: is penumbra still running?', []);
  }
}
