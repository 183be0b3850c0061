# SPDX-License-Identifier: Apache-2.0
"""One camera in many calibrations: where it is, and when it moved."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray


def of(records: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Returns the poses of penumbra.batch.calibrate().

    Takes an input's pose for the one before if chance, or what does not matter, explains how
    they differ.
    """
    expected_error = np.diag([math.radians(0.1) ** 2] * 3 + [0.002**2] * 3)  # also the watch's
    most_by_chance = 16.81  # 99 % quantile of chi^2 with 6 degrees
    poses: list[dict[str, Any]] = []
    for record in records:
        T, covariance = np.array(record["T_parent_camera"]), np.array(record["covariance"])
        pose: dict[str, Any] = {"T_parent_camera": T, "covariance": covariance, "inputs": [record["input"]],
                "moved_mm": 0.0, "moved_degrees": 0.0}  # fmt: skip
        if not poses:
            poses.append(pose)
            continue
        last = poses[-1]
        twist = _twist(np.linalg.inv(last["T_parent_camera"]) @ T)
        both = covariance + last["covariance"]
        if twist @ np.linalg.solve(both + expected_error, twist) < most_by_chance:
            gain = last["covariance"] @ np.linalg.inv(both)  # as of a Kalman filter
            last["T_parent_camera"] = last["T_parent_camera"] @ _motion(gain @ twist)
            last["covariance"] = last["covariance"] - gain @ last["covariance"]
            last["inputs"].append(record["input"])
            continue
        pose["moved_mm"] = 1e3 * float(np.linalg.norm(twist[3:]))
        pose["moved_degrees"] = math.degrees(float(np.linalg.norm(twist[:3])))
        poses.append(pose)
    for pose in poses:
        for key in ("T_parent_camera", "covariance"):
            pose[key] = pose[key].tolist()
    return poses


def add_distances(records: Iterable[dict[str, Any]], poses: list[dict[str, Any]]) -> None:
    """Adds to each record how far its camera is from the pose of of() that most inputs have."""
    if not poses:
        return
    most = max(poses, key=lambda pose: len(pose["inputs"]))
    T_inverse = np.linalg.inv(np.array(most["T_parent_camera"]))
    for record in records:
        twist = _twist(T_inverse @ np.array(record["T_parent_camera"]))
        record["camera_off_mm"] = round(1e3 * float(np.linalg.norm(twist[3:])), 1)
        record["camera_off_degrees"] = round(math.degrees(float(np.linalg.norm(twist[:3]))), 2)


def _twist(T: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation vector (rad), then translation (m)."""
    turn = np.array([T[2, 1] - T[1, 2], T[0, 2] - T[2, 0], T[1, 0] - T[0, 1]]) / 2
    sine, cosine = float(np.linalg.norm(turn)), (np.trace(T[:3, :3]) - 1) / 2
    scale = math.atan2(sine, cosine) / sine if sine > 0 else 1.0
    return np.concatenate([scale * turn, T[:3, 3]])


def _motion(twist: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rodrigues's formula."""
    angle = float(np.linalg.norm(twist[:3]))
    x, y, z = twist[:3] / (angle or 1.0)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.eye(4)
    T[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    T[:3, 3] = twist[3:]
    return T


def lines(poses: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Returns a line for each pose of of()."""
    for number, pose in enumerate(poses):
        xyz = ", ".join(f"{row[3]:.5f}" for row in pose["T_parent_camera"][:3])
        moved = f"moved by {pose['moved_mm']:.1f} mm, {pose['moved_degrees']:.2f} degrees"
        since = f": {moved} before {pose['inputs'][0]}" if number > 0 else ""
        yield f"camera at {xyz} in {len(pose['inputs'])} inputs{since}"
