# SPDX-License-Identifier: Apache-2.0
"""What OpenGL draws for Python, beside the CPU."""

import os
import re

import numpy as np
import pytest

import penumbra
from conftest import DATA, Opened, refuses, ROOT, SHIPPED, skip_without_data
from penumbra import Backend
from test_stages import INTRINSICS, box_mesh


def agreement(name):
    """A tolerance of the renderers' own tests, where its reason stands too."""
    header = (ROOT / "tests" / "support" / "agreement.hpp").read_text()
    return float(re.search(rf"constexpr double {name} = ([-+.e0-9]+);", header).group(1))


DEPTH = agreement("interior_tolerance")  # of the depth
DIFFERING = agreement("differing_limit")  # of the robot's pixels, for either of two renderers


@pytest.fixture(scope="module", autouse=True)
def opengl():
    """The first device that can draw."""
    try:
        devices = penumbra.gl_devices()
    except penumbra.InputError:
        devices = []
    for device in devices:
        if not device.fault:
            return device
    assert "opengl" not in os.environ.get("PENUMBRA_REQUIRE", "").split(","), "no OpenGL"
    pytest.skip("no OpenGL")


def images(report):
    return [getattr(report, name).copy() for name in ("labels", "virtual_depth", "link_image")]


@pytest.mark.parametrize("folder", [SHIPPED, DATA / "xarm7_realsense"], ids=["shipped", "real"])
def test_labels_are_the_cpus(folder, opengl):
    """Where both draw one surface, depths are alike, and so is the label, unless that depth's last
    digits decide it; at edges, and beside them as far as the rule looks, few pixels differ."""
    if folder != SHIPPED:
        skip_without_data()
    cpu, gl = Opened(folder, backend=Backend.cpu), Opened(folder, backend=Backend.gl)
    assert gl.session.renderer.backend is Backend.gl
    assert opengl.name in gl.session.renderer.device
    robot = other_surface = other_label = 0
    for frame in cpu.frames:
        labels, depth, links = images(cpu.session.process(frame))
        gl_labels, gl_depth, gl_links = images(gl.session.process(frame))
        alike = (links == gl_links) & (abs(gl_depth - depth) <= DEPTH * depth)
        robot += np.count_nonzero(links)
        other_surface += np.count_nonzero(~alike)
        other_label += np.count_nonzero(labels != gl_labels)
    print(f"{robot} robot pixels, {other_surface} of another surface, {other_label} labels differ")
    assert robot > 100_000
    assert other_surface <= 2 * DIFFERING * robot
    assert other_label <= 2 * DIFFERING * robot


def test_a_device_that_is_not_there_is_an_error():
    refuses("4711", lambda: penumbra.Renderer(Backend.gl, INTRINSICS, [penumbra.Body("box", [box_mesh(0.5)])],
                                              penumbra.RendererOptions(gl_device=4711)))
