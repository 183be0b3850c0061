# SPDX-License-Identifier: Apache-2.0
"""Every block of the documents that is no command: programs compile or run, files can be read."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
import yaml
from PIL import Image

import penumbra
from penumbra import datasets
from blocks import DOCUMENTS, ROOT, all_blocks, blocks_of, program_of
from conftest import SHIPPED, in_folder

KNOWN = ("", "sh", "python", "cpp", "cmake", "yaml", "json", "csv", "text")


def test_every_block_is_of_a_language_that_is_tested():
    for document in DOCUMENTS:
        for block in blocks_of(document):
            assert block.language in KNOWN, f"{block}: {block.language}"


# What the programs of a document print: regular expressions, and how many lines match them (1: or more).
SAID = {
    "look_ahead.md": {r"^lid \d\.\d\d s to \d\.\d\d s: hidden \w+$": 1},
    "point_clouds.md": {r"\A9\d{4} of 100000 points stay\n\Z": 1},
    "python.md": {r"^\d+ ok \d+ front pixels, \d{5,} points$": 12, r"FrameStatus\.bad_depth": 1, "% behind gripper": 1},
    "README.md": {r"\A\Z": 1},
    "robot_masks.md": {r"\A12 frames, \d{5} pixels in the last one\nepisode_000007 12\n": 1,
                       r"arm_over_table done 12\n\Z": 1},
}


@pytest.mark.parametrize("document", [d for d in DOCUMENTS if any(b.language == "python" for b in blocks_of(d))],
                         ids=lambda d: d.name)
def test_python_runs(document, work):
    done = subprocess.run([sys.executable, "-c", in_folder(program_of(document), work)], cwd=work, env=os.environ,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for pattern, lines in SAID[document.name].items():
        found = len(re.findall(pattern, done.stdout, re.MULTILINE))
        assert found == lines or found > lines == 1, done.stdout


def as_unit(block, number):
    """Whole programs stand in a namespace of their own, parts of one in a function."""
    includes = re.findall(r"^#include.*$", block.text, re.MULTILINE)
    text = re.sub(r"^#include.*$", "", block.text, flags=re.MULTILINE)
    place = f'#line {block.line} "{block.document}"\n'
    if includes:
        return includes, f"namespace block{number} {{\n{place}{text}\n}}\n"
    return [], f"void block{number}() {{\n{place}{text}\n}}\n"


def test_cpp_compiles(tmp_path):
    units = [as_unit(block, i) for i, block in enumerate(all_blocks("cpp"))]
    assert len(units) >= 4
    includes = sorted({line for of_block, _ in units for line in of_block})
    source = tmp_path / "blocks.cpp"
    source.write_text("\n".join([*includes, "#include <tests/docs/block_context.hpp>", *[text for _, text in units]]))
    done = subprocess.run([*os.environ["PENUMBRA_COMPILE"].split(), "-fsyntax-only", source],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_cmake_is_what_the_consumer_of_the_tests_says():
    consumer = (ROOT / "tests" / "house" / "consumer" / "CMakeLists.txt").read_text()
    said = re.sub(r"find_package\(Penumbra [0-9.]+ ", "find_package(Penumbra ", consumer)
    for block in all_blocks("cmake"):
        for line in block.text.splitlines():
            assert line.replace("my_node", "consumer") in said, f"{block}: {line}"


def recording_of(text, work):
    """A recording.yaml as it is shown; what is left out is the shipped one's."""
    shown = yaml.safe_load(in_folder(text, work))
    whole = yaml.safe_load((SHIPPED / "recording.yaml").read_text())
    whole["robot"] = {"urdf": "ur5e.urdf", "packages": {"ur_description": "ur_description"}}
    if "cameras" in shown:
        camera = whole.pop("camera")
        whole["frames"] = {"joints": whole["frames"]["joints"]}
        whole["cameras"] = {name: {**camera, "depth": "examples/arm_over_table/depth/%d.png"}
                            for name in shown["cameras"]}
    else:
        for part, keys in shown.items():
            whole[part] = {**whole[part], **keys} if part in whole else keys
        whole["frames"].update({"depth": "examples/arm_over_table/depth/%d.png",
                                "color": "examples/arm_over_table/color/%d.png"})
    if "robots" in shown:
        del whole["robot"]
        rows = list(csv.reader((work / whole["frames"]["joints"]).read_text().splitlines()))
        names = [[f"{name}/{joint}" for joint in rows[0][2:]] for name in shown["robots"]]
        rows = [rows[0][:2] + sum(names, [])] + [row + row[2:] for row in rows[1:]]
        (work / "joints.csv").write_text("\n".join(",".join(row) for row in rows))
        whole["frames"]["joints"] = "joints.csv"
    file = work / "recording.yaml"
    file.write_text(yaml.safe_dump(whole))
    return file


