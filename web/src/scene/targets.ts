// SPDX-License-Identifier: Apache-2.0
// Targets in the scene. A cross: the point measured in this frame. A solid where the target is
// handled: a ball measured, a cone predicted, a diamond held; lost ones are drawn nowhere.
import {
  AxesHelper,
  BufferGeometry,
  ConeGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  OctahedronGeometry,
  SphereGeometry,
  Vector3,
  type Camera,
  type Color,
  type Object3D,
} from 'three';
import type { TargetReport, Vec3, Verdict } from '../api/types';
import { okabeIto, verdictOf } from '../model/labels';
import { element } from '../view/dom';
import { placeNames, type Placed } from '../view/names';
import { verdictIcon } from '../view/verdict_icon';

const colors: Readonly<Record<Verdict, string>> = {
  visible: okabeIto.green,
  partial: okabeIto.orange,
  hidden: okabeIto.vermillion,
  unknown: okabeIto.yellow,
  out_of_view: '#8b949e',
};

const size = 0.018; // metres: a mark's radius
const smallestSigma = 0.004; // metres: smaller ones vanish in the mark
const largestSigma = 1;

const shapes = {
  measured: new SphereGeometry(size, 24, 16),
  predicted: new ConeGeometry(size, 2 * size, 20).rotateX(Math.PI / 2),
  held: new OctahedronGeometry(1.3 * size),
};
const sphere = new SphereGeometry(1, 32, 20);
const cross = new BufferGeometry().setFromPoints(
  [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)].flatMap((axis) => [
    axis.clone().multiplyScalar(-1.4 * size),
    axis.clone().multiplyScalar(1.4 * size),
  ]),
);
const axes = new AxesHelper(5 * size);

// Drawn over all else: what hides a target must not hide where it is.
const ink = new LineBasicMaterial({ depthTest: false });
(axes.material as LineBasicMaterial).depthTest = false;
const verdicts = Object.keys(colors) as Verdict[];
const solids = new Map(
  verdicts.map((verdict) => [
    verdict,
    new MeshStandardMaterial({ color: colors[verdict], roughness: 0.5, depthTest: false }),
  ]),
);
const sigmas = new Map(
  verdicts.map((verdict) => [
    verdict,
    new MeshBasicMaterial({
      color: colors[verdict],
      transparent: true,
      opacity: 0.16,
      depthWrite: false,
    }),
  ]),
);

interface Shown {
  readonly name: HTMLElement;
  /** Where the name is written. */
  readonly anchor: Vector3;
}

/** Marks of a frame's targets, and their names as text over the scene. */
export class TargetLayer {
  readonly root = new Group();
  private shown: readonly Shown[] = [];

  constructor(private readonly names: HTMLElement) {}

  setInk(color: Color): void {
    ink.color.copy(color);
  }

  show(targets: readonly TargetReport[], chosen: string | null): void {
    this.root.clear();
    this.shown = targets.flatMap((target) => {
      const isChosen = target.name === chosen;
      const at = this.addMarks(target, isChosen);
      if (!at) return [];
      const icon = verdictIcon(verdictOf(target.verdict));
      const name = element('span', `target-name${isChosen ? ' chosen' : ''}`, icon, target.name);
      return [{ name, anchor: new Vector3(...at) }];
    });
    this.names.replaceChildren(...this.shown.map(({ name }) => name));
  }

  placeNames(eye: Camera, canvas: HTMLCanvasElement): void {
    const at = new Vector3();
    const placed: Placed[] = [];
    for (const { name, anchor } of this.shown) {
      at.copy(anchor).project(eye);
      name.hidden = at.z >= 1 || Math.abs(at.x) >= 1 || Math.abs(at.y) >= 1;
      if (name.hidden) continue;
      const x = ((at.x + 1) / 2) * canvas.clientWidth;
      const y = ((1 - at.y) / 2) * canvas.clientHeight;
      placed.push({ name, x: x + 14, y: y - 11 }); // beside the mark
    }
    placeNames(placed);
  }

  /** @returns where the name is written; null: nothing of it is drawn */
  private addMarks({ verdict, handled, point }: TargetReport, isChosen: boolean): Vec3 | null {
    const kind = verdictOf(verdict);
    const add = (mark: Object3D, at: Vec3, order = 0): void => {
      mark.position.set(...at);
      mark.renderOrder = order;
      this.root.add(mark);
    };
    if (point) add(new LineSegments(cross, ink), point, 3);
    if (!handled?.position || handled.source === 'lost') return point;
    const { position, orientation, source, sigma_m: sigma } = handled;
    const solid = new Mesh(shapes[source], solids.get(kind));
    solid.scale.setScalar(isChosen ? 1.35 : 1);
    add(solid, position, 2);
    if (sigma !== null && sigma >= smallestSigma) {
      const ball = new Mesh(sphere, sigmas.get(kind));
      ball.scale.setScalar(Math.min(sigma, largestSigma));
      add(ball, position);
    }
    if (orientation) {
      const frame = new LineSegments(axes.geometry, axes.material);
      frame.quaternion.set(...orientation);
      add(frame, position, 3);
    }
    return position;
  }
}
