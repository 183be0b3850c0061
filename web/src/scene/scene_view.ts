// SPDX-License-Identifier: Apache-2.0
// The 3-D scene in the root link's frame: robot, camera, cloud, targets. Drawn when something
// changed, never in between.
import {
  AmbientLight,
  Box3,
  Color,
  DirectionalLight,
  GridHelper,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
  type LineBasicMaterial,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Packet } from '../api/packet';
import type { CameraInfo, Pose, SceneIndex } from '../api/types';
import { CloudModel } from './cloud';
import { Frustum } from './frustum';
import { place, RobotModel } from './robot';
import { TargetLayer } from './targets';

export type ScenePart = 'robot' | 'cloud' | 'camera' | 'targets';

const up = new Vector3(0, 0, 1);
const overviewFov = 42; // degrees of the height

export class SceneView {
  readonly cloud = new CloudModel();
  readonly targets: TargetLayer;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly eye = new PerspectiveCamera(overviewFov, 1, 0.02, 60);
  private readonly controls: OrbitControls;
  private readonly frustum = new Frustum();
  private readonly hidden = new Set<ScenePart>();
  private grid = new GridHelper(4, 20);
  private robot: RobotModel | null = null;
  private camera: CameraInfo | null = null;
  private cameraPose: Pose | null = null;
  private framed = false;
  private pending = 0;

  /**
   * @param isSlow the CPU draws: without smooth edges then
   * @throws Error where the browser has no WebGL
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    names: HTMLElement,
    isSlow: boolean,
  ) {
    const isDense = window.devicePixelRatio >= 2;
    this.renderer = new WebGLRenderer({ canvas, antialias: !isDense && !isSlow });
    this.renderer.setPixelRatio(isSlow ? 1 : Math.min(window.devicePixelRatio, 2));
    this.eye.up.copy(up);
    this.eye.position.set(1.8, -1.6, 1.4);
    this.controls = new OrbitControls(this.eye, canvas);
    this.controls.target.set(0, 0, 0.4);
    this.controls.addEventListener('change', () => this.invalidate());
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(2, -3, 5);
    this.scene.add(new AmbientLight(0xffffff, 0.5), new HemisphereLight(0xffffff, 0x8a8f98, 1.2));
    this.scene.add(sun, this.cloud.points, this.frustum.lines);
    this.targets = new TargetLayer(names);
    this.scene.add(this.targets.root);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
  }

  setTheme(background: string, line: string, ink: string): void {
    this.scene.background = new Color(background);
    this.scene.remove(this.grid);
    this.grid.dispose();
    this.grid = new GridHelper(4, 20, line, line);
    this.grid.rotation.x = Math.PI / 2;
    (this.grid.material as LineBasicMaterial).transparent = true;
    (this.grid.material as LineBasicMaterial).opacity = 0.55;
    this.scene.add(this.grid);
    this.frustum.setColor(new Color(ink));
    this.targets.setInk(new Color(ink));
    this.invalidate();
  }

  /** @param robot null: none, until the next one is there */
  setRobot(robot: { readonly index: SceneIndex; readonly data: ArrayBuffer } | null): void {
    if (this.robot) {
      this.scene.remove(this.robot.root);
      this.robot.dispose();
    }
    this.robot = robot && new RobotModel(robot.index, robot.data);
    if (this.robot) this.scene.add(this.robot.root);
    this.invalidate();
  }

  setCamera(camera: CameraInfo | null): void {
    this.camera = camera;
    if (camera) this.frustum.setCamera(camera, 0.35);
  }

  show(packet: Packet, step: number, chosen: string | null): void {
    this.cameraPose = packet.cameraPose;
    this.robot?.setPoses(packet.linkPoses);
    if (this.robot) this.robot.root.visible = !this.hidden.has('robot');
    place(this.frustum.lines, this.hidden.has('camera') || !this.camera ? null : packet.cameraPose);
    const cloud = this.hidden.has('cloud') ? undefined : packet.cloud;
    const metresPerDepth = this.camera ? step / this.camera.fx : 0.005;
    const points = this.cloud.update(cloud, packet.cameraPose, metresPerDepth);
    this.canvas.dataset['points'] = String(points);
    this.targets.show(this.hidden.has('targets') ? [] : packet.frame.targets, chosen);
    const target = packet.frame.targets.find((one) => one.name === chosen);
    const blame = (target?.blame ?? []).map((one) => [one.link, one.fraction] as const);
    this.robot?.setBlame(new Map(blame));
    const isPosed = packet.linkPoses.some((pose) => pose !== null);
    if (!this.framed && isPosed) this.framed = this.frameAll();
    this.invalidate();
  }

  /** The caller shows the frame again. */
  setShown(part: ScenePart, shown: boolean): void {
    if (shown) this.hidden.delete(part);
    else this.hidden.add(part);
  }

  /** A view beside the camera's, of robot and camera; false: there is nothing to look at yet. */
  frameAll(): boolean {
    const box = new Box3();
    if (this.robot) box.expandByObject(this.robot.root);
    if (box.isEmpty()) return false;
    const centre = box.getCenter(new Vector3());
    const radius = Math.max(0.5 * box.getSize(new Vector3()).length(), 0.15);
    const towards = new Vector3(1, -1, 0);
    if (this.cameraPose) towards.set(this.cameraPose[0], this.cameraPose[1], 0).sub(centre).setZ(0);
    if (towards.lengthSq() < 1e-6) towards.set(1, -1, 0);
    towards.normalize().applyAxisAngle(up, -0.6).setZ(0.55).normalize();
    const narrow = Math.min(this.eye.aspect, 1);
    this.setFov(overviewFov);
    const distance = (1.75 * radius) / Math.sin((this.eye.fov * Math.PI) / 360) / narrow;
    this.lookAt(centre, centre.clone().addScaledVector(towards, distance));
    return true;
  }

  /** The camera's own view, as nearly as an upright view can be. */
  frameCamera(): void {
    if (!this.cameraPose || !this.camera) return;
    const lines = this.frustum.lines;
    const forward = new Vector3(0, 0, 1).applyQuaternion(lines.quaternion);
    const at = new Vector3(...this.cameraPose.slice(0, 3));
    const { width, height, fx, fy } = this.camera;
    const half = Math.max(height / fy, width / fx / this.eye.aspect) / 2;
    this.setFov((360 / Math.PI) * Math.atan(half));
    this.lookAt(at.clone().addScaledVector(forward, 1.5), at);
  }

  /** @param degrees of the height */
  private setFov(degrees: number): void {
    this.eye.fov = degrees;
    this.eye.updateProjectionMatrix();
  }

  private lookAt(target: Vector3, eye: Vector3): void {
    this.controls.target.copy(target);
    this.eye.position.copy(eye);
    this.controls.update();
    this.invalidate();
  }

  invalidate(): void {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.renderer.render(this.scene, this.eye);
      this.targets.placeNames(this.eye, this.canvas);
    });
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement ?? this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.eye.aspect = clientWidth / clientHeight;
    this.eye.updateProjectionMatrix();
    this.cloud.setPixelsHigh(clientHeight * this.renderer.getPixelRatio());
    this.invalidate();
  }
}
