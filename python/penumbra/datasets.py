# SPDX-License-Identifier: Apache-2.0
"""Robot masks for the episodes of robot data sets (docs/robot_masks.md).

python3 -m penumbra.datasets FILE... -o OUT --dataset dataset.yaml [--save rle,npz,...]
    [--robot NAME --description PATH]
"""

from __future__ import annotations

import argparse
import dataclasses
import difflib
import fnmatch
import functools
import glob
import os
import pathlib
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from penumbra import (
    Camera,
    Frame,
    FrameReport,
    FrameStatus,
    InputError,
    Joint,
    JointType,
    PipelineConfig,
    Robot,
    RobotPose,
    Session,
    batch,
    dataset_yaml,
    mask_files,
)
from penumbra.dataset_yaml import (
    LAYOUTS,
    CloudOptions,
    JointColumn,
    Layout,
    Recorded,
    degree,
    needed,
    poses_of,
)
from penumbra.episode_images import Images, array_images, file_images, item_image
from penumbra.mask_files import write

__all__ = ["LAYOUTS", "CloudOptions", "Dataset", "Episode", "JointColumn", "Layout", "run", "write"]

beyond_range = 0.1  # of a joint's range: that far beyond its limits a value is not a position
most_beyond = 0.1  # of the frames
image_files = (".png", ".tif", ".tiff", ".mkv", ".mp4", ".mov", ".avi")
pose_is_known = (FrameStatus.ok, FrameStatus.missing_depth, FrameStatus.bad_depth)


@dataclasses.dataclass(frozen=True)
class Episode:
    """An episode that is checked. Made by Dataset."""

    name: str
    joints: NDArray[np.float64]  # T x n, in the order of robot.variables
    pose: NDArray[np.float64]  # T_parent_camera: 4 x 4, or T x 4 x 4
    color: Optional[Images] = None  # uint8, H x W x 3
    depth: Optional[Images] = None  # uint16 in millimetres or float32 in metres


