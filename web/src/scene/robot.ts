// SPDX-License-Identifier: Apache-2.0
// The robot as the renderer draws it: its own triangles, in each link's frame.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
} from 'three';
import { toCreasedNormals } from 'three/addons/utils/BufferGeometryUtils.js';
import type { Pose, SceneIndex } from '../api/types';
import { okabeIto } from '../model/labels';

const crease = (35 * Math.PI) / 180; // edges sharper than this stay edges
const mostCreasedTriangles = 400_000; // beyond it flat faces: the page has to load quickly
const plain = new Color('#b9c2cc');
const blamed = new Color(okabeIto.vermillion);

/** Places an object; without a pose it is not shown: nothing stands where nothing is known. */
export function place(object: Object3D, pose: Pose | null | undefined): void {
  object.visible = !!pose;
  if (!pose) return;
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
}

interface Link {
  readonly name: string;
  readonly group: Group;
  readonly material: MeshStandardMaterial;
}

export class RobotModel {
  readonly root = new Group();
  private readonly links: Link[];

  /** @throws RangeError where the scene's offsets do not fit its bytes */
  constructor(scene: SceneIndex, data: ArrayBuffer) {
    const triangles = scene.links.reduce(
      (sum, link) => sum + link.meshes.reduce((part, mesh) => part + mesh.triangles, 0),
      0,
    );
    this.links = scene.links.map((link) => {
      const material = new MeshStandardMaterial({
        color: plain,
        roughness: 0.62,
        metalness: 0.12,
        flatShading: triangles > mostCreasedTriangles,
      });
      const group = new Group();
      group.name = link.name;
      for (const mesh of link.meshes)
        group.add(new Mesh(geometryOf(mesh, data, !material.flatShading), material));
      group.visible = false;
      this.root.add(group);
      return { name: link.name, group, material };
    });
  }

  /** @returns how many links have a pose */
  setPoses(poses: readonly (Pose | null)[]): number {
    let known = 0;
    this.links.forEach((link, index) => {
      place(link.group, poses[index]);
      if (poses[index]) ++known;
    });
    return known;
  }

  /** Tints links by what they hide of the chosen target. */
  setBlame(fractions: ReadonlyMap<string, number>): void {
    for (const link of this.links) {
      const fraction = fractions.get(link.name) ?? 0;
      link.material.color.lerpColors(plain, blamed, fraction > 0 ? 0.4 + 0.6 * fraction : 0);
    }
  }

  dispose(): void {
    for (const link of this.links) {
      link.material.dispose();
      for (const mesh of link.group.children) (mesh as Mesh).geometry.dispose();
    }
  }
}

type MeshIndex = SceneIndex['links'][number]['meshes'][number];

function geometryOf(mesh: MeshIndex, data: ArrayBuffer, creased: boolean): BufferGeometry {
  const geometry = new BufferGeometry();
  const positions = new Float32Array(data, mesh.position_offset, 3 * mesh.vertices);
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(
    new BufferAttribute(new Uint32Array(data, mesh.index_offset, 3 * mesh.triangles), 1),
  );
  return creased ? toCreasedNormals(geometry, crease) : geometry;
}
