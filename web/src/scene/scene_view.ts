// SPDX-License-Identifier: Apache-2.0
// The 3-D scene in the root link's frame: robot, camera, cloud, targets. It is drawn only after a
// change.
import {
  AmbientLight,
  AxesHelper,
  Box3,
  Color,
  DirectionalLight,
  GridHelper,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Packet } from '../api/packet';
import type { CameraInfo, Pose, SceneIndex, Vec3 } from '../api/types';
import { CloudModel } from './cloud';
import { Frustum } from './frustum';
import { applyPose, RobotModel } from './robot';
import { TargetLayer } from './targets';

export type ScenePart = 'robot' | 'cloud' | 'camera' | 'targets';

const up = new Vector3(0, 0, 1);
const overviewFov = 42; // degrees, vertical
const frustumLength = 0.35; // metres
const softwareNames = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Returns whether the CPU renders WebGL: scenes then have fewer samples and points. */
export function isSoftwareGl(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl?.getExtension('WEBGL_debug_renderer_info');
  const renderer: unknown = names ? gl?.getParameter(names.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return softwareNames.test(String(renderer));
}

/** One of several cameras; no pose: it is not known. */
interface PlacedCamera {
  readonly frustum: Frustum;
  pose: Pose | null;
}

export class SceneView {
  readonly cloud = new CloudModel();
  /** Parts that the user hides; the caller shows the frame again after a change. */
  readonly hidden = new Set<ScenePart>();
  private readonly targets: TargetLayer;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly eye = new PerspectiveCamera(overviewFov, 1, 0.02, 60);
  private readonly controls: OrbitControls;
  private readonly frustum = new Frustum();
  private readonly cameras = new Map<string, PlacedCamera>(); // if there are several
  private readonly axes = new AxesHelper(0.25); // of a sensor without images
  private readonly grid = new GridHelper(4, 20, '#fff', '#fff');
  private robot: RobotModel | null = null;
  private camera: CameraInfo | null = null;
  private cameraPose: Pose | null = null;
  private hasOverview = false;
  private pending = 0;
  points = 0; // of the displayed cloud

  /**
   * @param isSlow disables antialiasing and high pixel densities
   * @throws Error if the browser has no WebGL
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
    this.targets = new TargetLayer(names);
    this.grid.rotation.x = Math.PI / 2;
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.1;
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(2, -3, 5);
    this.scene.add(
      new AmbientLight(0xffffff, 0.5),
      new HemisphereLight(0xffffff, 0x8a8f98, 1.2),
      sun,
      this.grid,
      this.cloud.points,
      this.frustum.lines,
      this.axes,
      this.targets.root,
    );
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
  }

  /** Takes the colours of the background and of lines from the canvas's style. */
  updateTheme(): void {
    const { backgroundColor, color } = getComputedStyle(this.canvas);
    this.scene.background = new Color(backgroundColor);
    const others = [...this.cameras.values()].map(({ frustum }) => frustum);
    const frusta = [this.frustum, ...others].map(({ lines }) => lines.material);
    for (const material of [this.grid.material, ...frusta]) material.color.set(color);
    this.targets.setLineColor(new Color(color));
    this.invalidate();
  }

  /** @param robot null: removes the robot */
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
    if (camera) this.frustum.setCamera(camera, frustumLength);
  }

  /** Shows one of several cameras at its place; null: it is not known. */
  setPlace(name: string, camera: CameraInfo | null, pose: Pose | null): void {
    let placed = this.cameras.get(name);
    if (!placed) {
      placed = { frustum: new Frustum(), pose };
      this.cameras.set(name, placed);
      this.scene.add(placed.frustum.lines);
      this.updateTheme();
    }
    if (camera) placed.frustum.setCamera(camera, frustumLength);
    placed.pose = camera && pose;
    this.showCameras();
    this.invalidate();
  }

  private showCameras(): void {
    const places = new Map<string, Vec3>();
    for (const [name, { frustum, pose }] of this.cameras) {
      const shown = this.hidden.has('camera') ? null : pose;
      applyPose(frustum.lines, shown);
      if (shown) places.set(name, [shown[0], shown[1], shown[2]]);
    }
    this.targets.namePlaces(places);
  }

  /** @param step the cloud has every step-th pixel */
  show(packet: Packet, step: number, selected: string | null): void {
    const { camera_pose: cameraPose, link_poses: linkPoses, frame } = packet;
    const isShown = (part: ScenePart): boolean => !this.hidden.has(part);
    this.cameraPose = cameraPose;
    const shownPose = isShown('camera') ? cameraPose : null;
    applyPose(this.frustum.lines, this.camera ? shownPose : null);
    applyPose(this.axes, this.cloud.uniforms.isScan.value ? shownPose : null);
    if (this.camera) this.cloud.uniforms.metresPerDepth.value = step / this.camera.fx;
    this.points = this.cloud.update(isShown('cloud') ? packet.cloud : undefined, cameraPose);
    this.canvas.dataset['points'] = String(this.points);
    this.showCameras();
    this.targets.show(isShown('targets') ? frame.targets : [], selected);
    if (this.robot) {
      const target = frame.targets.find(({ name }) => name === selected);
      this.robot.root.visible = isShown('robot');
      this.robot.setPoses(linkPoses);
      this.robot.setBlame(new Map(target?.blame?.map(({ link, fraction }) => [link, fraction])));
    }
    if (!this.hasOverview && linkPoses.some((pose) => pose !== null))
      this.hasOverview = this.showOverview();
    this.invalidate();
  }

  /** Looks at the whole robot from next to the camera; returns false without a robot. */
  showOverview(): boolean {
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

  /** Looks from the camera; the view stays upright if the camera is not. */
  showCameraView(): void {
    if (!this.cameraPose || !this.camera) return;
    const forward = new Vector3(0, 0, 1).applyQuaternion(this.frustum.lines.quaternion);
    const at = new Vector3(...this.cameraPose.slice(0, 3));
    const { width, height, fx, fy } = this.camera;
    const half = Math.max(height / fy, width / fx / this.eye.aspect) / 2;
    this.setFov((360 / Math.PI) * Math.atan(half));
    this.lookAt(at.clone().addScaledVector(forward, 1.5), at);
  }

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

  /** Draws the scene in the browser's next frame. */
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
    this.cloud.uniforms.pixelsHigh.value = clientHeight * this.renderer.getPixelRatio();
    this.invalidate();
  }
}
