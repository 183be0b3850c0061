// SPDX-License-Identifier: Apache-2.0
// Shows one frame everywhere: scene, image, numbers, timeline. Knows nothing of where frames come from.
import { ApiError, fetchScene } from './api/client';
import type { Packet } from './api/packet';
import type { FrameReport, PartName, Session } from './api/types';
import { seconds } from './model/format';
import { Throttle } from './model/throttle';
import { SceneView, type ScenePart } from './scene/scene_view';
import { isSoftwareGl } from './scene/software_gl';
import { TimelineView } from './timeline/timeline_view';
import { byId, setText } from './view/dom';
import { frameDetails } from './view/frame_panel';
import { ImageView, type Layer } from './view/image_view';
import { targetDetails, targetList } from './view/target_panel';
import { styleValue } from './view/theme';

const valueParts: readonly PartName[] = ['color', 'overlay', 'labels', 'links', 'vdi', 'depth'];

const liveNumbersMilliseconds = 200; // nobody reads thirty tables a second
const conflict = 409; // the status of a scene that another has replaced

export interface ViewerHandlers {
  seek(frame: number): void;
  /** Other parts are wanted than before. */
  wantsChanged(): void;
  /** Another target is looked at. */
  chosen(): void;
}

export class Viewer {
  readonly scene: SceneView | null;
  readonly image: ImageView;
  readonly timeline: TimelineView;
  chosen: string | null = null;
  /** Values under the pointer are wanted too. */
  inspecting = false;
  packet: Packet | null = null;
  private readonly hidden = new Set<ScenePart>();
  private readonly isSlow: boolean;
  private readonly numbers: Throttle;
  private sceneShown = ''; // server and version
  private origin = 0n; // nanoseconds: the stamp that live time counts from
  private order = 0;
  private position = 0;
  private drawing: Promise<void> = Promise.resolve();

  constructor(
    public session: Session,
    readonly handlers: ViewerHandlers,
  ) {
    this.isSlow = isSoftwareGl();
    const rest = session.mode === 'live' ? liveNumbersMilliseconds : 0;
    this.numbers = new Throttle(rest, () => this.showNumbers());
    this.scene = makeScene(this.isSlow && session.mode === 'live');
    this.image = new ImageView((inside) => {
      this.inspecting = inside;
      handlers.wantsChanged();
    });
    this.timeline = new TimelineView(byId('timeline'), {
      seek: (frame) => handlers.seek(frame),
      choose: (name) => this.choose(name),
    });
    this.applyTheme();
    document.addEventListener('theme', () => this.applyTheme());
    this.setSession(session);
  }

  setSession(session: Session): void {
    this.session = session;
    this.scene?.setCamera(session.camera);
  }

  /** Every step-th pixel of each row and column becomes a point. */
  get step(): number {
    if (this.session.mode === 'live') return this.isSlow ? 6 : 4;
    return (this.session.camera?.width ?? 0) > 800 ? 3 : 2;
  }

  wanted(withValues: boolean): PartName[] {
    // Live the overlay is drawn here: labels are smaller than a picture, and made in no time.
    const isLive = this.session.mode === 'live';
    const parts = this.session.parts.filter((part) => !isLive || part !== 'overlay');
    const cloud: PartName[] = this.scene && !this.hidden.has('cloud') ? ['cloud'] : [];
    const layers = withValues ? valueParts : this.image.wanted(parts);
    const all = new Set([...layers, ...cloud]);
    return [...all].filter((part) => parts.includes(part)).sort();
  }

  /** One after the other, the newest alone: no late picture may cover a newer one. */
  async show(packet: Packet, position: number): Promise<void> {
    const order = ++this.order;
    await this.drawing;
    if (order !== this.order) return;
    const drawing = this.draw(packet, position);
    this.drawing = drawing.catch(() => undefined); // the caller hears of it
    await drawing;
  }

  /** The same frame, after another choice of what to see. */
  redraw(): void {
    if (this.packet) void this.show(this.packet, this.position);
  }

  private async draw(packet: Packet, position: number): Promise<void> {
    // What cannot be decoded is shown nowhere.
    await Promise.all([
      this.image.show(packet, this.session.links, this.chosen),
      this.fetchRobot(packet),
    ]);
    this.packet = packet;
    this.position = position;
    this.showScene(packet);
    this.timeline.setCurrent(position, packet.frame);
    for (const id of ['timeline-legend', 'occlusions'])
      byId(id).hidden = this.timeline.tracks.length === 0;
    this.numbers.request();
    byId('main').dataset['layer'] = this.image.layer;
    byId('main').dataset['shown'] = [packet.frame.index, ...packet.has].join(' ');
  }

  choose(name: string | null): void {
    this.chosen = name;
    this.timeline.setChosen(name);
    this.handlers.chosen();
    const { packet } = this;
    if (!packet) return;
    this.scene?.show(packet, this.step, name);
    this.image.showChosen(name);
    this.showTarget(packet);
  }

  setLayer(layer: Layer): void {
    this.image.layer = layer;
    this.handlers.wantsChanged();
    this.redraw();
  }

  setCloudByLabel(byLabel: boolean): void {
    this.scene?.cloud.setColors(byLabel ? 'label' : 'color');
    this.scene?.invalidate();
  }

