// SPDX-License-Identifier: Apache-2.0
// Shows one frame in all panes: scene, image, numbers, timeline.
import { ApiError, fetchScene } from './api/client';
import type { Packet } from './api/packet';
import type { Calibration, FrameReport, Layer, PartName, Session } from './api/types';
import { seconds } from './model/format';
import { linkNames } from './model/labels';
import { Throttle } from './model/throttle';
import { isSoftwareGl, SceneView, type ScenePart } from './scene/scene_view';
import { TimelineView } from './timeline/timeline_view';
import { CamerasPanel } from './view/cameras_panel';
import { byId, element, setText } from './view/dom';
import { calibrationDetails, frameDetails } from './view/frame_panel';
import { ImageView } from './view/image_view';
import { withCommands } from './view/page';
import { targetDetails, targetList } from './view/target_panel';

const valueParts: readonly PartName[] = ['color', 'overlay', 'labels', 'links', 'vdi', 'depth'];

const liveNumbersMilliseconds = 200; // interval of updates
const conflict = 409; // the requested scene was replaced

/** The source of frames: a stored run, or live cameras. */
export interface FrameSource {
  /** Index of the displayed frame. */
  readonly current: number;
  seek(frame: number): void;
  togglePlaying(): void;
  setSpeed(factor: number): void;
  /** The result of Viewer.requestedParts() changed. */
  partsChanged(): void;
  /** Another target is selected. */
  targetChanged(): void;
}

export class Viewer {
  readonly scene: SceneView | null;
  readonly timeline: TimelineView;
  selected: string | null = null; // the target
  /** The pointer is over the image. */
  inspecting = false;
  packet: Packet | null = null; // of the displayed frame
  private calibration: Calibration | null = null; // how far the camera has moved; null: not known
  position = 0; // of the displayed frame in the timeline
  private readonly image: ImageView;
  private readonly cameras: CamerasPanel | null = null; // of several cameras
  private readonly isLive: boolean;
  private readonly isSlow = isSoftwareGl();
  private readonly numbers: Throttle;
  private displayedScene = ''; // server and version
  private firstStamp: bigint | null = null; // nanoseconds: start of live time
  private newest = 0; // number of the newest call of show()
  private drawing: Promise<void> = Promise.resolve();

  constructor(
    public session: Session,
    private readonly source: FrameSource,
  ) {
    this.isLive = session.mode === 'live';
    this.numbers = new Throttle(this.isLive ? liveNumbersMilliseconds : 0, () =>
      this.showNumbers(),
    );
    this.scene = makeScene(this.isSlow && this.isLive);
    this.image = new ImageView((inside) => {
      this.inspecting = inside;
      source.partsChanged();
    });
    this.timeline = new TimelineView(byId('timeline'), {
      seek: (frame) => source.seek(frame),
      select: (target) => this.select(target),
    });
    if (session.cameras?.length)
      this.cameras = new CamerasPanel(session.cameras, (...place) =>
        this.scene?.setPlace(...place),
      );
    this.scene?.updateTheme();
    document.addEventListener('theme', () => this.scene?.updateTheme());
    this.setSession(session);
  }

  setSession(session: Session): void {
    this.session = session;
    this.scene?.setCamera(session.camera);
    const isOfScans = session.parts.every((part) => part === 'cloud') && session.parts.length > 0;
    document.documentElement.classList.toggle('scans', isOfScans);
    setText(byId('place-button'), isOfScans ? 'Sensor' : 'Camera');
    if (this.scene) this.scene.cloud.uniforms.isScan.value = isOfScans;
  }

  /** The cloud has every step-th pixel of each row and column. */
  get step(): number {
    if (this.isLive) return this.isSlow ? 6 : 4;
    return (this.session.camera?.width ?? 0) > 800 ? 3 : 2;
  }

