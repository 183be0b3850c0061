# SPDX-License-Identifier: Apache-2.0
"""The files of an episode's robot masks (docs/robot_masks.md)."""

from __future__ import annotations

import colorsys
import contextlib
import json
import os
import pathlib
import zipfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from penumbra import FrameReport, InputError, Robot, TriangleMesh, __version__, write_png
from penumbra.dataset_yaml import CloudOptions, needed

if TYPE_CHECKING:
    from penumbra.datasets import Dataset, Episode

most_links = 255  # in images of 8 bits
prompt_points = 3
prompt_depth = 6  # pixels from the link's outline: a link without such points has no prompt
frames_per_second = 30  # of videos
npy_format: Any = np.lib.format


class _Rle:
    """masks.json: a COCO data set with an annotation for each frame in which the robot is seen."""

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        k = dataset.camera.intrinsics
        images = [
            {"id": t, "width": k.width, "height": k.height, "file_name": f"{t:06d}.png"}
            for t in range(len(episode.joints))
        ]
        categories = [{"id": 1, "name": "robot"}]
        self._out = open(folder / "masks.json", "w", encoding="utf-8")
        self._out.write(
            f'{{"images": {json.dumps(images)},\n"categories": {json.dumps(categories)},'
            '\n"annotations": ['
        )
        self._separator = "\n"

    def add(self, t: int, report: FrameReport) -> None:
        annotation = report.coco_annotation()
        assert annotation is not None  # Dataset.reports yields no others
        if annotation["area"] == 0:
            return
        annotation.update(id=t, image_id=t, category_id=1, iscrowd=0)
        self._out.write(self._separator + json.dumps(annotation))
        self._separator = ",\n"

    def close(self) -> None:
        self._out.write("]}\n")
        self._out.close()


class _Npz:
    """masks.npz: `links` T x H x W, numbers of links, 0 where no robot is; `names`, `joints`."""

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        k = dataset.camera.intrinsics
        self._rest = {"names": np.array(dataset.robot.links), "joints": episode.joints}
        self._zip = zipfile.ZipFile(
            folder / "masks.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1
        )
        self._out = self._zip.open("links.npy", "w", force_zip64=True)
        shape = (len(episode.joints), k.height, k.width)
        npy_format.write_array_header_1_0(
            self._out, {"descr": "|u1", "fortran_order": False, "shape": shape}
        )

    def add(self, t: int, report: FrameReport) -> None:
        self._out.write(_links(report).tobytes())

    def close(self) -> None:
        self._out.close()
        for name, array in self._rest.items():
            with self._zip.open(f"{name}.npy", "w") as out:
                npy_format.write_array(out, array)
        self._zip.close()


class _Png:
    """robot_mask/000000.png: 255 where the robot is."""

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        self._folder = folder / "robot_mask"
        self._folder.mkdir(exist_ok=True)

    def add(self, t: int, report: FrameReport) -> None:
        write_png(self._folder / f"{t:06d}.png", _mask(report).view(np.uint8) * np.uint8(255))

    def close(self) -> None:
        pass


class _Video:
    """links.mkv (FFV1) or links.mp4 (H.264 without loss): grey, numbers of links; links.json."""

    name, codec, options = "links.mkv", "ffv1", {"level": "3"}

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        self._av = needed("av", "python3-av")
        names = dataset.robot.links
        colors = [
            [round(255 * c) for c in colorsys.hsv_to_rgb(i / len(names), 0.8, 1)]
            for i in range(len(names))
        ]
        links = {i + 1: {"link": name, "colour": colors[i]} for i, name in enumerate(names)}
        (folder / "links.json").write_text(json.dumps(links, indent=1), encoding="utf-8")
        k = dataset.camera.intrinsics
        self._out = self._av.open(str(folder / self.name), "w")
        self._stream = self._out.add_stream(
            self.codec, rate=frames_per_second, options=self.options
        )
        self._stream.width, self._stream.height, self._stream.pix_fmt = k.width, k.height, "gray"

    def add(self, t: int, report: FrameReport) -> None:
        frame = self._av.VideoFrame.from_ndarray(_links(report), format="gray")
        self._out.mux(self._stream.encode(frame))

    def close(self) -> None:
        self._out.mux(self._stream.encode())
        self._out.close()


class _H264(_Video):
    name, codec, options = "links.mp4", "libx264", {"qp": "0"}


class _Prompts:
    """prompts.json: for SAM 2, a box and points of each link that is seen well."""

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        self._out = open(folder / "prompts.json", "w", encoding="utf-8")
        self._out.write('{"frames": [')

    def add(self, t: int, report: FrameReport) -> None:
        found = {
            report.links[value - 1]: prompt for value, prompt in prompts(_links(report)).items()
        }
        self._out.write((",\n" if t else "\n") + json.dumps({"frame": t, "links": found}))

    def close(self) -> None:
        self._out.write("]}\n")
        self._out.close()