  setShown(part: ScenePart, shown: boolean): void {
    if (shown) this.hidden.delete(part);
    else this.hidden.add(part);
    this.scene?.setShown(part, shown);
    if (part === 'cloud') this.handlers.wantsChanged();
    if (this.packet) this.scene?.show(this.packet, this.step, this.chosen);
  }

  /** Leaves the robot and its fringe out of points and images, or shows them. */
  setWithoutRobot(on: boolean): void {
    this.image.withoutRobot = on;
    if (this.scene) this.scene.cloud.withoutRobot = on;
    this.handlers.wantsChanged();
    this.redraw();
  }

  /** Numbers that wait for their time, at once. */
  flush(): void {
    this.numbers.flush();
  }

  applyTheme(): void {
    this.scene?.setTheme(styleValue('--scene'), styleValue('--scene-line'), styleValue('--ink'));
  }

  private showScene(packet: Packet): void {
    if (!this.scene) return;
    this.scene.show(packet, this.step, this.chosen);
    showSceneNote(reasonOfNoRobot(packet, packet.live?.missing ?? this.session.missing));
  }

  /** The packet's robot, where another one is shown. */
  private async fetchRobot(packet: Packet): Promise<void> {
    const { scene } = this;
    const wanted = `${packet.server} ${packet.sceneVersion}`;
    if (!scene || wanted === this.sceneShown) return;
    scene.setRobot(null);
    this.sceneShown = '';
    try {
      const { index, data } = await fetchScene(packet.server, packet.sceneVersion);
      scene.setRobot({ index, data });
      this.sceneShown = wanted;
    } catch (error) {
      // Live a newer frame, of the new robot, is on its way: this one is shown without.
      const isReplaced = error instanceof ApiError && error.status === conflict;
      if (!isReplaced || this.session.mode !== 'live') throw error;
    }
  }

  /** The frame's number in the report, and the last one's; live the time since the page was opened. */
  private showPosition(frame: FrameReport): void {
    const { times, lastIndex } = this.timeline;
    const isLive = this.session.mode === 'live';
    const time = isLive ? this.liveTime(frame.stamp_ns) : (times[this.position] ?? null);
    setText(byId('position-frame'), `frame ${frame.index}${isLive ? '' : ` / ${lastIndex}`}`);
    setText(byId('position-time'), time === null ? '' : seconds(time, 3));
  }

  private liveTime(stamp: string | null): number | null {
    if (stamp === null) return null;
    const now = BigInt(stamp);
    if (this.origin === 0n || now < this.origin) this.origin = now; // or the clock was set back
    return Number(now - this.origin) / 1e9;
  }

  private showNumbers(): void {
    const { packet } = this;
    if (!packet) return;
    const { frame } = packet;
    this.showPosition(frame);
    setText(byId('frame-number'), String(frame.index));
    byId('frame-details').replaceChildren(frameDetails(frame));
    const status = byId('frame-status');
    status.hidden = frame.status === 'ok';
    status.classList.add('fault');
    setText(status, frame.status);
    this.showTarget(packet);
  }

  private showTarget({ frame }: Packet): void {
    const list = byId('target-list');
    const focused = list.contains(document.activeElement);
    if (frame.targets.length === 0)
      list.textContent = this.timeline.tracks.length
        ? 'None in this frame.'
        : 'None were judged: targets.yaml or --target-topic names them.';
    else list.replaceChildren(targetList(frame, this.chosen, (name) => this.choose(name)));
    if (focused) list.querySelector<HTMLElement>('[aria-pressed=true]')?.focus();
    const target = frame.targets.find((one) => one.name === this.chosen);
    byId('target-details').replaceChildren(target ? targetDetails(target) : '');
  }
}

function makeScene(isSlow: boolean): SceneView | null {
  try {
    return new SceneView(byId<HTMLCanvasElement>('scene-canvas'), byId('scene-names'), isSlow);
  } catch {
    showSceneNote('This browser has no WebGL: the 3-D scene is not drawn. All else works.');
    return null;
  }
}

/** @param text null: there is nothing to say */
export function showSceneNote(text: string | null): void {
  byId('scene-note').hidden = text === null;
  setText(byId('scene-note'), text ?? '');
}

/**
 * Why robot or camera are not where they should be in the scene; null: they are.
 * @param missing what is not there in any frame, in the server's words
 */
function reasonOfNoRobot(packet: Packet, missing: readonly string[]): string | null {
  const { frame, linkPoses, cameraPose } = packet;
  const noPose = linkPoses.length > 0 && linkPoses.every((pose) => pose === null);
  if (frame.status === 'ok' && missing.length > 0 && (noPose || cameraPose === null))
    return missing.join('; ');
  const because = frame.status === 'ok' ? '' : `: ${frame.message ?? frame.status}`;
  if (noPose) return `No robot in this frame, as its pose is not known${because}`;
  const without = linkPoses.filter((pose) => pose === null).length;
  if (without > 0) return `${without} of ${linkPoses.length} links have no pose${because}`;
  if (cameraPose === null) return `The camera's pose is not known: no points${because}`;
  return frame.status === 'ok' ? null : `${frame.status}${because}`;
}
