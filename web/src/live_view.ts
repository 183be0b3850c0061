// SPDX-License-Identifier: Apache-2.0
// The newest frame of penumbra live, as often as it can be drawn; a minute's reports for the timeline.
import { fetchSession } from './api/client';
import { LiveConnection } from './api/live';
import type { Packet } from './api/packet';
import type { FrameReport, Session } from './api/types';
import { bindControls } from './view/controls';
import { byId, setText } from './view/dom';
import { uncover } from './view/cover';
import { showDiagnostics, showLink, showRate } from './view/live_status';
import { showMissing } from './view/missing';
import { Viewer } from './viewer';

const keptFrames = 900;
const pollMilliseconds = 1000;
const timelineMilliseconds = 500; // the timeline is drawn again no oftener than this

export class LiveView {
  private readonly frames: FrameReport[] = [];
  private readonly drops: number[] = [];
  private readonly viewer: Viewer;
  private readonly connection: LiveConnection;
  private paused = false;
  private drawn = 0;
  private sceneVersion: number;

  constructor(session: Session) {
    this.sceneVersion = session.scene_version;
    this.viewer = new Viewer(session, {
      seek: () => undefined, // frames that are gone cannot be shown again
      wantsChanged: () => this.connection?.want(this.wanted(), this.viewer.step),
    });
    bindControls(this.viewer, {
      toggle: () => this.toggle(),
      seek: () => undefined,
      current: () => this.frames.length - 1,
      speed: () => undefined,
    });
    document.documentElement.classList.add('live', 'playing');
    this.connection = new LiveConnection(
      {
        packet: (packet) => this.take(packet),
        connected: () => showLink(null),
        disconnected: (seconds) => showLink(seconds),
        fault: (message) => showDiagnostics([{ level: 'error', message }]),
      },
      this.wanted(),
      this.viewer.step,
    );
    void this.tellWaiting();
    uncover();
  }

  private wanted(): ReturnType<Viewer['wanted']> {
    return this.viewer.wanted(this.viewer.inspecting);
  }

  private toggle(): void {
    this.paused = !this.paused;
    this.connection.setPaused(this.paused);
    document.documentElement.classList.toggle('playing', !this.paused);
  }

  /** Until the first frame: what it waits for, in the server's words. */
  private async tellWaiting(): Promise<void> {
    while (this.frames.length === 0) {
      const { missing } = await fetchSession().catch(() => ({ missing: [] }));
      if (this.frames.length > 0) return;
      showMissing(missing, 'Not there');
      const note = byId('scene-note');
      note.hidden = false;
      setText(note, ['Waiting for the first frame.', ...missing].join('\n'));
      await new Promise((resolve) => window.setTimeout(resolve, pollMilliseconds));
    }
  }

  private async take(packet: Packet): Promise<void> {
    const arrived = performance.now();
    if (packet.sceneVersion !== this.sceneVersion || !this.viewer.session.camera)
      await this.refresh(packet.sceneVersion);
    this.keep(packet);
    if (!this.viewer.chosen) this.viewer.choose(packet.frame.targets[0]?.name ?? null);
    await this.viewer.show(packet, this.frames.length - 1);
    await new Promise((resolve) => requestAnimationFrame(resolve));
    if (packet.live) {
      showRate(packet.live, performance.now() - arrived);
      showDiagnostics(packet.live.diagnostics);
    }
  }

  /** Camera, links and parts became known, or changed. */
  private async refresh(version: number): Promise<void> {
    const session = await fetchSession();
    this.sceneVersion = version;
    this.viewer.setSession(session);
    this.connection.want(this.wanted(), this.viewer.step);
  }

  private keep(packet: Packet): void {
    this.frames.push(packet.frame);
    this.drops.push(packet.live?.dropped ?? 0);
    if (this.frames.length > keptFrames) {
      this.frames.shift();
      this.drops.shift();
    }
    const now = performance.now();
    if (now - this.drawn < timelineMilliseconds) return;
    this.drawn = now;
    this.viewer.timeline.setFrames(this.frames.slice(), this.drops.slice());
  }
}