def prompts(links: NDArray[np.uint8]) -> dict[int, dict[str, Any]]:
    """Returns {number of a link: {"box": [u0, v0, u1, v1], "points": three [u, v]}}.

    The points lie deep inside of the link's pixels and apart from each other.
    """
    found = {}
    all_rows, all_columns = np.nonzero(links)
    values = links[all_rows, all_columns]
    for value in np.unique(values):
        rows, columns = all_rows[values == value], all_columns[values == value]
        top, left, bottom, right = rows.min(), columns.min(), rows.max(), columns.max()
        depth = _depth_inside(links[top : bottom + 1, left : right + 1] == value)
        deepest = depth.max()
        points: list[list[int]] = []
        v, u = np.mgrid[: depth.shape[0], : depth.shape[1]]
        least = max(prompt_depth, deepest / 2)
        while depth.max() >= least and len(points) < prompt_points:
            at = np.unravel_index(np.argmax(depth), depth.shape)
            points.append([int(left + at[1]), int(top + at[0])])
            depth[(v - at[0]) ** 2 + (u - at[1]) ** 2 < (deepest / 2) ** 2] = 0
        if len(points) == prompt_points:
            box = [int(left), int(top), int(right), int(bottom)]
            found[int(value)] = {"box": box, "points": points}
    return found