  /** Returns the parts that the panes need; withValues: also those for values under the pointer. */
  requestedParts(withValues: boolean): PartName[] {
    // Live, the page draws the overlay: labels are smaller than an image.
    const available = this.session.parts.filter((part) => !this.isLive || part !== 'overlay');
    const parts = new Set<PartName>(this.image.requestedParts(available));
    if (withValues) for (const part of valueParts) parts.add(part);
    if (this.scene && !this.scene.hidden.has('cloud')) parts.add('cloud');
    return available.filter((part) => parts.has(part)).sort();
  }

  /** Draws one frame at a time; drops all waiting ones but the newest. */
  async show(packet: Packet, position: number): Promise<void> {
    const number = ++this.newest;
    await this.drawing;
    if (number !== this.newest) return;
    const drawing = this.draw(packet, position);
    this.drawing = drawing.catch(() => undefined); // the caller handles the error
    await drawing;
  }

  private redraw(): void {
    if (this.packet) void this.show(this.packet, this.position);
  }

  private async draw(packet: Packet, position: number): Promise<void> {
    // No pane shows the frame if an image cannot be decoded.
    await Promise.all([
      this.image.show(packet, linkNames(this.session.links, packet.frame), this.selected),
      this.fetchRobot(packet),
    ]);
    this.packet = packet;
    this.position = position;
    if (packet.live) this.calibration = packet.live.calibration ?? null;
    this.scene?.show(packet, this.step, this.selected);
    this.cameras?.show(packet.frame, this.selected);
    this.showSceneNote(packet);
    this.timeline.setCurrent(position, packet.frame);
    for (const id of ['timeline-legend', 'occlusions'])
      byId(id).hidden = this.timeline.tracks.length === 0;
    this.numbers.request();
    byId('main').dataset['layer'] = this.image.layer;
    const parts = packet.parts.map(({ name }) => name);
    byId('main').dataset['shown'] = [packet.frame.index, ...parts].join(' ');
  }

  private showSceneNote(packet: Packet): void {
    if (!this.scene) return; // the note says that there is no scene
    const { hidden, points } = this.scene;
    const { status } = packet.frame;
    if (hidden.has('robot') && hidden.has('cloud'))
      return showSceneNote('Robot and points are switched off: see the buttons above.');
    const missing = packet.live?.missing ?? this.session.missing;
    const hasCloud = this.session.parts.includes('cloud');
    const isFetching = !packet.cloud && status === 'ok';
    const hasPoints = points > 0 || hidden.has('cloud') || isFetching || !hasCloud;
    showSceneNote(sceneNoteOf(packet, missing, hasPoints));
  }

  select(target: string | null): void {
    this.selected = target;
    this.timeline.select(target);
    this.source.targetChanged();
    const { packet } = this;
    if (!packet) return;
    this.scene?.show(packet, this.step, target);
    this.image.select(target);
    this.cameras?.show(packet.frame, target);
    this.showTarget(packet);
  }

  setLayer(layer: Layer): void {
    this.image.layer = layer;
    this.source.partsChanged();
    this.redraw();
  }

  setCloudByLabel(byLabel: boolean): void {
    if (!this.scene) return;
    this.scene.cloud.uniforms.byLabel.value = byLabel;
    this.scene.invalidate();
  }

  setShown(part: ScenePart, shown: boolean): void {
    if (shown) this.scene?.hidden.delete(part);
    else this.scene?.hidden.add(part);
    if (part === 'cloud') this.source.partsChanged();
    if (!this.packet) return;
    this.scene?.show(this.packet, this.step, this.selected);
    this.showSceneNote(this.packet);
  }

  setCalibration(calibration: Calibration | null): void {
    this.calibration = calibration;
    this.numbers.request();
  }

  /** Removes the robot and its fringe from points and images. */
  setWithoutRobot(on: boolean): void {
    this.image.withoutRobot = on;
    if (this.scene) this.scene.cloud.withoutRobot = on;
    this.source.partsChanged();
    this.redraw();
  }

