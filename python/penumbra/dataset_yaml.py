# SPDX-License-Identifier: Apache-2.0
"""Reads a dataset.yaml: the robot, the camera and the layout of a data set."""

from __future__ import annotations

import difflib
import importlib
import pathlib
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from penumbra import (
    Camera,
    Geometry,
    InputError,
    Intrinsics,
    LabelRule,
    PipelineConfig,
    Robot,
    RobotOptions,
    read_camera_info,
    read_pose_csv,
)

degree = float(np.pi / 180)


class Layout(NamedTuple):
    """Where the arrays of an episode are. {camera} stands for the camera's name."""

    columns: tuple[str, ...]  # of joint positions, T x n each
    episodes: str = ""  # the groups that are episodes; of dictionaries, the key of their number
    color: str = ""
    depth: str = ""  # in the file; or files or a video next to it, as depth/%06d.png
    pose: str = ""  # of the camera in its parent: 4 x 4, or x, y, z, roll, pitch, yaw


class JointColumn(NamedTuple):
    """A joint's position: scale * column + offset, or the offset alone."""

    joint: str
    column: Optional[int] = None
    scale: float = 1.0
    offset: float = 0.0


class CloudOptions(NamedTuple):
    """How points without the robot are made."""

    frame: str = ""  # a link; "": the camera
    crop: Optional[tuple[tuple[float, ...], tuple[float, ...]]] = None  # two corners of a box
    voxel: float = 0.0  # metres: one point of each cube; 0: all points
    points: int = 1024  # chosen of those, each the farthest from the chosen ones
    robot_points: int = 0  # of the model's surface


LAYOUTS = {
    "aloha": Layout(("observations/qpos",), color="observations/images/{camera}"),
    "droid": Layout(
        ("observation/robot_state/joint_positions", "observation/robot_state/gripper_position"),
        pose="observation/camera_extrinsics/{camera}",
    ),
    "lerobot": Layout(("observation.state",), "episode_index", "observation.images.{camera}"),
    "robomimic": Layout(
        ("obs/robot0_joint_pos", "obs/robot0_gripper_qpos"),
        "data/*",
        "obs/{camera}_image",
        "obs/{camera}_depth",
    ),
    "robomind": Layout(
        ("puppet/joint_position",),
        color="observations/rgb_images/{camera}",
        depth="observations/depth_images/{camera}",
    ),
}

CAMERA_KEYS = (
    "name",
    "info",
    "rectified",
    "width",
    "height",
    "fx",
    "fy",
    "cx",
    "cy",
    "parent",
    "pose",
    "sensor",
    "depth_scale",
)
ROBOT_KEYS = ("urdf", "packages", "geometry", "geometry_fallback", "ignore_links")


def read(file: pathlib.Path) -> dict[str, Any]:
    """Returns the arguments of Dataset. Raises InputError that names the key."""
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: cannot be read: {error}") from None
    yaml = needed("yaml", "python3-yaml")
    try:
        root = _only(yaml.safe_load(text), "", ("robot", "camera", "layout", "joints", "clouds"))
        return _arguments(root, file.parent)
    except yaml.YAMLError as error:
        raise InputError(f"{file}: {error}") from None
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"{file}: a value has the wrong form: {error}") from None


def _arguments(root: dict[str, Any], folder: pathlib.Path) -> dict[str, Any]:
    camera = _only(root.get("camera"), "camera", CAMERA_KEYS)
    layout = _layout(root.get("layout"))
    pose = camera.get("pose")
    if pose is None and not layout.pose:
        raise InputError("camera.pose: is needed: four rows of four numbers, or a file of them")
    if layout.pose and "{camera}" in layout.pose and pose is None and "name" not in camera:
        raise InputError("camera.name: is needed for the camera's pose in the episodes")
    read_pose = None
    if pose is not None:
        layout = layout._replace(pose="")
        read_pose = read_pose_csv(folder / pose) if isinstance(pose, str) else poses_of(pose, 0)
    placed = {"parent": _of(camera, "camera", "parent"), "T_parent_camera": read_pose}
    joints = root.get("joints")
    return {
        "robot": _robot(_only(root.get("robot"), "robot", ROBOT_KEYS), folder),
        "camera": _camera(camera, folder).replace(**placed),
        "config": PipelineConfig(rule=LabelRule.for_sensor(camera.get("sensor", "realsense_d4xx"))),
        "joints": None if joints is None else [_joint(entry, i) for i, entry in enumerate(joints)],
        "layout": layout,
        "camera_name": str(camera.get("name", "")),
        "depth_scale": camera.get("depth_scale"),
        "clouds": CloudOptions(**_only(root.get("clouds") or {}, "clouds", CloudOptions._fields)),
    }


