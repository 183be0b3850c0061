// SPDX-License-Identifier: Apache-2.0
// Targets in the scene. A cross: the point measured in this frame. A solid where the target is
// handled: a ball measured, a cone predicted, a diamond held; lost ones are drawn nowhere.
import {
  AxesHelper,
  BufferAttribute,
  BufferGeometry,
  Color,
  ConeGeometry,
  Group,
  Line,
  LineBasicMaterial,
  LineDashedMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  OctahedronGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import type { TargetReport } from '../api/types';

const size = 0.018; // metres: a mark's radius
const smallestSigma = 0.004; // metres: smaller ones vanish in the mark
const largestSigma = 1;

const shapes = {
  measured: new SphereGeometry(size, 24, 16),
  predicted: new ConeGeometry(size, 2 * size, 20).rotateX(Math.PI / 2),
  held: new OctahedronGeometry(1.3 * size),
};
const unitSphere = new SphereGeometry(1, 32, 20);

function crossOf(reach: number): BufferGeometry {
  const ends = new Float32Array([
    -reach,
    0,
    0,
    reach,
    0,
    0,
    0,
    -reach,
    0,
    0,
    reach,
    0,
    0,
    0,
    -reach,
    0,
    0,
    reach,
  ]);
  return new BufferGeometry().setAttribute('position', new BufferAttribute(ends, 3));
}
const cross = crossOf(1.4 * size);

export class TargetMark {
  readonly root = new Group();
  /** Where its name is written; null: nothing of it is drawn. */
  anchor: Vector3 | null = null;
  // Drawn over all else: what hides a target must not hide where it is.
  private readonly solidMaterial = new MeshStandardMaterial({ roughness: 0.5, depthTest: false });
  private readonly sigmaMaterial = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.16,
    depthWrite: false,
  });
  private readonly lineMaterial = new LineBasicMaterial({ depthTest: false });
  private readonly solid = new Mesh<BufferGeometry>(shapes.measured, this.solidMaterial);
  private readonly sigma = new Mesh(unitSphere, this.sigmaMaterial);
  private readonly cross = new LineSegments(cross, this.lineMaterial);
  private readonly axes = new AxesHelper(5 * size);
  private readonly gap = new Line(
    new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3)),
    new LineDashedMaterial({ dashSize: 0.02, gapSize: 0.012 }),
  );

  constructor() {
    this.solid.renderOrder = 2;
    this.cross.renderOrder = 3;
    this.axes.renderOrder = 3;
    (this.axes.material as LineBasicMaterial).depthTest = false;
    this.gap.frustumCulled = false;
    this.root.add(this.solid, this.sigma, this.cross, this.axes, this.gap);
  }

  update(target: TargetReport | null, color: Color, ink: Color, chosen: boolean): void {
    const handled = target?.handled;
    const source = handled?.source;
    const at = handled?.position && source && source !== 'lost' ? handled.position : null;
    const point = target?.point ?? null;
    this.solid.visible = at !== null;
    this.axes.visible = at !== null && !!handled?.orientation;
    if (at && source && source !== 'lost') {
      this.solid.geometry = shapes[source];
      this.solid.position.set(...at);
      this.solid.scale.setScalar(chosen ? 1.35 : 1);
      this.axes.position.copy(this.solid.position);
      if (handled?.orientation) this.axes.quaternion.set(...handled.orientation);
    }
    this.showSigma(at !== null ? (handled?.sigma_m ?? 0) : 0);
    this.cross.visible = point !== null;
    if (point) this.cross.position.set(...point);
    this.solidMaterial.color.copy(color);
    this.sigmaMaterial.color.copy(color);
    this.lineMaterial.color.copy(ink);
    this.showGap(at !== null && point !== null, ink);
    const shown = at ? this.solid : point ? this.cross : null;
    this.anchor = shown ? shown.position : null;
  }

  dispose(): void {
    for (const material of [this.solidMaterial, this.sigmaMaterial, this.lineMaterial])
      material.dispose();
    this.axes.dispose();
    this.gap.geometry.dispose();
    this.gap.material.dispose();
  }

  private showSigma(sigma: number): void {
    this.sigma.visible = sigma >= smallestSigma;
    this.sigma.scale.setScalar(Math.min(sigma, largestSigma));
    this.sigma.position.copy(this.solid.position);
  }

  private showGap(visible: boolean, ink: Color): void {
    this.gap.visible = visible;
    if (!visible) return;
    const ends = this.gap.geometry.getAttribute('position') as BufferAttribute;
    ends.setXYZ(0, ...this.solid.position.toArray());
    ends.setXYZ(1, ...this.cross.position.toArray());
    ends.needsUpdate = true;
    this.gap.computeLineDistances();
    this.gap.material.color.copy(ink);
  }
}