def read_targets(text, work):
    (work / "shown.yaml").write_text(text)
    shutil.copy(SHIPPED / "arm_description" / "meshes" / "finger.stl", work / "mug.stl")
    (work / "mug.csv").write_text("frame,stamp,x,y,z,qx,qy,qz,qw\n0,1,0,0,1,0,0,0,1\n")
    # Of the size that run lengths in the documents have.
    width, height = 1280, 720
    mask = np.zeros((height, width), np.uint8)
    mask[100:200, 100:200] = 255
    (work / "masks").mkdir()
    Image.fromarray(mask).save(work / "masks" / "000000.png")
    info = work / "my_recording" / "camera_info.yaml"
    info.write_text(f"frame_id: camera_color_optical_frame\nwidth: {width}\nheight: {height}\n"
                    "distortion_model: plumb_bob\nd: [0, 0, 0, 0, 0]\n"
                    "k: [900, 0, 640, 0, 900, 360, 0, 0, 1]\n")
    return penumbra.open(work / "my_recording").open_targets(work / "shown.yaml")


def read_dataset(shown, work):
    """A dataset.yaml; what is left out is that of the page's first one."""
    first = next(block for block in all_blocks("yaml") if block.document.endswith("robot_masks.md"))
    (work / "dataset.yaml").write_text(yaml.safe_dump({**yaml.safe_load(first.text), **shown}))
    return datasets.Dataset.load(work / "dataset.yaml")


@pytest.mark.parametrize("block", all_blocks("yaml"), ids=str)
def test_yaml_is_read(block, work, environment):
    shown = yaml.safe_load(block.text)
    if "sensor" in shown:
        (work / "lidar_pose.csv").write_text((work / "camera_pose.csv").read_text())
        (work / "clouds").mkdir()
        (work / shown["frames"]["cloud"].replace("%06d", "000000")).write_text(
            "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n0 0 2\n")
        file = work / "recording.yaml"
        file.write_text(block.text.replace("urdf: ur5e.urdf", "urdf: ur5e.urdf\n  packages: "
                                           "{ur_description: ur_description}"))
        subprocess.run(["penumbra", "cloud", file, "-o", "out", "--frames", "0:1", "--force"], cwd=work,
                       env=environment, check=True, capture_output=True)
        return
    if "columns" in shown:
        (work / "mine.yaml").write_text(block.text)
        first = next(yaml.safe_load(other.text) for other in all_blocks("yaml") if other.document == block.document)
        read_dataset({"robot": {**first["robot"], "name": "mine.yaml"}, "joints": []}, work)
        return
    if "joints" in shown:
        episode = read_dataset(shown, work).episode("it", np.zeros((2, 7)))
        assert episode.joints.shape == (2, 7)
        return
    if "detections" in shown:
        found = {"image_id": 0, "category_id": 39, "bbox": [10, 20, 30, 40], "score": 0.9}
        (work / shown["detections"]).write_text(json.dumps([found]))
        assert len(read_targets(block.text, work).of_frame(0)) == 1
        return
    if "targets" in shown:
        assert len(read_targets(block.text, work)) == len(shown["targets"])
        return
    camera = next(iter(shown.get("cameras", [""])))
    given = penumbra.open(recording_of(block.text, work), camera=camera)
    prefix = "left/" if "robots" in shown else ""
    assert len(list(given)) == 12 and given.robot.find_link(prefix + "forearm_link")


@pytest.mark.parametrize("block", all_blocks("json"), ids=str)
def test_json_is_of_reports(block, work, environment):
    shown = json.loads("{" + block.text + "}")
    subprocess.run(["penumbra", "run", "my_recording", "-o", "out"], cwd=work, env=environment,
                   check=True, capture_output=True)
    report = json.loads((work / "out" / "report.json").read_text())
    for key, value in shown.items():
        assert set(value) == set(report[key]), f"{block}: {key}"


@pytest.mark.parametrize("block", all_blocks("csv"), ids=str)
def test_csv_is_even(block):
    rows = list(csv.reader(block.text.splitlines()))
    assert len(rows) > 1 and len({len(row) for row in rows}) == 1
    [float(cell) for row in rows[1:] for cell in row]


def test_the_page_on_recordings_tells_all_keys():
    """Those that the reader allows."""
    source = (ROOT / "io" / "files" / "recording.cpp").read_text()
    keys = set()
    for found in re.finditer(r"(\w+)(?:\.allow_only\(\s*|_keys)\{(.*?)\}", source, re.DOTALL):
        of = found[1]
        if of in ("extra", "entry"):  # these keys stand in the row of their list
            continue
        if of == "node":  # of the function that reads it
            of = re.findall(r"^Recording\w+ (\w+)_of\(", source[:found.start()], re.MULTILINE)[-1]
        keys |= {key if of == "root" else f"{of}.{key}" for key in re.findall(r'"(\w+)"', found[2])}
    keys = keys - {"robot", "camera", "frames"} | {"camera.SETTING"}
    assert len(keys) >= 18
    table = re.search(r"## Keys\n(.*?)\n## ", (ROOT / "docs" / "recording.md").read_text(), re.DOTALL)
    told = {key for row in re.findall(r"^\| (`.*?) \|", table[1], re.MULTILINE)
            for key in re.findall(r"`([\w.]+)`", row)}
    assert told == keys
