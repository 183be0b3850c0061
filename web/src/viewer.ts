// SPDX-License-Identifier: Apache-2.0
// Shows one frame everywhere: scene, image, numbers, timeline. Knows nothing of where frames come from.
import { fetchScene, fetchSceneData } from './api/client';
import type { Packet } from './api/packet';
import type { PartName, Session } from './api/types';
import { seconds } from './model/format';
import { SceneView, type ScenePart } from './scene/scene_view';
import { isSoftwareGl } from './scene/software_gl';
import { TimelineView } from './timeline/timeline_view';
import { byId, setText } from './view/dom';
import { frameDetails } from './view/frame_panel';
import { ImageView } from './view/image_view';
import { reasonOfNoRobot } from './view/no_robot';
import { targetDetails, targetList } from './view/target_panel';
import { styleValue } from './view/theme';

const valueParts: readonly PartName[] = ['color', 'overlay', 'labels', 'links', 'vdi', 'depth'];

const liveNumbersMilliseconds = 200;

export interface ViewerHandlers {
  seek(frame: number): void;
  /** Other parts are wanted than before. */
  wantsChanged(): void;
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
  private sceneVersion = -1;
  private numbersAt = -Infinity;
  private order = 0;
  private position = 0;
  private drawing: Promise<void> = Promise.resolve();

  constructor(
    public session: Session,
    readonly handlers: ViewerHandlers,
  ) {
    this.isSlow = isSoftwareGl();
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
    this.packet = packet;
    this.position = position;
    await Promise.all([this.showScene(packet), this.image.show(packet, this.session.links)]);
    this.timeline.setCurrent(position, packet.frame);
    byId('timeline-legend').hidden = this.timeline.tracks.length === 0;
    if (this.numbersAreDue()) this.showNumbers(packet, position);
    byId('main').dataset['shown'] = [packet.frame.index, ...packet.has].join(' ');
  }

  choose(name: string | null): void {
    this.chosen = name;
    this.timeline.setChosen(name);
    const { packet } = this;
    if (!packet) return;
    this.scene?.show(packet, this.step, name);
    this.showTarget(packet);
  }

  setShown(part: ScenePart, shown: boolean): void {
    if (shown) this.hidden.delete(part);
    else this.hidden.add(part);
    this.scene?.setShown(part, shown);
    if (part === 'cloud') this.handlers.wantsChanged();
    if (this.packet) this.scene?.show(this.packet, this.step, this.chosen);
  }

  applyTheme(): void {
    this.scene?.setTheme(styleValue('--scene'), styleValue('--scene-line'), styleValue('--ink'));
  }

  private async showScene(packet: Packet): Promise<void> {
    if (!this.scene) return;
    if (packet.sceneVersion !== this.sceneVersion) {
      const [index, data] = await Promise.all([fetchScene(), fetchSceneData()]);
      this.sceneVersion = index.version;
      this.scene.setRobot(index, data);
    }
    this.scene.show(packet, this.step, this.chosen);
    const reason = reasonOfNoRobot(packet, this.session.missing);
    const note = byId('scene-note');
    note.hidden = reason === null;
    setText(note, reason ?? '');
  }

  /** Live nobody reads thirty tables a second. */
  private numbersAreDue(): boolean {
    const now = performance.now();
    if (this.session.mode === 'live' && now - this.numbersAt < liveNumbersMilliseconds)
      return false;
    this.numbersAt = now;
    return true;
  }

  private showNumbers(packet: Packet, position: number): void {
    const { frame } = packet;
    const time = this.timeline.times[position];
    const count = this.session.mode === 'live' ? '' : ` / ${this.timeline.times.length}`;
    setText(byId('position-frame'), `${position + 1}${count}`);
    setText(byId('position-time'), time === null || time === undefined ? '' : seconds(time, 3));
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
        : 'None were judged: a targets.yaml names them.';
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
    const note = byId('scene-note');
    note.hidden = false;
    setText(note, 'This browser has no WebGL: the 3-D scene is not drawn. All else works.');
    return null;
  }
}