def _depth_inside(mask: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Returns the distance to the nearest pixel outside, in steps along rows and columns."""
    depth = np.where(np.pad(mask, 1), sum(mask.shape), 0).astype(np.int32)
    for _ in range(2):  # along columns, then along rows
        steps = np.arange(len(depth), dtype=np.int32)[:, None]
        before = np.minimum.accumulate(depth - steps) + steps
        after = np.minimum.accumulate((depth + steps)[::-1])[::-1] - steps
        depth = np.minimum(before, after).T
    return depth[1:-1, 1:-1]


class _Clouds:
    """clouds.npz: `points` T x N x 3, `colors`, `counts`, `robot_points`."""

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        self._file, self._options, self._episode = folder / "clouds.npz", dataset.clouds, episode
        self._model = _surface_points(dataset.robot, dataset.clouds.robot_points)
        self._arrays: dict[str, list[Any]] = {"points": [], "counts": []}

    def add(self, t: int, report: FrameReport) -> None:
        color = None if self._episode.color is None else self._episode.color(t)
        for name, array in cloud(report, self._options, self._model, color).items():
            self._arrays.setdefault(name, []).append(array)

    def close(self) -> None:
        arrays = {name: np.array(of) for name, of in self._arrays.items()}
        np.savez_compressed(self._file, **arrays)


class _Tracks:
    """tracks.npz: points of the robot's surface, and where each frame shows them."""

    def __init__(self, folder: pathlib.Path, dataset: Dataset, episode: Episode) -> None:
        self._file, self._names = folder / "tracks.npz", dataset.robot.links
        self._points = _surface_points(dataset.robot, dataset.tracks)
        columns = ("pixels", "depths", "visible", "verdicts", "hidden_by")
        self._arrays: dict[str, list[Any]] = {name: [] for name in columns}

    def add(self, t: int, report: FrameReport) -> None:
        views = [report.point_views(*of) for of in zip(self._names, self._points)]
        for name, frames in self._arrays.items():
            frames.append(np.concatenate([getattr(of_link, name) for of_link in views]))

    def close(self) -> None:
        arrays = {name: np.array(of) for name, of in self._arrays.items()}
        for name in ("pixels", "depths"):
            arrays[name] = arrays[name].astype(np.float32)
        arrays["points"] = np.concatenate(self._points)
        numbers = np.arange(1, len(self._names) + 1, dtype=np.uint16)
        arrays["links"] = np.repeat(numbers, [len(of) for of in self._points])
        arrays["names"] = np.array(self._names)
        np.savez_compressed(self._file, **arrays)


def cloud(
    report: FrameReport,
    options: CloudOptions,
    model: Sequence[NDArray[np.float64]] = (),
    color: Any = None,
) -> dict[str, Any]:
    """Returns a frame's points without the robot, with colours if there are any.

    points: exactly options.points, of which the first `count` differ. robot_points: those of the
    model, one array of each link in its frame, at the robot's pose.
    """
    made = report.points(options.frame or None, color)
    points = made.points
    kept = np.arange(len(points))
    if options.crop is not None:
        low, high = np.array(options.crop, float)
        kept = kept[np.all((points >= low) & (points <= high), axis=1)]
    if options.voxel > 0:
        x, y, z = np.floor(points[kept].T / options.voxel).astype(np.int64)
        cell = (x << 42) + (y << 21) + z  # enough for a million cubes along each axis
        kept = kept[np.sort(np.unique(cell, return_index=True)[1])]
    kept = kept[farthest_points(points[kept], options.points)]
    count = len(kept)
    kept = np.resize(kept, options.points) if count else kept
    arrays: dict[str, Any] = {"counts": count}
    arrays["points"] = points[kept] if count else np.zeros((options.points, 3), np.float32)
    if color is not None:
        arrays["colors"] = made.colors[kept] if count else np.zeros((options.points, 3), np.uint8)
    of_links, of_camera = report.T_root_link, report.T_root_camera
    if len(model) and of_links is not None and of_camera is not None:
        to = of_links[report.links.index(options.frame)] if options.frame else of_camera
        poses = np.linalg.inv(to) @ of_links
        turned = [of @ pose[:3, :3].T + pose[:3, 3] for of, pose in zip(model, poses)]
        arrays["robot_points"] = np.concatenate(turned).astype(np.float32)
    return arrays


def farthest_points(points: NDArray[np.float32], number: int) -> NDArray[np.int64]:
    """Returns the indices of points, each as far as possible from those before it."""
    if len(points) <= number:
        return np.arange(len(points))
    chosen = np.zeros(number, np.int64)
    distance = np.full(len(points), np.inf, np.float32)
    for i in range(1, number):
        offset = points - points[chosen[i - 1]]
        np.minimum(distance, np.einsum("ij,ij->i", offset, offset), out=distance)
        chosen[i] = np.argmax(distance)
    return chosen


def _surface_points(robot: Robot, number: int) -> list[NDArray[np.float64]]:
    """Returns points of the robot's surface, spread by area, for each link in its frame."""
    areas = [sum(map(_area, robot.meshes(link))) for link in range(len(robot.links))]
    ends = np.rint(np.cumsum(areas) * (number / sum(areas))).astype(int)
    counts = np.diff(ends, prepend=0)
    return [
        robot.points_on(link, int(count)) if count else np.empty((0, 3))
        for link, count in zip(robot.links, counts)
    ]


def _area(mesh: TriangleMesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def _mask(report: FrameReport) -> NDArray[np.bool_]:
    mask = report.robot_mask
    assert mask is not None  # Dataset.reports yields no others
    return mask


def _links(report: FrameReport) -> NDArray[np.uint8]:
    links = report.link_image
    assert links is not None
    return links.astype(np.uint8)


WRITERS: dict[str, Any] = {
    "rle": _Rle,
    "npz": _Npz,
    "png": _Png,
    "video": _Video,
    "h264": _H264,
    "prompts": _Prompts,
    "clouds": _Clouds,
    "tracks": _Tracks,
}


FILES = (
    "masks.json", "masks.npz", "robot_mask", "links.json", "links.mkv", "links.mp4",
    "prompts.json", "clouds.npz", "tracks.npz",
)  # fmt: skip


def _begin(folder: pathlib.Path) -> pathlib.Path:
    """Removes earlier results; returns the part of the report, which a killed program leaves.

    Nothing is removed that is not of write(), and nothing behind a link.
    """
    report = folder / "report.json"
    part = folder / "report.json.penumbra.part"
    own = [file for name in FILES if os.path.lexists(file := folder / name)]
    is_former = os.path.lexists(part)
    if os.path.lexists(report):
        own.insert(0, report)  # goes first: it says that the others are whole
        is_former |= report.read_bytes().startswith(b'{\n "penumbra": ')
    if own and not is_former:
        raise InputError(f"{own[0]}: is not of penumbra; choose another folder")
    masks = folder / "robot_mask"
    if masks.is_symlink():
        raise InputError(f"{masks}: is a link, and nothing is written behind one")
    part.unlink(missing_ok=True)
    part.touch()
    images = [image for image in masks.glob("*.png") if image.stem.isdecimal()]
    for file in [*own, *images]:
        if file != masks:
            file.unlink()
    return part


def check(save: Sequence[str]) -> None:
    for name in save:
        if name not in WRITERS:
            raise InputError(f"save: expected some of {', '.join(WRITERS)}; got {name}")


def write(
    dataset: Dataset,
    episode: Episode,
    folder: str | os.PathLike[str],
    save: Sequence[str] = ("rle",),
) -> dict[str, Any]:
    """Writes an episode's files into a folder, report.json last; returns its contents.

    save: of rle, npz, png, video, h264, prompts, clouds, tracks. Files of an earlier call are replaced.
    Raises InputError, also if the folder has other files of these names.
    """
    check(save)
    links = dataset.robot.links
    if len(links) > most_links:
        raise InputError(
            f"the robot has {len(links)} links; masks of more than {most_links} "
            "are not supported"
        )
    out = pathlib.Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    part = _begin(out)
    pixels = []
    with contextlib.ExitStack() as at_end:
        writers = [WRITERS[name](out, dataset, episode) for name in save]
        for writer in writers:
            at_end.callback(writer.close)
        depth = "clouds" in save or ("tracks" in save and episode.depth is not None)
        for t, report in enumerate(dataset.reports(episode, depth=depth)):
            for writer in writers:
                writer.add(t, report)
            pixels.append(report.pixels.robot)
    contents = {
        "penumbra": __version__,
        "episode": episode.name,
        "links": list(links),
        "save": list(save),
        "frames": len(pixels),
        "robot_pixels": pixels,
    }
    part.write_text(json.dumps(contents, indent=1), encoding="utf-8")
    part.replace(out / "report.json")
    return contents
