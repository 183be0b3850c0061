# SPDX-License-Identifier: Apache-2.0
"""Colour and depth images of episodes, read when they are used."""

from __future__ import annotations

import io
import pathlib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from penumbra import InputError
from penumbra.dataset_yaml import needed

Images = Callable[[int], NDArray[Any]]  # the image of a frame


def _decoded(source: Any) -> Iterator[NDArray[Any]]:
    """The images of a file, a video or bytes: 16-bit grey, or red, green and blue."""
    av = needed("av", "python3-av")
    try:
        with av.open(source) as opened:
            for frame in opened.decode(video=0):
                is_depth = frame.format.name.startswith("gray16")
                yield frame.to_ndarray(format="gray16le" if is_depth else "rgb24")
    except (OSError, ValueError) as error:
        name = source if isinstance(source, str) else "image"
        raise InputError(f"{name}: cannot be read: {error}") from None


def _first(source: Any, name: str) -> NDArray[Any]:
    image = next(_decoded(source), None)
    if image is None:
        raise InputError(f"{name}: has no image")
    return image


def array_images(data: Any, name: str) -> Images:
    """T x H x W (x 3), or encoded images: T x bytes."""

    def image(t: int) -> NDArray[Any]:
        if t >= len(data):
            raise InputError(f"{name}: has {len(data)} images, fewer than frames")
        try:
            value = np.asarray(data[t])
        except OSError as error:
            raise InputError(f"{name}: cannot be read: {error}") from None
        return value if value.ndim > 1 else _first(io.BytesIO(value.tobytes()), name)

    return image


def file_images(folder: pathlib.Path, name: str) -> Images:
    """A file for each frame, or a video whose frames are read one after another."""
    at = 0
    frames: Iterator[NDArray[Any]] = iter(())

    def image(t: int) -> NDArray[Any]:
        nonlocal at, frames
        if "%" in name:
            return _first(str(folder / (name % t)), name % t)
        if t == 0:
            at, frames = 0, _decoded(str(folder / name))
        for found in frames:
            at += 1
            if at == t + 1:
                return found
        raise InputError(f"{name}: has {at} images, fewer than frames")

    return image


def item_image(items: Any, start: int, key: str, t: int) -> NDArray[Any]:
    """Torch's images have their channels first, and floats for bytes."""
    image = np.asarray(items[start + t][key])
    if image.ndim == 3 and image.shape[0] in (1, 3):
        image = np.moveaxis(image, 0, -1)
    if image.shape[-1] == 3 and image.dtype.kind == "f":
        image = np.rint(255 * image).astype(np.uint8)
    return np.ascontiguousarray(image)
