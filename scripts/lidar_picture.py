#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/images/lidar.png: a simulated scan of the shipped arm, with the robot and without it.

    scripts/lidar_picture.py [PNG]

Needs the penumbra module in PYTHONPATH, python3-numpy and python3-pil.
"""
import pathlib
import sys

import numpy as np
from PIL import Image

import penumbra

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "examples/arm_over_table/arm_description"
POSITIONS = [0.5, 0.2, 0.9, 0.3, 0.4, 0.0, 0.02]  # of the arm
LIDAR = np.array([1.0, -0.75, 0.75])  # in the arm's base, z up
BEAMS, COLUMNS, HALF_HEIGHT = 128, 1500, np.deg2rad(34)
NOISE, BEAM = 0.01, 0.003  # metres; radians, half of the beam's width
ROOM = np.array([[-1.3, -1.7, 0.0], [2.2, 1.6, 1.9]])  # the arm stands on its floor
BOXES = [([-0.75, 0.35, 0.0], [-0.3, 0.9, 0.45]), ([-0.9, -0.9, 0.0], [-0.5, -0.45, 0.8])]
EYE, TARGET, FOCAL = np.array([2.3, -1.55, 1.75]), np.array([0.0, 0.05, 0.42]), 1.35  # of the view
SIZE = (480, 380)  # of each half
PIXELS = 2048  # of the image that gives the arm's ranges
BACKGROUND = 24


def looking_at(eye, target):
    """The rotation to a camera's frame: x right, y down, z forward."""
    z = (target - eye) / np.linalg.norm(target - eye)
    x = np.cross(z, [0, 0, 1])
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def box_ranges(rays, low, high, inside):
    """Ranges along rays from the lidar to a box, or to the walls of a room around it."""
    with np.errstate(divide="ignore"):
        near, far = np.sort([(low - LIDAR) / rays, (high - LIDAR) / rays], axis=0)
    first, last = near.max(axis=1), far.min(axis=1)
    if inside:
        return last
    return np.where((first < last) & (first > 0), first, np.inf)


def arm_ranges(rays, bodies, T_base_link):
    R = looking_at(LIDAR, np.array([0.0, 0.0, 0.5]))
    T_camera_base = np.eye(4)
    T_camera_base[:3, :3], T_camera_base[:3, 3] = R, -R @ LIDAR
    f = c = PIXELS / 2
    renderer = penumbra.Renderer(
        penumbra.Backend.cpu, penumbra.Intrinsics(PIXELS, PIXELS, f, f, c, c), bodies)
    depth = renderer.render(T_camera_base @ T_base_link).depth
    x, y, z = (rays @ R.T).T
    front = z > 0.1
    u, v = (np.where(front, f * a / np.where(front, z, 1) + c, -1) for a in (x, y))
    seen = front & (u >= 0) & (u < PIXELS - 1) & (v >= 0) & (v < PIXELS - 1)
    at = depth[np.where(seen, v, 0).astype(int), np.where(seen, u, 0).astype(int)]
    return np.where(seen & (at > 0), at / np.where(front, z, 1), np.inf)


def scan(bodies, T_base_link, random):
    turn, height = np.meshgrid(np.linspace(0.001, 6.283, COLUMNS),
                               np.linspace(-HALF_HEIGHT, HALF_HEIGHT, BEAMS))
    turn, height = turn.ravel(), height.ravel()

    def ranges(turn, height):
        rays = np.stack([np.cos(turn) * np.cos(height), np.sin(turn) * np.cos(height),
                         np.sin(height)], axis=1)
        room = box_ranges(rays, *ROOM, inside=True)
        for low, high in BOXES:
            room = np.minimum(room, box_ranges(rays, np.array(low), np.array(high), inside=False))
        return rays, np.minimum(room, arm_ranges(rays, bodies, T_base_link))

    rays, first = ranges(turn, height)
    # The beam has a width: a part of it may meet something else.
    second = ranges(turn + random.uniform(-BEAM, BEAM, turn.size),
                    height + random.uniform(-BEAM, BEAM, turn.size))[1]
    share = random.uniform(0, 1, turn.size)
    r = np.where(abs(first - second) > 0.02, share * first + (1 - share) * second, first)
    r += random.normal(0, NOISE, r.size)
    return (rays * r[:, None]).astype(np.float32)


def draw(points, colors):
    seen = (points - EYE) @ looking_at(EYE, TARGET).T
    order = np.argsort(-seen[:, 2])
    seen, colors = seen[order], colors[order]
    scale = FOCAL * SIZE[0] / seen[:, 2]
    u = (seen[:, 0] * scale + SIZE[0] / 2).astype(int)
    v = (seen[:, 1] * scale + SIZE[1] / 2).astype(int)
    image = np.full((SIZE[1], SIZE[0], 3), BACKGROUND, np.uint8)
    for du, dv in ((0, 0), (1, 0)):
        inside = (u + du >= 0) & (u + du < SIZE[0]) & (v + dv >= 0) & (v + dv < SIZE[1])
        image[v[inside] + dv, u[inside] + du] = colors[inside]
    return image


def main():
    png = sys.argv[1] if len(sys.argv) > 1 else ROOT / "docs/images/lidar.png"
    robot = penumbra.Robot.load(
        FOLDER / "arm.urdf", penumbra.RobotOptions(packages={"arm_description": FOLDER}))
    T_base_link = robot.forward_kinematics(POSITIONS)
    points = scan(robot.bodies, T_base_link, np.random.default_rng(1))
    T_lidar_link = T_base_link.copy()
    T_lidar_link[:, :3, 3] -= LIDAR
    labels = penumbra.CloudLabeller(robot.bodies).label(points, T_lidar_link, origin=[0, 0, 0]).labels
    stays = np.isin(labels, [penumbra.Label.clear, penumbra.Label.front])
    in_base = points + LIDAR
    shade = np.clip(90 + 70 * in_base[:, 2], 60, 230)
    grey = np.stack([shade, shade + 10, shade + 20], axis=1).clip(0, 255).astype(np.uint8)
    colors = grey.copy()
    colors[np.isin(labels, [penumbra.Label.occluded, penumbra.Label.beyond])] = (235, 120, 40)
    colors[labels == penumbra.Label.fringe] = (240, 210, 60)
    shown = in_base[:, 2] < ROOM[1, 2] - 0.05  # no ceiling
    shown &= (in_base[:, 0] < 2.1) & (in_base[:, 1] > -1.6)  # nor the walls before the view
    halves = [draw(in_base[shown], colors[shown]), draw(in_base[shown & stays], grey[shown & stays])]
    gap = np.full((SIZE[1], 8, 3), 255, np.uint8)
    Image.fromarray(np.hstack([halves[0], gap, halves[1]])).quantize(128).save(png, optimize=True)
    print(f"{png}: {len(points)} points, {int((~stays).sum())} of them removed")


main()
