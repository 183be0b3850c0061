# SPDX-License-Identifier: Apache-2.0
"""What OpenGL draws for Python, beside the CPU and the command line."""

import os
import re

import numpy as np
import pytest

import penumbra
from conftest import DATA, Opened, read_png, refuses, ROOT, run, SHIPPED, skip_without_data
from penumbra import Backend
from test_stages import INTRINSICS, box_mesh, pose


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
    assert gl.pipeline.renderer.backend is Backend.gl
    assert opengl.name in gl.pipeline.renderer.device
    robot = other_surface = other_label = 0
    for frame in cpu.frames:
        labels, depth, links = images(cpu.pipeline.process(frame.frame))
        gl_labels, gl_depth, gl_links = images(gl.pipeline.process(frame.frame))
        alike = (links == gl_links) & (abs(gl_depth - depth) <= DEPTH * depth)
        robot += np.count_nonzero(links)
        other_surface += np.count_nonzero(~alike)
        other_label += np.count_nonzero(labels != gl_labels)
    print(f"{robot} robot pixels, {other_surface} of another surface, {other_label} labels differ")
    assert robot > 100_000
    assert other_surface <= 2 * DIFFERING * robot
    assert other_label <= 2 * DIFFERING * robot


def test_the_command_line_draws_the_same(tmp_path):
    run("run", SHIPPED, "-o", tmp_path, "--renderer", "gl", "--save", "vdi,labels,links",
        "--targets", "none", "--frames", "0:4")
    opened = Opened(SHIPPED, backend=Backend.gl)
    for index in range(4):
        labels, depth, links = images(opened.pipeline.process(opened.frames[index].frame))
        assert np.array_equal(read_png(tmp_path / "labels" / f"{index:06d}.png"), labels)
        assert np.array_equal(np.load(tmp_path / "vdi" / f"{index:06d}.npy"), depth)
        assert np.array_equal(read_png(tmp_path / "links" / f"{index:06d}.png"), links)


def test_several_frames_are_drawn_at_once():
    """A square of side 0.5 at 1.75 m covers 14 x 14 pixels, farther off less: by hand."""
    renderer = penumbra.Renderer(Backend.gl, INTRINSICS, [penumbra.Body("box", [box_mesh(0.5)])])
    assert renderer.info.backend is Backend.gl and renderer.info.device
    places = [2.0 + 0.5 * i for i in range(renderer.max_pending)]
    assert len(places) > 1
    for z in places:
        renderer.submit([pose(0, 0, z)])
    refuses("pending", lambda: renderer.submit([pose(0, 0, 1)]), ValueError)
    for i, z in enumerate(places):
        assert renderer.pending == len(places) - i
        shown = renderer.collect()
        depth = shown.depth[shown.depth > 0]
        assert np.allclose(depth, z - 0.25, rtol=DEPTH)
        edge = INTRINSICS.fx * 0.5 / (z - 0.25)
        assert len(depth) in {int(edge) ** 2, round(edge) ** 2, int(edge + 1) ** 2}
        assert np.array_equal(shown.links > 0, shown.depth > 0)


def test_a_device_that_is_not_there_is_an_error():
    with pytest.raises(penumbra.InputError):
        penumbra.Renderer(Backend.gl, INTRINSICS, [penumbra.Body("box", [box_mesh(0.5)])],
                          penumbra.RendererOptions(gl_device=4711))