class Dataset:
    """The robot, the camera and the layout of a data set."""

    def __init__(
        self,
        robot: Robot,
        camera: Camera,
        config: PipelineConfig,
        *,
        joints: Optional[Sequence[JointColumn]] = None,
        layout: Layout = LAYOUTS["lerobot"],
        camera_name: str = "",
        depth_scale: Optional[float] = None,
        clouds: CloudOptions = CloudOptions(),
        tracks: int = 768,
        recorded: Optional[Recorded] = None,
    ) -> None:
        """camera: its pose may be missing if each episode has one.
        config: with the rule that clouds are made by.
        joints: one of each of robot.variables; None: the columns are these.
        tracks: points of the robot's surface that are tracked.
        recorded: the names of all columns of an episode; None: there may be others.
        depth_scale: metres per unit; None: 0.001 for integers, 1 for floats."""
        if joints is None:
            joints = [JointColumn(name, i) for i, name in enumerate(robot.variables)]
        self.robot, self.camera, self.config = robot, camera, config
        if not isinstance(tracks, int) or tracks < 1:
            raise InputError(f"tracks: expected a number of points; got {tracks}")
        self.clouds, self.tracks, self._depth_scale = clouds, tracks, depth_scale
        self._sessions: dict[bool, Session] = {}
        self._recorded = recorded or Recorded("", (), ())
        self._columns = _in_order(joints, robot, self._recorded)
        paths = layout._asdict()
        for key in ("color", "depth", "pose"):
            needs_name = "{camera}" in paths[key] and not camera_name
            paths[key] = "" if needs_name else paths[key].replace("{camera}", camera_name)
        self._layout = Layout(**paths)

    @staticmethod
    def load(
        file: str | os.PathLike[str], robot: str = "", urdf: str | os.PathLike[str] = ""
    ) -> Dataset:
        """Reads a dataset.yaml. Raises InputError.

        robot: a name of robots.yaml or a file, urdf: the description, in place of dataset.yaml's.
        """
        return Dataset(**dataset_yaml.read(pathlib.Path(file), robot, os.fspath(urdf)))

    def episode(
        self,
        name: str,
        columns: NDArray[Any],
        *,
        pose: Optional[NDArray[Any]] = None,
        color: Optional[Images] = None,
        depth: Optional[Images] = None,
    ) -> Episode:
        """Maps an episode's columns to joints, and checks it.

        columns: T x n. pose: of the camera, if it is another one than the data set's.
        color, depth: return the image of a frame. Raises InputError.
        """
        columns = np.asarray(columns)
        joints = self._joints(columns)
        _check_limits(joints, columns, self._columns, self.robot, self._recorded)
        _check_degrees(columns, self._columns, self.robot, self._recorded)
        of_camera = self.camera.T_parent_camera if pose is None else poses_of(pose, len(joints))
        if of_camera is None:
            raise InputError("the pose of its camera is missing")
        k = self.camera.intrinsics
        for what, images in (("colour", color), ("depth", depth)):
            height, width = images(0).shape[:2] if images else (k.height, k.width)
            if (height, width) != (k.height, k.width):
                raise InputError(
                    f"{what} images are {width}x{height}, but the camera of "
                    f"dataset.yaml has {k.width}x{k.height}"
                )
        in_units = None if depth is None else functools.partial(self._depth, depth)
        return Episode(name, joints, of_camera, color, in_units)

    def groups(self, file: str | os.PathLike[str]) -> list[str]:
        """Returns the groups of an HDF5 file that are episodes: [""] if the file is one."""
        if not self._layout.episodes:
            return [""]
        with _open(file) as opened:
            names = [""]
            for pattern in self._layout.episodes.split("/"):
                names = [
                    f"{name}/{key}"
                    for name in names
                    for key in fnmatch.filter((opened[name] if name else opened), pattern)
                ]
        if not names:
            raise InputError(f"{file}: has no group {self._layout.episodes}")
        return sorted((name[1:] for name in names), key=lambda name: (len(name), name))

    def read(self, file: str | os.PathLike[str], group: str = "") -> Episode:
        """Reads an episode of an HDF5 or .npz file; images when they are used. Raises InputError."""
        layout, within = self._layout, f"{group}/" if group else ""
        opened = _open(file)
        if layout.episodes and not group:
            raise InputError(f"has no group {layout.episodes}, or none is chosen")

        def at(key: str) -> Any:
            try:
                return opened[within + key]
            except KeyError:
                raise InputError(f"{within}{key} is not in the file") from None

        def images(key: str) -> Images:
            return array_images(at(key), within + key)

        depth: Optional[Images] = None
        if layout.depth.endswith(image_files):
            depth = file_images(pathlib.Path(file).parent, layout.depth)
        elif layout.depth and within + layout.depth in opened:
            depth = images(layout.depth)
        return self.episode(
            f"{file}/{group}" if group else str(file),
            _side_by_side([at(key)[()] for key in layout.columns]),
            pose=at(layout.pose)[()] if layout.pose else None,
            color=images(layout.color) if layout.color else None,
            depth=depth,
        )

    def from_dicts(
        self,
        items: Any,
        on_fault: Optional[Callable[[InputError], None]] = None,
    ) -> Iterator[Episode]:
        """Makes episodes of an indexable data set of dictionaries, as LeRobot's.

        items: items[i] is a frame; the frames of an episode follow one another. on_fault: called
        for an episode that is wrong; None: raises its InputError.
        """
        layout, start = self._layout, 0
        keys = (layout.episodes, *layout.columns, layout.color, layout.depth, layout.pose)
        while start < len(items):
            first = items[start]
            missing = [key for key in keys if key and key not in first]
            if missing:
                raise InputError(f"{missing[0]} is not among the keys: {', '.join(first)}")
            number, rows, last = first[layout.episodes], [], start
            while last < len(items):
                item = first if last == start else items[last]
                if item[layout.episodes] != number:
                    break
                rows.append([np.asarray(item[key], float).ravel() for key in layout.columns])
                last += 1
            name = f"episode_{int(number):06d}"
            images = {
                key: functools.partial(item_image, items, start, of)
                for key, of in (("color", layout.color), ("depth", layout.depth))
                if of
            }
            try:
                columns = np.array([np.concatenate(row) for row in rows])
                pose = np.asarray(first[layout.pose]) if layout.pose else None
                episode = self.episode(name, columns, pose=pose, **images)
            except InputError as error:
                fault = InputError(f"{name}: {error}")
                if on_fault is None:
                    raise fault from None
                on_fault(fault)
            else:
                yield episode
            start = last

    def reports(self, episode: Episode, *, depth: bool = False) -> Iterator[FrameReport]:
        """Renders the robot in each frame. Read a report before you take the next one.

        depth: with the episode's depth images, for clouds and tracks. Raises InputError.
        """
        if depth and episode.depth is None:
            raise InputError("clouds: the episode has no depth images")
        for t, joints in enumerate(episode.joints):
            image = episode.depth(t) if depth and episode.depth else None
            pose = episode.pose if episode.pose.ndim == 2 else episode.pose[t]
            report = self._session(depth).process(
                Frame(image, RobotPose(positions=joints, T_parent_camera=pose))
            )
            if report.status not in pose_is_known:
                raise InputError(f"frame {t}: {report.status.value}: {report.message}")
            yield report

    def _session(self, has_depth: bool) -> Session:
        if has_depth not in self._sessions:
            camera = self.camera.replace(T_parent_camera=np.eye(4))  # each frame has its own pose
            config = self.config.replace(has_depth=has_depth)
            self._sessions[has_depth] = Session(self.robot, camera, config)
        return self._sessions[has_depth]

    def _joints(self, columns: NDArray[Any]) -> NDArray[np.float64]:
        if columns.ndim != 2:
            raise InputError(f"joints: expected frames x columns; got shape {columns.shape}")
        if len(columns) == 0:
            raise InputError("the episode has no frames")
        known = self._recorded
        if known.columns and columns.shape[1] != len(known.columns):
            raise InputError(
                f"the episode has {columns.shape[1]} columns, but {known.name} has "
                f"{len(known.columns)}: {', '.join(known.columns)}"
            )
        joints = np.empty((len(columns), len(self._columns)))
        for i, of in enumerate(self._columns):
            if of.column is not None and of.column >= columns.shape[1]:
                raise InputError(
                    f"joint {of.joint}: column {of.column} is missing: "
                    f"the episode has {columns.shape[1]} columns"
                )
            joints[:, i] = of.offset
            if of.column is not None:
                joints[:, i] += of.scale * columns[:, of.column]
        bad = np.argwhere(~np.isfinite(joints))
        if len(bad):
            frame, i = bad[0]
            raise InputError(
                f"joint {self._columns[i].joint}: {joints[frame, i]} in frame {frame}, "
                f"{len(np.unique(bad[:, 0]))} such frames"
            )
        return joints

    def _depth(self, images: Images, t: int) -> NDArray[Any]:
        image = np.squeeze(images(t))
        if image.ndim != 2 or image.dtype == np.uint8:
            raise InputError(f"depth of frame {t}: is not an image of 16 bits or floats")
        scale = self._depth_scale
        if scale is None and image.dtype.kind in "ui":
            if image.dtype == np.uint16:
                return np.ascontiguousarray(image)
            scale = 0.001
        return np.ascontiguousarray(image * np.float32(1 if scale is None else scale), np.float32)