def _robot(node: dict[str, Any], folder: pathlib.Path) -> Robot:
    options = RobotOptions(
        packages={name: folder / at for name, at in node.get("packages", {}).items()},
        geometry=Geometry(node["geometry"]) if "geometry" in node else None,
        geometry_fallback=node.get("geometry_fallback", False),
        ignore_links=node.get("ignore_links", []),
    )
    return Robot.load(folder / _of(node, "robot", "urdf"), options)


def _camera(node: dict[str, Any], folder: pathlib.Path) -> Camera:
    if "info" in node:
        return read_camera_info(folder / node["info"], rectified=node.get("rectified", False))
    size = (int(_of(node, "camera", key)) for key in ("width", "height"))
    lens = (float(_of(node, "camera", key)) for key in ("fx", "fy", "cx", "cy"))
    return Camera(Intrinsics(*size, *lens))


def _layout(node: Any) -> Layout:
    if isinstance(node, str) and node in LAYOUTS:
        return LAYOUTS[node]
    if not isinstance(node, dict):
        raise InputError(
            f"layout: expected one of {', '.join(LAYOUTS)}, or your own paths "
            f"({', '.join(Layout._fields)}); got {node}"
        )
    keys = _only(node, "layout", Layout._fields)
    columns = _of(keys, "layout", "columns")
    rest = {key: str(value) for key, value in keys.items() if key != "columns"}
    return Layout((columns,) if isinstance(columns, str) else tuple(columns), **rest)


def _joint(node: Any, place: int) -> JointColumn:
    """A name alone is the joint of the column at its place."""
    if isinstance(node, str):
        return JointColumn(node, place)
    where = f"joints[{place}]"
    keys = _only(node, where, ("joint", "column", "scale", "offset", "unit", "value"))
    name = str(_of(keys, where, "joint"))
    if "value" in keys:
        _only(keys, f"{where} with a value", ("joint", "value"))
        return JointColumn(name, None, offset=float(keys["value"]))
    unit = keys.get("unit", "radians")
    if unit not in ("radians", "degrees", "metres"):
        raise InputError(f"{where}: unit: expected degrees, radians or metres; got {unit}")
    column = int(_of(keys, where, "column"))
    if column < 0:
        raise InputError(f"{where}: column: expected a number from 0; got {column}")
    factor = degree if unit == "degrees" else 1.0
    return JointColumn(
        name, column, factor * float(keys.get("scale", 1)), factor * float(keys.get("offset", 0))
    )


def needed(name: str, package: str) -> Any:
    """Imports a module that only data sets need."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise InputError(f"needs {name}: install {package}, or penumbra[datasets]") from None


def poses_of(given: NDArray[Any], frames: int) -> NDArray[np.float64]:
    """Returns 4 x 4 or T x 4 x 4, of such or of x, y, z and angles about the fixed axes."""
    poses = np.asarray(given, float)
    if poses.shape[-1:] == (6,):
        sx, sy, sz = np.moveaxis(np.sin(poses[..., 3:]), -1, 0)
        cx, cy, cz = np.moveaxis(np.cos(poses[..., 3:]), -1, 0)
        rows = [
            [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx, poses[..., 0]],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx, poses[..., 1]],
            [-sy, cy * sx, cy * cx, poses[..., 2]],
            [0 * sx, 0 * sx, 0 * sx, 0 * sx + 1],
        ]
        poses = np.moveaxis(np.array(rows), (0, 1), (-2, -1))
    if poses.shape not in ((4, 4), (frames, 4, 4)):
        raise InputError(
            f"camera pose: expected 4 x 4 or 6 numbers, for all {frames} frames or each "
            f"of them; got shape {np.shape(given)}"
        )
    turn = poses[..., :3, :3]
    is_rigid = np.allclose(turn @ np.swapaxes(turn, -1, -2), np.eye(3), atol=1e-3)
    if not is_rigid or not np.all(np.linalg.det(turn) > 0) or not np.all(np.isfinite(poses)):
        raise InputError("camera pose: is not rigid")
    return poses


def _of(node: dict[str, Any], where: str, key: str) -> Any:
    if node.get(key) is None:
        raise InputError(f"{where}: {key} is needed")
    return node[key]


def _only(node: Any, where: str, allowed: tuple[str, ...]) -> dict[str, Any]:
    """Returns the node, which has no other keys."""
    place = f"{where}: " if where else ""
    if not isinstance(node, dict):
        raise InputError(f"{place}expected keys ({', '.join(allowed)}); got {node}")
    for key in node:
        if key not in allowed:
            near = difflib.get_close_matches(str(key), allowed, 1)
            hint = f"; did you mean {near[0]}?" if near else f"; allowed are {', '.join(allowed)}"
            raise InputError(f"{place}unknown key {key}{hint}")
    return node
