# SPDX-License-Identifier: Apache-2.0
"""A part is picked up and put down: python3 pick_and_place.py

attach_target() when the gripper closes, nothing when it opens. The depth images are rendered.
"""
import pathlib
from typing import List

import numpy as np
from numpy.typing import NDArray

import penumbra

CLOSES, OPENS, FRAMES = 30, 90, 120  # when the gripper does
SIZE = np.array([0.12, 0.10, 0.30])  # metres
FOLDER = pathlib.Path(__file__).parent.parent / "arm_over_table" / "arm_description"


def box(size: NDArray[np.float64]) -> penumbra.TriangleMesh:
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return penumbra.TriangleMesh((corners * size / 2).astype(np.float32), np.array(faces, np.uint32))


def camera_pose() -> NDArray[np.float64]:
    """T_base_camera: looks at the arm from the side, with z up."""
    eye, middle = np.array([1.7, -1.2, 1.1]), np.array([0.4, 0.0, 0.4])
    z = (middle - eye) / np.linalg.norm(middle - eye)
    x = np.cross(z, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :4] = np.stack([x, np.cross(z, x), z, eye], axis=1)
    return T


def joints_at(frame: int, robot: penumbra.Robot) -> NDArray[np.float64]:
    """The arm comes, swings to the side with the part, and leaves."""
    positions = robot.rest_positions().copy()
    positions[robot.find_variable("shoulder_lift")] = 0.6
    positions[robot.find_variable("elbow")] = np.interp(frame, [0, CLOSES, OPENS, FRAMES], [0.6, 1.2, 1.2, 0.6])
    positions[robot.find_variable("shoulder_pan")] = np.interp(frame, [CLOSES, OPENS], [0.5, -0.5])
    return positions


robot = penumbra.Robot.load(FOLDER / "arm.urdf", penumbra.RobotOptions(packages={"arm_description": FOLDER}))
intrinsics = penumbra.Intrinsics(640, 480, 610.0, 610.0, 322.5, 236.0)
session = penumbra.Session(robot, penumbra.Camera(intrinsics, T_parent_camera=camera_pose()))
world = penumbra.Renderer(penumbra.Backend.cpu, intrinsics, [*robot.bodies, penumbra.Body("part", [box(SIZE)])])
gripper = robot.find_link("gripper")
in_gripper = np.eye(4)
in_gripper[2, 3] = 0.22
part = robot.forward_kinematics(joints_at(CLOSES, robot))[gripper] @ in_gripper  # T_base_part

attached: List[penumbra.AttachedBody] = []
for i in range(FRAMES):
    joints = joints_at(i, robot)
    links = robot.forward_kinematics(joints)
    if CLOSES < i <= OPENS:
        part = links[gripper] @ in_gripper
    depth = world.render(np.linalg.inv(camera_pose()) @ np.concatenate([links, [part]])).depth
    target = penumbra.Target("part", penumbra.BoxTarget(part, SIZE, frame=""), handling=penumbra.PoseTrackerConfig())
    report = session.process(penumbra.Frame(
        np.where(depth > 0, depth, np.float32(3)), penumbra.RobotPose(positions=joints, attached=attached),
        stamp=i * 33_000_000, targets=[target]))
    found = report.targets[0]
    if i % 15 == 0:
        line = f"frame {i}: {found.verdict.value} {found.reason}"
        if found.handled and found.handled.position is not None:
            off = float(np.linalg.norm(found.handled.position - part[:3, 3]))
            line += f", {found.handled.source.value}, {1000 * off:.3f} mm off"
        print(line)
    if i == CLOSES:
        attached = [session.attach_target(target, "gripper")]
    if i == OPENS:
        attached = []