def _label(column: Optional[int], recorded: Recorded) -> str:
    if column is None:
        return "joints"
    name = f" ({recorded.columns[column]})" if column < len(recorded.columns) else ""
    return f"column {column}{name}"


def _in_order(
    joints: Sequence[JointColumn], robot: Robot, recorded: Recorded
) -> list[JointColumn]:
    fits = f"; {recorded.name} fits {' or '.join(recorded.fits)}" if recorded.fits else ""
    of = {entry.joint: entry for entry in joints}
    for name, entry in of.items():
        if name not in robot.variables:
            near = difflib.get_close_matches(name, robot.variables, 1)
            hint = f"; did you mean {near[0]}?" if near else f" of {', '.join(robot.variables)}"
            where = _label(entry.column, recorded)
            raise InputError(f"{where}: {name} is not a joint{hint}{fits}")
    missing = [name for name in robot.variables if name not in of]
    if missing:
        used = {entry.column for entry in joints}
        free = [_label(i, recorded) for i in range(len(recorded.columns)) if i not in used]
        raise InputError(
            f"joints: {', '.join(missing)}: give a column, or the value of a joint "
            f"that does not move{fits}" + (f"; no joint has {', '.join(free)}" if free else "")
        )
    return [of[name] for name in robot.variables]


def _check_limits(
    joints: NDArray[np.float64],
    columns: NDArray[Any],
    order: Sequence[JointColumn],
    robot: Robot,
    recorded: Recorded,
) -> None:
    """Finds degrees, millimetres, and grippers from 0 to 1."""
    for joint in robot.joints:
        if joint.variable is None or joint.mimics or joint.lower is None or joint.upper is None:
            continue
        of, values = order[joint.variable], joints[:, joint.variable]
        reach = joint.upper - joint.lower
        beyond = np.maximum(joint.lower - values, values - joint.upper)
        share = np.mean(beyond > beyond_range * reach)
        if reach > 0 and share > most_beyond:
            raw = values if of.column is None else columns[:, of.column]
            worst = np.argmax(beyond)
            meant = "" if raw[worst] == values[worst] else f", taken as {values[worst]:.4g},"
            raise InputError(
                f"{_label(of.column, recorded)}: {raw[worst]:.4g}{meant} is beyond {joint.name}'s "
                f"limits ({joint.lower:.4g} to {joint.upper:.4g}), as {100 * share:.0f} % of all: "
                + _likely_unit(raw, of, joint)
            )


