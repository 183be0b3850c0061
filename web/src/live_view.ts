// SPDX-License-Identifier: Apache-2.0
// Shows the newest frame of penumbra live; the timeline shows the last frames.
import { fetchSession } from './api/client';
import { LiveConnection } from './api/live';
import type { Packet } from './api/packet';
import type { FrameReport, PartName, Session } from './api/types';
import { LiveState, showDiagnostics } from './live_state';
import { Throttle } from './model/throttle';
import { bindCommands } from './view/commands';
import { coverReplaced, showInput, showPlaying, uncover } from './view/page';
import { showSceneNote, Viewer, type FrameSource } from './viewer';

const keptFrames = 900;
const timelineMilliseconds = 500; // interval of updates

export class LiveView implements FrameSource {
  private readonly frames: FrameReport[] = [];
  private readonly viewer: Viewer;
  private readonly state: LiveState;
  private readonly connection: LiveConnection;
  private readonly timeline = new Throttle(timelineMilliseconds, () =>
    this.viewer.timeline.setFrames(this.frames.slice()),
  );
  private isPaused = false;
  private sceneVersion: number;

  constructor(session: Session) {
    this.sceneVersion = session.scene_version;
    this.viewer = new Viewer(session, this);
    bindCommands(this.viewer, this);
    document.documentElement.classList.add('live');
    showPlaying(true);
    this.state = new LiveState({
      session: (answer, fault) => this.showSession(answer, fault),
      returned: () => this.connection.renew(),
    });
    this.connection = new LiveConnection(
      {
        packet: (packet) => this.receive(packet).finally(() => this.state.finished()),
        connected: () => this.state.connected(),
        disconnected: (seconds) => this.state.disconnected(seconds),
        fault: (message) => this.state.failed(message),
      },
      this.requestedParts(),
      this.viewer.step,
    );
    uncover();
  }

  get current(): number {
    return this.frames.length - 1;
  }

  togglePlaying(): void {
    this.isPaused = !this.isPaused;
    this.connection.setPaused(this.isPaused);
    this.state.setPaused(this.isPaused);
    showPlaying(!this.isPaused);
  }

  partsChanged(): void {
    this.connection?.setParts(this.requestedParts(), this.viewer.step);
  }

  // Live frames are not stored: only the newest one can be shown.
  seek(): void {}
  setSpeed(): void {}
  targetChanged(): void {}

  private requestedParts(): PartName[] {
    return this.viewer.requestedParts(this.viewer.inspecting);
  }

  /** Shows the server's messages while no frame comes, or while none can be displayed. */
  private showSession(session: Session, fault: string | null): void {
    if (session.mode !== 'live') return coverReplaced();
    const faults = fault ? [{ level: 'error', message: fault }] : [];
    showDiagnostics(session.missing, [...faults, ...(session.diagnostics ?? [])], true);
    if (this.frames.length > 0) return;
    const first = fault
      ? `Received frames cannot be displayed: ${fault}`
      : 'Waiting for the first frame.';
    showSceneNote([first, ...session.missing].join('\n'));
  }

  private async receive(packet: Packet): Promise<void> {
    const arrived = performance.now();
    this.state.arrived();
    const { server } = this.viewer.session;
    const isOther = packet.server !== server;
    if (isOther || packet.scene_version !== this.sceneVersion)
      await this.refresh(packet.scene_version, isOther);
    this.frames.push(packet.frame);
    if (this.frames.length > keptFrames) this.frames.shift();
    this.timeline.request();
    const first = packet.frame.targets[0];
    if (!this.viewer.selected && first) this.viewer.select(first.name);
    await this.viewer.show(packet, this.current);
    await new Promise((resolve) => requestAnimationFrame(resolve));
    if (packet.live) this.state.drawn(packet.live, performance.now() - arrived);
  }

  /**
   * Updates camera, links and parts.
   * @param isOther another program uses the port: forgets the frames of the earlier one
   */
  private async refresh(version: number, isOther: boolean): Promise<void> {
    const session = await fetchSession();
    this.sceneVersion = version;
    this.viewer.setSession(session);
    showInput(session);
    if (isOther) {
      this.viewer.select(null);
      this.frames.length = 0;
    }
    this.partsChanged();
  }
}
