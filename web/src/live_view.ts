// SPDX-License-Identifier: Apache-2.0
// The newest frame of penumbra live, as often as it can be drawn; a minute's reports for the timeline.
import { fetchSession } from './api/client';
import { LiveConnection } from './api/live';
import type { Packet } from './api/packet';
import type { FrameReport, Session } from './api/types';
import { LiveState, showTold } from './live_state';
import { Throttle } from './model/throttle';
import { bindCommands } from './view/commands';
import { coverReplaced, showInput, showPlaying, uncover } from './view/page';
import { Viewer, showSceneNote } from './viewer';

const keptFrames = 900;
const timelineMilliseconds = 500; // the timeline is drawn again no oftener than this

export class LiveView {
  private readonly frames: FrameReport[] = [];
  private readonly viewer: Viewer;
  private readonly state: LiveState;
  private readonly connection: LiveConnection;
  private readonly timeline = new Throttle(timelineMilliseconds, () =>
    this.viewer.timeline.setFrames(this.frames.slice()),
  );
  private paused = false;
  private sceneVersion: number;

  constructor(session: Session) {
    this.sceneVersion = session.scene_version;
    this.viewer = new Viewer(session, {
      seek: () => undefined, // frames that are gone cannot be shown again
      wantsChanged: () => this.connection?.want(this.wanted(), this.viewer.step),
      chosen: () => undefined,
    });
    bindCommands(this.viewer, {
      toggle: () => this.toggle(),
      seek: () => undefined,
      current: () => this.frames.length - 1,
      speed: () => undefined,
    });
    document.documentElement.classList.add('live');
    showPlaying(true);
    this.state = new LiveState({
      told: (told, fault) => this.told(told, fault),
      back: () => this.connection.renew(),
    });
    this.connection = new LiveConnection(
      {
        packet: (packet) => this.take(packet).finally(() => this.state.ended()),
        connected: () => this.state.connected(),
        disconnected: (seconds) => this.state.disconnected(seconds),
        fault: (message) => this.state.failed(message),
      },
      this.wanted(),
      this.viewer.step,
    );
    uncover();
  }

  private wanted(): ReturnType<Viewer['wanted']> {
    return this.viewer.wanted(this.viewer.inspecting);
  }

  private toggle(): void {
    this.paused = !this.paused;
    this.connection.setPaused(this.paused);
    this.state.setPaused(this.paused);
    showPlaying(!this.paused);
    this.timeline.flush(); // all that is shown is of one frame
    this.viewer.flush();
  }

  /** What the server says while no frame comes, or while none can be drawn. */
  private told(session: Session, fault: string | null): void {
    if (session.mode !== 'live') return coverReplaced();
    const ours = fault ? [{ level: 'error', message: fault }] : [];
    showTold(session.missing, [...ours, ...(session.diagnostics ?? [])], true);
    if (this.frames.length > 0) return;
    const what = fault
      ? `Frames come that cannot be drawn: ${fault}`
      : 'Waiting for the first frame.';
    showSceneNote([what, ...session.missing].join('\n'));
  }

  private async take(packet: Packet): Promise<void> {
    const arrived = performance.now();
    this.state.arrived();
    const { server, camera } = this.viewer.session;
    const isOther = packet.server !== server;
    if (isOther || packet.sceneVersion !== this.sceneVersion || !camera)
      await this.refresh(packet.sceneVersion, isOther);
    this.keep(packet);
    const first = packet.frame.targets[0];
    if (!this.viewer.chosen && first) this.viewer.choose(first.name);
    await this.viewer.show(packet, this.frames.length - 1);
    await new Promise((resolve) => requestAnimationFrame(resolve));
    if (packet.live) this.state.drawn(packet.live, performance.now() - arrived);
  }

  /**
   * Camera, links and parts became known, or changed.
   * @param isOther by another program on the same port, whose frames have other numbers
   */
  private async refresh(version: number, isOther: boolean): Promise<void> {
    const session = await fetchSession();
    this.sceneVersion = version;
    this.viewer.setSession(session);
    showInput(session);
    if (isOther) {
      this.viewer.choose(null);
      this.frames.length = 0;
    }
    this.connection.want(this.wanted(), this.viewer.step);
  }

  private keep(packet: Packet): void {
    this.frames.push(packet.frame);
    if (this.frames.length > keptFrames) this.frames.shift();
    this.timeline.request();
  }
}
