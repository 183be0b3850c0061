// SPDX-License-Identifier: Apache-2.0
// Targets in the scene. A cross: the point measured in this frame. A solid: the position of a handled
// target (ball measured, cone predicted, diamond held, nothing when lost).
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
import { okabeIto, verdictOf, verdicts } from '../model/labels';
import { element } from '../view/dom';
import { placeNames, targetName, type PlacedName } from '../view/names';

const colors: Readonly<Record<Verdict, string>> = {
  visible: okabeIto.green,
  partial: okabeIto.orange,
  hidden: okabeIto.vermillion,
  unknown: okabeIto.yellow,
  out_of_view: '#8b949e',
  held: okabeIto.sky,
};

const size = 0.018; // metres: radius of a solid
const minSigma = 0.004; // metres: smaller spheres are inside the solid
const maxSigma = 1;

const shapes = {
  measured: new SphereGeometry(size, 24, 16),
  predicted: new ConeGeometry(size, 2 * size, 20).rotateX(Math.PI / 2),
  held: new OctahedronGeometry(1.3 * size),
};
const sphere = new SphereGeometry(1, 32, 20);
const arm = 1.4 * size;
const cross = new BufferGeometry().setFromPoints([
  new Vector3(-arm, 0, 0),
  new Vector3(arm, 0, 0),
  new Vector3(0, -arm, 0),
  new Vector3(0, arm, 0),
  new Vector3(0, 0, -arm),
  new Vector3(0, 0, arm),
]);
const axes = new AxesHelper(5 * size);

// Without depth test: marks are drawn over the objects that hide the target.
const lineMaterial = new LineBasicMaterial({ depthTest: false });
(axes.material as LineBasicMaterial).depthTest = false;
const byVerdict = <M>(make: (color: string) => M): Readonly<Record<Verdict, M>> =>
  Object.fromEntries(verdicts.map((verdict) => [verdict, make(colors[verdict])])) as Record<
    Verdict,
    M
  >;
const solidMaterials = byVerdict(
  (color) => new MeshStandardMaterial({ color, roughness: 0.5, depthTest: false }),
);
const sigmaMaterials = byVerdict(
  (color) => new MeshBasicMaterial({ color, transparent: true, opacity: 0.16, depthWrite: false }),
);

interface Shown {
  readonly name: HTMLElement;
  /** Position of the name. */
  readonly anchor: Vector3;
}

/** The marks of a frame's targets, and their names as text over the scene. */
export class TargetLayer {
  readonly root = new Group();
  private marks: readonly Shown[] = [];
  private places: readonly Shown[] = [];

  constructor(private readonly names: HTMLElement) {}

  setLineColor(color: Color): void {
    lineMaterial.color.copy(color);
  }

  /** Names places that are no targets. */
  namePlaces(places: ReadonlyMap<string, Vec3>): void {
    this.places = [...places].map(([name, at]) => ({
      name: element('span', 'target-name', name),
      anchor: new Vector3(...at),
    }));
    this.listNames();
  }

  show(targets: readonly TargetReport[], selected: string | null): void {
    this.root.clear();
    this.marks = targets.flatMap((target) => {
      const isSelected = target.name === selected;
      const at = this.addMarks(target, isSelected);
      if (!at) return [];
      const name = targetName(target);
      name.classList.toggle('selected', isSelected);
      return [{ name, anchor: new Vector3(...at) }];
    });
    this.listNames();
  }

  private listNames(): void {
    this.names.replaceChildren(...[...this.marks, ...this.places].map(({ name }) => name));
  }

  placeNames(eye: Camera, canvas: HTMLCanvasElement): void {
    const at = new Vector3();
    const placed: PlacedName[] = [];
    for (const { name, anchor } of [...this.marks, ...this.places]) {
      at.copy(anchor).project(eye);
      name.hidden = at.z >= 1 || Math.abs(at.x) >= 1 || Math.abs(at.y) >= 1;
      if (name.hidden) continue;
      const x = ((at.x + 1) / 2) * canvas.clientWidth;
      const y = ((1 - at.y) / 2) * canvas.clientHeight;
      placed.push({ name, x: x + 14, y: y - 11 }); // next to the mark
    }
    placeNames(placed);
  }

  /** @returns the position of the name, or null if the target has no marks */
  private addMarks(target: TargetReport, isSelected: boolean): Vec3 | null {
    const { handled, point } = target;
    const verdict = verdictOf(target);
    const add = (mark: Object3D, at: Vec3, order = 0): void => {
      mark.position.set(...at);
      mark.renderOrder = order;
      this.root.add(mark);
    };
    if (point) add(new LineSegments(cross, lineMaterial), point, 3);
    if (!handled?.position || handled.source === 'lost') return point;
    const { position, orientation, source, sigma_m: sigma } = handled;
    const solid = new Mesh(shapes[source], solidMaterials[verdict]);
    solid.scale.setScalar(isSelected ? 1.35 : 1);
    add(solid, position, 2);
    if (sigma !== null && sigma >= minSigma) {
      const ball = new Mesh(sphere, sigmaMaterials[verdict]);
      ball.scale.setScalar(Math.min(sigma, maxSigma));
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