def _likely_unit(values: NDArray[np.float64], of: JointColumn, joint: Joint) -> str:
    """Of values beyond the joint's limits: the first unit that brings them within."""
    lower, upper = joint.lower or 0, joint.upper or 0
    remedy = "set its scale and offset"
    if of.column is None:
        return "set its value"
    if of.scale != 1:
        units = [("0 to 100", 0.01), ("0 to 1000", 0.001)]
    elif joint.type != JointType.prismatic:
        units = [("degrees", degree)]
        remedy = f"set unit: degrees, or scale: {degree:.7f}"
    else:
        units = [("0 to 1", upper)] if np.max(np.abs(values)) < 1.1 else [("millimetres", 0.001)]
    for unit, factor in units:
        meant = of.scale * factor * values + of.offset
        beyond = np.maximum(lower - meant, meant - upper)
        if np.mean(beyond > beyond_range * (upper - lower)) <= most_beyond:
            return f"{unit}? {remedy}"
    return "set its scale and offset"


def _check_degrees(
    columns: NDArray[Any], order: Sequence[JointColumn], robot: Robot, recorded: Recorded
) -> None:
    """Finds radians that are taken as degrees: three joints never stay within 3.2 degrees."""
    turns = {joint.variable for joint in robot.joints if joint.type != JointType.prismatic}
    scaled = [
        of.column
        for i, of in enumerate(order)
        if i in turns and of.column is not None and abs(of.scale) < 0.1
    ]
    if len(scaled) >= 3 and np.max(np.abs(columns[:, scaled])) < 3.2:
        raise InputError(
            f"{', '.join(_label(column, recorded) for column in scaled)}: all values are within "
            "3.2: radians? They are taken as degrees"
        )


def _open(file: str | os.PathLike[str]) -> Any:
    try:
        if os.fspath(file).endswith(".npz"):
            return np.load(file)
        return needed("h5py", "python3-h5py").File(file, "r")
    except (OSError, ValueError) as error:
        raise InputError(f"cannot be read: {error}") from None


def _side_by_side(arrays: Sequence[NDArray[Any]]) -> NDArray[np.float64]:
    if len({len(array) for array in arrays}) > 1:
        raise InputError(f"joints: arrays of {' and '.join(str(len(a)) for a in arrays)} frames")
    return np.concatenate(
        [np.asarray(a, float).reshape(len(a), -1) if len(a) else np.empty((0, 1)) for a in arrays],
        axis=1,
    )


def _file_of(name: str) -> pathlib.Path:
    """Of an episode FILE or FILE/GROUP."""
    path = pathlib.Path(name)
    return next((part for part in (path, *path.parents) if part.is_file()), path)


@functools.lru_cache(maxsize=2)
def _loaded(description: str, changed: int, robot: str, urdf: str) -> Dataset:
    return Dataset.load(description, robot, urdf)