  /** Fetches the packet's robot if it is not the displayed one. */
  private async fetchRobot(packet: Packet): Promise<void> {
    const key = `${packet.server} ${packet.scene_version}`;
    if (!this.scene || key === this.displayedScene) return;
    this.scene.setRobot(null);
    this.displayedScene = '';
    try {
      this.scene.setRobot(await fetchScene(packet.server, packet.scene_version));
      this.displayedScene = key;
    } catch (error) {
      // Live, a frame of the new robot follows: this one is shown without a robot.
      const isReplaced = error instanceof ApiError && error.status === conflict;
      if (!isReplaced || !this.isLive) throw error;
    }
  }

  /** Shows the frame's number and time; live the time since the page was opened. */
  private showPosition({ index, stamp_ns }: FrameReport): void {
    const { times, frames } = this.timeline;
    const time = this.isLive ? this.liveTime(stamp_ns) : (times[this.position] ?? null);
    const last = this.isLive ? '' : ` / ${frames.at(-1)?.index ?? 0}`;
    setText(byId('position-frame'), `frame ${index}${last}`);
    setText(byId('position-time'), time === null ? '' : seconds(time, 3));
  }

  private liveTime(stamp: string | null): number | null {
    if (stamp === null) return null;
    const now = BigInt(stamp);
    if (this.firstStamp === null || now < this.firstStamp) this.firstStamp = now;
    return Number(now - this.firstStamp) / 1e9;
  }

  private showNumbers(): void {
    const { packet } = this;
    if (!packet) return;
    const { frame } = packet;
    this.showPosition(frame);
    setText(byId('frame-number'), String(frame.index));
    byId('frame-details').replaceChildren(
      frameDetails(frame),
      ...(frame.points
        ? []
        : [calibrationDetails(this.calibration, packet.live?.calibrating ?? '')]),
    );
    byId('frame-status').hidden = frame.status === 'ok';
    setText(byId('frame-status'), frame.status);
    this.showTarget(packet);
  }

  private showTarget({ frame }: Packet): void {
    const list = byId('target-list');
    const isFocused = list.contains(document.activeElement);
    const noTargets = this.timeline.tracks.length
      ? 'No targets in this frame.'
      : 'No targets: define them in targets.yaml or with --target-topic.';
    list.replaceChildren(
      frame.targets.length > 0
        ? targetList(frame, this.selected, (target) => this.select(target))
        : noTargets,
    );
    if (isFocused) list.querySelector<HTMLElement>('[aria-pressed=true]')?.focus();
    const target = frame.targets.find(({ name }) => name === this.selected);
    byId('target-details').replaceChildren(
      ...(target ? [element('h2', '', target.name), targetDetails(target)] : []),
    );
  }
}

function makeScene(isSlow: boolean): SceneView | null {
  try {
    return new SceneView(byId<HTMLCanvasElement>('scene-canvas'), byId('scene-names'), isSlow);
  } catch {
    showSceneNote('This browser has no WebGL: the 3-D scene is not available.');
    return null;
  }
}

/** @param text commands are between backticks; empty: hides the note */
export function showSceneNote(text: string): void {
  byId('scene-note').replaceChildren(...withCommands(text));
}

/**
 * Returns why robot, points or camera are missing in the scene, or an empty text.
 * @param missing the server's messages about missing data
 */
function sceneNoteOf(packet: Packet, missing: readonly string[], hasPoints: boolean): string {
  const { frame, link_poses: linkPoses, camera_pose: cameraPose } = packet;
  const isOk = frame.status === 'ok';
  const reason = isOk ? '' : `: ${frame.message ?? frame.status}`;
  const without = linkPoses.filter((pose) => pose === null).length;
  const noPose = linkPoses.length > 0 && without === linkPoses.length;
  if (isOk && missing.length > 0 && (noPose || cameraPose === null))
    return `No ${noPose ? 'robot and no ' : ''}points to show: see the missing data above`;
  if (noPose) return `No robot in this frame: its pose is not known${reason}`;
  if (without > 0) return `${without} of ${linkPoses.length} links have no pose${reason}`;
  if (cameraPose === null) return `No points: the camera's pose is not known${reason}`;
  if (!hasPoints)
    return isOk
      ? 'No points: this frame has no measured depth to show'
      : `No points in this frame${reason}`;
  return isOk ? '' : `This frame is not judged${reason}`;
}
