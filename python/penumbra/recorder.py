# SPDX-License-Identifier: Apache-2.0
"""Writes what a program sees as a recording folder (docs/recording.md)."""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Dict, Optional, Type, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from penumbra import (
    Camera,
    Frame,
    FrameStatus,
    Input,
    InputError,
    JointAnswer,
    LabelRule,
    PipelineConfig,
    Robot,
    RobotOptions,
    RobotPose,
    pose_of,
    read_pose_csv,
    write_png,
)
from penumbra import open as open_input

PathLike = Union[str, "os.PathLike[str]"]
Depth = Union["NDArray[np.uint16]", "NDArray[np.float32]"]
Color = NDArray[np.uint8]
Joints = Union[None, RobotPose, JointAnswer, Dict[str, float], ArrayLike]

rule_keys = ("front_min_width", "edge_margin", "fringe_reach", "scene_memory", "beyond_factor")
far_enough = 1e9  # metres: a range in a recording has two finite ends


class Recorder:
    """Writes frames as a recording folder, which `penumbra run`, `view` and `calibrate` read.

    A frame is on disk when add() returns, and recording.yaml when the first one is: a program that
    is killed leaves a recording of its frames so far.

    The recording has the camera, its pose and the rule of the configuration. It names the files of
    the URDF, the packages and the targets, and copies none of them. Not recorded are the targets of
    a detector, attached bodies, and poses that are known otherwise than by joints. Options of the
    commands, which it does not have either, are the configuration's backend, image and fold_beyond
    and the robot's geometry_fallback and allow_missing_meshes.
    """

    def __init__(
        self,
        folder: PathLike,
        robot: Robot,
        camera: Camera,
        config: Optional[PipelineConfig] = None,
        *,
        targets: Optional[PathLike] = None,
    ) -> None:
        """folder: new or empty. robot, camera, config: as of Session; the robot comes from a file.
        targets: a targets.yaml. Raises InputError."""
        config = config or PipelineConfig()
        parent = camera.parent or robot.links[0]
        if camera.T_parent_camera is None:
            raise InputError(
                "camera: its pose is missing; set T_parent_camera, if only to np.eye(4) for "
                "'penumbra calibrate --search'"
            )
        if robot.urdf is None:
            raise InputError("robot: a recording names its URDF file; use Robot.load")
        if robot.find_link(parent) is None:
            raise InputError(f"camera parent '{parent}' is not a link of robot '{robot.name}'")
        if targets is not None and not os.path.isfile(targets):
            raise InputError(f"targets: no file {os.fspath(targets)}")
        self._folder = pathlib.Path(folder)
        self._robot = robot
        self._shape = (camera.intrinsics.height, camera.intrinsics.width)
        self._frames = {"joints": "joint_states.csv", "depth": "depth/%06d.png"}
        self._description: Dict[str, Any] = {
            "robot": {"urdf": os.path.abspath(robot.urdf), **_robot_keys(robot.options)},
            "camera": {
                "info": "camera_info.yaml",
                "parent": parent,
                "pose": "camera_pose.csv",
                **_camera_keys(camera, config.rule),
            },
            "frames": self._frames,
        }
        if targets is not None:
            self._description["targets"] = os.path.abspath(targets)
        self._described: Dict[str, str] = {}  # the frames in recording.yaml
        self._count = 0
        self._has_stamps: Optional[bool] = None
        self._dtype: Optional[np.dtype[Any]] = None  # of depth images
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            if any(self._folder.iterdir()):
                raise InputError(f"{self._folder}: is not empty; choose a new or empty folder")
            _write_pose(self._folder / "camera_pose.csv", camera.T_parent_camera)
            self._write_yaml("camera_info.yaml", _camera_info(camera))
            self._rows = open(self._folder / self._frames["joints"], "x", encoding="utf-8")
        except OSError as error:
            raise InputError(f"{self._folder}: cannot be written: {error.strerror}") from None

    def add(
        self,
        depth: Optional[Depth],
        joints: Joints,
        color: Optional[Color] = None,
        stamp: Optional[int] = None,
    ) -> int:
        """Writes a frame and returns its number.

        depth, stamp: as of Frame; joints: as of pose_of(). All depth images have one dtype, and all frames a stamp
        or none. A frame without depth image or valid positions is recorded as such. color: uint8
        (H, W, 3), red, green, blue, of the depth image's size.

        Raises what Frame, pose_of() and Session.process raise, ValueError for what does not fit the earlier
        frames, and InputError or OSError if it cannot be written.
        """
        frame = Frame(depth, pose_of(self._robot, joints), stamp=stamp)
        is_known = frame.pose.status is FrameStatus.ok and len(frame.pose.positions)
        positions = frame.pose.positions if is_known else None
        self._check(depth, color, frame.stamp)
        number, self._count = self._count, self._count + 1
        parts = []
        if color is not None:
            self._frames["color"] = "color/%06d.png"
            parts.append(self._write_part(self._frames["color"] % number, color))
        if depth is not None:
            self._dtype = depth.dtype
            suffix = ".npy" if depth.dtype == np.float32 else ".png"
            self._frames["depth"] = "depth/%06d" + suffix
            parts.append(self._write_part(self._frames["depth"] % number, depth))
        self._write_row(number, frame.stamp, positions)
        for part in parts:  # so that a frame with half a row has no depth image
            part.replace(part.with_suffix(""))
        if self._frames != self._described:
            self._write_yaml("recording.yaml", self._description)
            self._described = dict(self._frames)
        return number

    def close(self) -> None:
        """Ends the recording. The end of a `with` block does so."""
        self._rows.close()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self,
        kind: Optional[Type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()

    def _check(self, depth: Optional[Depth], color: Optional[Color], stamp: Optional[int]) -> None:
        if self._rows.closed:
            raise ValueError("Recorder.add: the recorder is closed")
        if depth is not None and depth.shape != self._shape:
            raise ValueError(f"depth: expected shape {self._shape}; got {depth.shape}")
        if depth is not None and self._dtype not in (None, depth.dtype):
            raise ValueError(f"depth: expected {self._dtype} as before; got {depth.dtype}")
        shape = (*self._shape, 3)
        if color is not None and not (
            isinstance(color, np.ndarray) and color.dtype == np.uint8 and color.shape == shape
        ):
            raise ValueError(f"color: expected numpy.ndarray of uint8 with shape {shape}")
        if stamp is not None and stamp < 0:
            raise ValueError(f"stamp: expected nanoseconds from 0; got {stamp}")
        if self._has_stamps not in (None, stamp is not None):
            raise ValueError("stamp: expected one of every frame, or of none")

    def _write_row(
        self, number: int, stamp: Optional[int], positions: Optional[NDArray[np.float64]]
    ) -> None:
        row = [number] if stamp is None else [number, stamp]
        cells = [""] * len(self._robot.variables) if positions is None else positions.tolist()
        text = ",".join(map(str, [*row, *cells])) + "\n"
        if self._has_stamps is None:
            header = ["frame"] if stamp is None else ["frame", "stamp"]
            text = ",".join([*header, *self._robot.variables]) + "\n" + text
            self._has_stamps = stamp is not None
        self._rows.write(text)
        self._rows.flush()

    def _write_part(self, name: str, image: NDArray[Any]) -> pathlib.Path:
        """Writes an image under the name that it has until it is whole."""
        part = self._folder / f"{name}.part"
        part.parent.mkdir(exist_ok=True)
        if image.dtype == np.float32:
            with open(part, "wb") as out:
                np.save(out, np.ascontiguousarray(image))
        else:
            write_png(part, image)
        return part

    def _write_yaml(self, name: str, values: Dict[str, Any]) -> None:
        part = self._folder / f"{name}.part"
        with open(part, "w", encoding="utf-8") as out:
            for key, value in values.items():
                if isinstance(value, dict):
                    out.write(f"{key}:\n")
                    out.writelines(f"  {name}: {_scalar(of)}\n" for name, of in value.items())
                else:
                    out.write(f"{key}: {_scalar(value)}\n")
        part.replace(self._folder / name)


def from_arrays(
    folder: PathLike,
    robot: Robot,
    camera: Camera,
    config: Optional[PipelineConfig],
    depths: Sequence[Optional[Depth]],
    joints: Sequence[Joints],
    colors: Optional[Sequence[Optional[Color]]] = None,
    stamps: Optional[Sequence[int]] = None,
    *,
    targets: Optional[PathLike] = None,
) -> Input:
    """Writes a whole sequence as Recorder does, and opens it.

    depths, joints, colors, stamps: one for each frame, as arrays with the frames along the first
    axis or as lists. Raises what Recorder raises, and ValueError for different numbers of them.
    """
    lengths = {
        name: len(of)
        for name, of in (
            ("depths", depths), ("joints", joints), ("colors", colors), ("stamps", stamps),
        )
        if of is not None
    }  # fmt: skip
    if len(set(lengths.values())) != 1 or not lengths["depths"]:
        raise ValueError(f"expected one of each for every frame; got {lengths}")
    with Recorder(folder, robot, camera, config, targets=targets) as recorder:
        for i in range(len(depths)):
            recorder.add(
                depths[i], joints[i], None if colors is None else colors[i],
                None if stamps is None else stamps[i],
            )  # fmt: skip
    return open_input(folder, color=colors is not None)


def _scalar(value: object) -> str:
    """JSON is YAML."""
    return json.dumps(value, ensure_ascii=False)


def _robot_keys(options: RobotOptions) -> Dict[str, Any]:
    geometry: Any = {link: of.name for link, of in options.geometry_of_links.items()}
    if options.geometry is not None:
        geometry = {"*": options.geometry.name, **geometry} if geometry else options.geometry.name
    keys = {
        "packages": {name: os.path.abspath(at) for name, at in options.packages.items()},
        "arguments": dict(options.arguments),
        "geometry": geometry,
        "ignore_links": list(options.ignore_links),
        "joints": dict(options.joints),
        "only_links": list(options.only_links),
        "margins": dict(options.margins),
        "extra": [{"link": e.link, "mesh": os.path.abspath(e.mesh)} for e in options.extra],
    }
    return {key: value for key, value in keys.items() if value}


def _camera_keys(camera: Camera, rule: LabelRule) -> Dict[str, Any]:
    """What is not the default."""
    default = LabelRule()
    keys = {key: getattr(rule, key) for key in rule_keys}
    keys = {key: value for key, value in keys.items() if value != getattr(default, key)}
    tolerance = [rule.tolerance.a, rule.tolerance.b, rule.tolerance.c]
    if tolerance != [default.tolerance.a, default.tolerance.b, default.tolerance.c]:
        keys["tolerance"] = tolerance
    near = max(camera.range.near, rule.range.near)
    far = min(camera.range.far, rule.range.far, far_enough)
    if (near, far) != (0.0, far_enough):
        keys["range"] = [near, far]
    return keys


def _camera_info(camera: Camera) -> Dict[str, Any]:
    """camera_info, of the images as they come."""
    k = camera.intrinsics
    return {
        "frame_id": camera.frame_id,
        "width": k.width,
        "height": k.height,
        "distortion_model": camera.distortion.model.value,
        "d": list(camera.distortion.coefficients),
        "k": [k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1],
    }


def _write_pose(file: pathlib.Path, pose: NDArray[np.float64]) -> None:
    """Raises InputError for a pose that is not rigid."""
    np.savetxt(file, pose, delimiter=",")
    try:
        read_pose_csv(file)
    except InputError:
        file.unlink()
        raise
