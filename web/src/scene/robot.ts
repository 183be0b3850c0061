// SPDX-License-Identifier: Apache-2.0
// The robot's triangles, as the renderer uses them, in each link's frame.
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
import type { MeshIndex, Pose, SceneIndex } from '../api/types';
import { okabeIto } from '../model/labels';

const creaseAngle = (35 * Math.PI) / 180; // sharper edges are not smoothed
const maxSmoothTriangles = 400_000; // larger robots have flat faces, so that they load quickly
const plain = new Color('#b9c2cc');
const blamed = new Color(okabeIto.vermillion);

/** Moves an object to its pose; hides it if the pose is not known. */
export function applyPose(object: Object3D, pose: Pose | null | undefined): void {
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

  /** @throws RangeError if an offset of the scene exceeds its data */
  constructor(scene: SceneIndex, data: ArrayBuffer) {
    const meshes = scene.links.flatMap((link) => link.meshes);
    const triangles = meshes.reduce((sum, mesh) => sum + mesh.triangles, 0);
    const flatShading = triangles > maxSmoothTriangles;
    this.links = scene.links.map(({ name, meshes: ofLink }) => {
      const material = new MeshStandardMaterial({ roughness: 0.62, metalness: 0.12, flatShading });
      const group = new Group();
      for (const mesh of ofLink)
        group.add(new Mesh(geometryOf(mesh, data, !flatShading), material));
      this.root.add(group);
      return { name, group, material };
    });
  }

  setPoses(poses: readonly (Pose | null)[]): void {
    this.links.forEach(({ group }, index) => applyPose(group, poses[index]));
  }

  /** Tints each link by the fraction of the selected target that it hides. */
  setBlame(fractions: ReadonlyMap<string, number>): void {
    for (const { name, material } of this.links) {
      const fraction = fractions.get(name) ?? 0;
      material.color.lerpColors(plain, blamed, fraction > 0 ? 0.4 + 0.6 * fraction : 0);
    }
  }

  dispose(): void {
    for (const { group, material } of this.links) {
      material.dispose();
      for (const mesh of group.children) (mesh as Mesh).geometry.dispose();
    }
  }
}

function geometryOf(mesh: MeshIndex, data: ArrayBuffer, isSmooth: boolean): BufferGeometry {
  const geometry = new BufferGeometry();
  const positions = new Float32Array(data, mesh.position_offset, 3 * mesh.vertices);
  const indices = new Uint32Array(data, mesh.index_offset, 3 * mesh.triangles);
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  return isSmooth ? toCreasedNormals(geometry, creaseAngle) : geometry;
}
