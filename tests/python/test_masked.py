# SPDX-License-Identifier: Apache-2.0
"""Arrays with a mask are refused: masked values are not meant to be used."""

import numpy as np
import pytest

import penumbra
from conftest import refuses

IMAGE = np.ones((480, 640), np.uint16)
POSE = np.eye(4)
POINT = np.array([1.0, 2.0, 3.0])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)

# A valid array and a call of it for each kind of argument.
CASES = {
    "depth": (IMAGE, lambda x: penumbra.Frame(x, None)),
    "joints": (np.zeros(7), lambda x: penumbra.Frame(IMAGE, x)),
    "poses": (np.stack([POSE] * 11), lambda x: penumbra.Frame(IMAGE, None, T_root_link=x)),
    "pose": (POSE, lambda x: penumbra.PipelineConfig(T_parent_camera=x)),
    "point": (POINT, lambda x: penumbra.PointTarget(x)),
    "estimate": (POINT, lambda x: penumbra.TargetEstimate(x)),
    "polygon": (CORNERS[:, :2].astype(float), lambda x: penumbra.PixelPolygon(x)),
    "mask": (np.eye(4, dtype=bool), lambda x: penumbra.PixelMask(x)),
    "vertices": (CORNERS, lambda x: penumbra.TriangleMesh(x, np.array([[0, 1, 2]], np.uint32))),
}


@pytest.mark.parametrize("name", CASES)
def test_masked_arrays_are_refused(name):
    valid, call = CASES[name]
    call(valid)
    one = np.zeros(valid.shape, bool)
    one.flat[0] = True
    for mask in (one, np.ma.nomask):
        refuses("its mask would be lost", lambda: call(np.ma.masked_array(valid, mask=mask)), TypeError)


def test_other_arrays_are_taken():
    class Own(np.ndarray):
        """A subclass without a mask."""

    for joints in (np.zeros(7).view(Own), [np.float32(0)] * 7, (0,) * 7, np.zeros(7, np.int32)):
        assert np.array_equal(penumbra.Frame(IMAGE, joints).joints, np.zeros(7))
    poses = [POSE, POSE.astype(np.float32).tolist()]
    assert np.array_equal(penumbra.Frame(IMAGE, None, T_root_link=poses).T_root_link, [POSE, POSE])