def _write_masks(
    name: str, options: list[str], working_folder: str, part: pathlib.Path
) -> dict[str, Any]:
    """The work of a batch: options are dataset.yaml, robot, its description and what to save."""
    description, robot, urdf, *save = options
    dataset = _loaded(description, os.stat(description).st_mtime_ns, robot, urdf)
    file = _file_of(name)
    group = pathlib.Path(name).relative_to(file).as_posix()
    episode = dataset.read(file, "" if group == "." else group)
    contents = write(dataset, episode, part / "run", save)
    return {
        "frames": contents["frames"],
        "bad_frames": 0,
        "pixels_robot": sum(contents["robot_pixels"]),
    }


def _episodes(inputs: Iterable[str | os.PathLike[str]], dataset: Dataset) -> list[str]:
    """FILE or FILE/GROUP of each episode."""
    found: dict[str, None] = {}
    for given in inputs:
        pattern = os.fspath(given)
        found_files = [] if os.path.lexists(pattern) else sorted(glob.glob(pattern, recursive=True))
        for file in found_files or [pattern]:
            path = os.path.abspath(file)
            try:
                groups = dataset.groups(path)
            except InputError:  # the work says what is wrong
                groups = [""]
            found.update((f"{path}/{group}" if group else path, None) for group in groups)
    if not found:
        raise InputError("no input is given")
    return list(found)


def run(
    inputs: Iterable[str | os.PathLike[str]],
    output: str | os.PathLike[str],
    description: str | os.PathLike[str],
    save: Sequence[str] = ("rle",),
    *,
    robot: str = "",
    urdf: str | os.PathLike[str] = "",
    **where: Any,
) -> list[dict[str, Any]]:
    """Writes the masks of all episodes of files, on all cores or on a cluster of Dask's.

    inputs: HDF5 or .npz files, or patterns of them. output: as of penumbra.batch.run; each
    episode's files are in output/NAME-HASH/run. description: a dataset.yaml. save: as of write().
    robot, urdf: as of Dataset.load, from the working folder.
    where: workers, scheduler, retry_failed and on_progress of penumbra.batch.run.

    Returns a record of each episode: "status", "frames", "pixels_robot" and others; "fault" if it
    failed. Raises InputError for what is wrong with all of them.
    """
    file = os.path.abspath(description)
    mask_files.check(save)
    robot = os.path.abspath(robot) if robot.endswith((".yaml", ".yml")) else robot
    urdf = os.path.abspath(urdf) if urdf else ""
    dataset = Dataset.load(file, robot, urdf)
    dataset_file = pathlib.Path(file)
    common = [dataset_file, *filter(None, [dataset.robot.urdf])]
    if dataset._recorded.name:  # a file, unless it is a name of robots.yaml
        common.append(dataset_file.parent / dataset._recorded.name)
    given = [(name, [file, robot, urdf, *save]) for name in _episodes(inputs, dataset)]
    return batch.run_work(
        _write_masks, given, lambda name: [_file_of(name), *common], output, **where
    )


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python3 -m penumbra.datasets",
        description="Writes the robot's masks in the episodes of a data set, on all cores or on a "
        "cluster of Dask's. What is done and unchanged is not done again.",
        epilog="Exit status: 0; 1 if an episode failed; 2 if all failed or the arguments are "
        "wrong; 130 after Ctrl-C.",
        allow_abbrev=False,
    )
    parser.add_argument("inputs", nargs="+", metavar="FILE", help="HDF5, .npz, or 'pattern*.hdf5'")
    parser.add_argument("--dataset", required=True, help="dataset.yaml: robot, camera, joints")
    parser.add_argument("--robot", default="", help="name of the robot, or its mapping file")
    parser.add_argument("--description", default="", help="the robot: URDF, xacro or MJCF")
    parser.add_argument("--save", default="rle", help=",".join(mask_files.WRITERS))
    batch.add_options(parser)
    known = parser.parse_args()
    return batch.report(
        parser,
        known,
        lambda where: run(
            known.inputs,
            known.output,
            known.dataset,
            known.save.split(","),
            robot=known.robot,
            urdf=known.description,
            **where,
        ),
    )


if __name__ == "__main__":
    from penumbra import datasets  # workers import it by this name

    sys.exit(datasets.main())
