# SPDX-License-Identifier: Apache-2.0
"""Reads a dataset.yaml: the robot, the camera and the layout of a data set."""

from __future__ import annotations

import difflib
import importlib
import pathlib
from collections.abc import Callable
from typing import Any, NamedTuple, Optional, TypeVar

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
T = TypeVar("T")


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


class Recorded(NamedTuple):
    """What data sets record of a robot: an entry of robots.yaml, or of your own file."""

    name: str
    fits: tuple[str, ...]  # public descriptions
    columns: tuple[str, ...]


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
ROBOT_KEYS = (
    "name",
    "urdf",
    "packages",
    "arguments",
    "geometry",
    "geometry_fallback",
    "ignore_links",
)
JOINT_KEYS = ("joint", "column", "scale", "offset", "unit", "value")
ROBOTS = pathlib.Path(__file__).with_name("robots.yaml")


def read(file: pathlib.Path, robot: str = "", urdf: str = "") -> dict[str, Any]:
    """Returns the arguments of Dataset. Raises InputError that names the key.

    robot, urdf: in place of the file's robot.name and robot.urdf, "": as there.
    """

    def arguments(root: Any) -> dict[str, Any]:
        keys = _only(root, "", ("robot", "camera", "layout", "joints", "clouds", "tracks"))
        given = {key: of for key, of in (("name", robot), ("urdf", urdf)) if of}
        if given:
            keys["robot"] = {**(keys.get("robot") or {}), **given}
        return _arguments(keys, file.parent)

    return _parsed(file, arguments)


def _parsed(file: pathlib.Path, use: Callable[[Any], T]) -> T:
    """Returns what is made of a YAML file. Raises InputError that names the file."""
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: cannot be read: {error}") from None
    yaml = needed("yaml", "python3-yaml")
    try:
        return use(yaml.safe_load(text))
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
    robot = _only(root.get("robot"), "robot", ROBOT_KEYS)
    recorded, joints = None, root.get("joints")
    if "name" in robot:
        recorded, known, xacro = _recorded(str(robot["name"]), folder)
        if str(_of(robot, "robot", "urdf")).endswith(".xacro"):
            robot["arguments"] = {**xacro, **robot.get("arguments", {})}
        joints = [*known, *_joints(joints or [], recorded)]
    elif joints is not None:
        joints = _joints(joints, None)
    return {
        "robot": _robot(robot, folder),
        "camera": _camera(camera, folder).replace(**placed),
        "config": PipelineConfig(rule=LabelRule.for_sensor(camera.get("sensor", "realsense_d4xx"))),
        "joints": joints,
        "recorded": recorded,
        "layout": layout,
        "camera_name": str(camera.get("name", "")),
        "depth_scale": camera.get("depth_scale"),
        "clouds": CloudOptions(**_only(root.get("clouds") or {}, "clouds", CloudOptions._fields)),
        **{key: root[key] for key in ("tracks",) if key in root},
    }


Mapping = tuple[Recorded, list[JointColumn], dict[str, Any]]


def _recorded(name: str, folder: pathlib.Path) -> Mapping:
    """Returns a robot of robots.yaml or of a file, its joints and its xacro arguments."""

    def entry(node: Any) -> Mapping:
        keys = _only(node, "", ("data", "fits", "arguments", "columns"))
        columns = _of(keys, "", "columns")
        if not isinstance(columns, dict):
            raise InputError(f"columns: expected NAME: JOINT of each column; got {columns}")
        joints = [
            _joint(of if isinstance(of, str) else {"column": i, **of}, i, f"column {key}")
            for i, (key, entries) in enumerate(columns.items())
            for of in (entries if isinstance(entries, list) else [entries])
        ]
        recorded = Recorded(name, tuple(keys.get("fits", ())), tuple(map(str, columns)))
        return recorded, joints, keys.get("arguments", {})

    if name.endswith((".yaml", ".yml")):
        return _parsed(folder / name, entry)
    known: dict[str, Any] = _parsed(ROBOTS, dict)
    if name not in known:
        near = difflib.get_close_matches(name, known, 1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise InputError(
            f"robot.name: {name} is not known; {hint}Known are {', '.join(known)}, "
            "or give a .yaml file of your own"
        )
    return entry(known[name])


def _joints(nodes: Any, recorded: Optional[Recorded]) -> list[JointColumn]:
    """Reads dataset.yaml's entries. Those of a robot with a name may name their column."""
    joints = []
    for place, node in enumerate(nodes):
        where = f"joints[{place}]"
        if recorded:
            column = _only(node, where, JOINT_KEYS).get("column")
            if isinstance(column, str):
                if column not in recorded.columns:
                    raise InputError(
                        f"{where}: column {column} is not one of {', '.join(recorded.columns)}"
                    )
                node = {**node, "column": recorded.columns.index(column)}
        joints.append(_joint(node, place, where))
    return joints


def _robot(node: dict[str, Any], folder: pathlib.Path) -> Robot:
    options = RobotOptions(
        packages={name: folder / at for name, at in node.get("packages", {}).items()},
        arguments={name: str(value) for name, value in node.get("arguments", {}).items()},
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


def _joint(node: Any, place: int, where: str) -> JointColumn:
    """A name alone is the joint of the column at its place."""
    if isinstance(node, str):
        return JointColumn(node, place)
    keys = _only(node, where, JOINT_KEYS)
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
        raise InputError(f"{where}: {key} is needed" if where else f"{key} is needed")
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
