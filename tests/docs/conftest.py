# SPDX-License-Identifier: Apache-2.0
"""A folder in which all names that the documents use exist."""

import json
import os
import pathlib
import shutil

import numpy as np
import pytest

import penumbra
from bag import messages_of, write_bag
from blocks import ROOT

SHIPPED = ROOT / "examples" / "arm_over_table"
PROGRAM = pathlib.Path(penumbra.__file__).parent / "bin" / "penumbra"
ROBOT = "ur_description"  # what the documents call the package of a robot's meshes
PLACES = ("/opt/ros/humble/share/ur_description", "/opt/ur_description")  # where they say it is


def in_folder(text, folder):
    """The documents' absolute places, below the folder."""
    for place in PLACES:
        text = text.replace(place, str(folder / ROBOT))
    return text


@pytest.fixture(scope="session")
def template(tmp_path_factory):
    folder = tmp_path_factory.mktemp("named")
    (folder / "examples").symlink_to(ROOT / "examples")
    (folder / "docs").symlink_to(ROOT / "docs")
    urdf = (SHIPPED / "arm_description" / "arm.urdf").read_text()
    urdf = urdf.replace("package://arm_description", f"package://{ROBOT}").replace('"forearm"', '"forearm_link"')
    shutil.copytree(SHIPPED / "arm_description", folder / ROBOT)
    (folder / "ur5e.urdf").write_text(urdf)
    arguments = "".join(f'<xacro:arg name="{name}" default=""/>' for name in ("ur_type", "name"))
    (folder / "ur.urdf.xacro").write_text(urdf.replace("<link", arguments + "<link", 1))
    shutil.copytree(SHIPPED, folder / "my_recording", ignore=shutil.ignore_patterns("truth"))
    shutil.copytree(SHIPPED, folder / "my_images", ignore=shutil.ignore_patterns("truth", "recording.yaml"))
    for name in ("detections.json", "results.json"):
        box = {"image_id": 0, "category_id": 39, "bbox": [460, 172, 38, 98], "score": 0.9}
        (folder / name).write_text(json.dumps([box]))
    for name in ("targets.yaml", "wrist.csv", "camera_info.yaml", "camera_pose.csv", "joint_states.csv"):
        shutil.copy(SHIPPED / name, folder)
    given = penumbra.open(SHIPPED)
    session = penumbra.Session(given.robot, given.camera, given.config)
    for i, frame in enumerate(given):
        mask = session.process(frame).robot_mask
        penumbra.write_png(folder / "my_recording" / f"mask_{i}.png", mask.astype(np.uint8))
    write_bag(folder / "recording.mcap", messages_of(given, urdf, "base_link"))
    (folder / "my_bag").mkdir()
    shutil.copy(folder / "recording.mcap", folder / "my_bag" / "my_bag_0.mcap")
    return folder


@pytest.fixture
def work(template, tmp_path):
    return shutil.copytree(template, tmp_path / "work", symlinks=True)


@pytest.fixture
def environment(work):
    """A domain of this test's own, heard by this machine alone."""
    return {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", "HOME": str(work),
            "ROS_DOMAIN_ID": str(100 + os.getpid() % 100), "ROS_LOCALHOST_ONLY": "1", "TMPDIR": str(work)}
