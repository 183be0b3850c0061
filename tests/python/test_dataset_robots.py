# SPDX-License-Identifier: Apache-2.0
"""Robots by name: values as each data set records them, and the joints by a table of its own. The
descriptions are made here, with the public ones' joints and limits."""

import numpy as np
import pytest
import yaml

import penumbra
from penumbra import datasets, dataset_yaml
from conftest import refuses, run_python

h5py = pytest.importorskip("h5py")

DEGREE = np.pi / 180
FINGER = "prismatic"
SO101 = {"shoulder_pan": (-1.91986, 1.91986), "shoulder_lift": (-1.74533, 1.74533), "elbow_flex": (-1.69, 1.69),
         "wrist_flex": (-1.65806, 1.65806), "wrist_roll": (-2.74385, 2.84121), "gripper": (-0.174533, 1.74533)}
PANDA = {f"panda_joint{i + 1}": limits for i, limits in enumerate(
    [(-2.8973, 2.8973), (-1.7628, 1.7628), (-2.8973, 2.8973), (-3.0718, -0.0698), (-2.8973, 2.8973),
     (-0.0175, 3.7525), (-2.8973, 2.8973)])}
HAND = {**PANDA, "panda_finger_joint1": (0, 0.04, FINGER)}
DROID = {**PANDA, "finger_joint": (0, 0.725)}
TURN = 2 * np.pi
UR = {"shoulder_pan_joint": (-TURN, TURN), "shoulder_lift_joint": (-TURN, TURN), "elbow_joint": (-np.pi, np.pi),
      "wrist_1_joint": (-TURN, TURN), "wrist_2_joint": (-TURN, TURN), "wrist_3_joint": (-TURN, TURN)}
XARM7 = {**dict(zip([f"joint{i}" for i in range(1, 8)],
                    [(-TURN, TURN), (-2.059, 2.0944), (-TURN, TURN), (-0.19198, 3.927), (-TURN, TURN),
                     (-1.69297, np.pi), (-TURN, TURN)])), "drive_joint": (0, 0.85)}
XARM6 = {**dict(zip([f"joint{i}" for i in range(1, 7)],
                    [(-TURN, TURN), (-2.059, 2.0944), (-3.927, 0.19198), (-TURN, TURN), (-1.69297, np.pi),
                     (-TURN, TURN)])), "drive_joint": (0, 0.85)}
VIPER = {"waist": (-3.14158, 3.14158), "shoulder": (-1.85005, 1.25664), "elbow": (-1.76278, 1.6057),
         "forearm_roll": (-3.14158, 3.14158), "wrist_angle": (-1.8675, 2.23402), "wrist_rotate": (-3.14158, 3.14158)}
VX300S = {**VIPER, "gripper": None, "left_finger": (0.021, 0.057, FINGER)}
ALOHA = {f"{side}/{name}": limits for side in ("left", "right")
         for name, limits in {**VIPER, "left_finger": (0, 0.041, FINGER)}.items()}
ARMS = [f"{side}_{part}_joint" for side in ("left", "right") for part in
        ("shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_roll", "wrist_pitch", "wrist_yaw")]
LEGS = [f"{side}_{part}_joint" for side in ("left", "right") for part in
        ("hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll")]
WAIST = [f"waist_{part}_joint" for part in ("yaw", "roll", "pitch")]
FINGERS = [f"{side}_hand_{finger}_joint" for side in ("left", "right") for finger in
           ("thumb_0", "thumb_1", "thumb_2", "middle_0", "middle_1", "index_0", "index_1")]
G1 = {name: (-2.9, 2.9) for name in [*LEGS, *WAIST, *ARMS]}
DEX3 = {**G1, **{name: (-1.8, 1.8) for name in FINGERS}}

ARM7 = [0.1, -0.2, 0.3, -1.5, 0.5, 1.6, 0.7]
ARM6 = [0.1, -0.2, 0.3, -0.4, 0.5, 1.6]
REST = {**{name: 0 for name in [*LEGS, *WAIST]}, **dict(zip(FINGERS[10:], (0.4, 0.3, 0.2, 0.1)))}


def by_name(names, values):
    return dict(zip(names, values, strict=True))


# Robot, the description's joints, a row of the data set, the joints, what dataset.yaml adds.
TABLE = [
    ("so101", SO101, [-90, 45, 30, -10, 150, 50],
     by_name(SO101, [-np.pi / 2, np.pi / 4, np.pi / 6, -0.1745329, 2.6179939, 0.7853982]), []),
    ("so101_normalized", SO101, [100, -50, 100, -100, 50, 0],
     by_name(SO101, [1.919862, -0.872665, 1.690, -1.658063, np.pi / 2, -0.1745329]), []),
    ("so101_stretched", SO101, [0, 0, 0, 0, 0, 100], by_name(SO101, [0, np.pi / 2, -np.pi / 2, 0, 0, 1.7453293]), []),
    ("so101_stretched", SO101, [9, 180, 170, 0, 0, 0],
     by_name(SO101, [0.1570796, -np.pi / 2, 1.3962634, 0, 0, -0.1745329]), []),
    ("panda_robomimic", HAND, [*ARM7, 0.0123, -0.0124], by_name(HAND, [*ARM7, 0.0123]), []),
    ("panda_droid", DROID, [*ARM7, 0], by_name(DROID, [*ARM7, 0]), []),
    ("panda_droid", DROID, [*ARM7, 0.5], by_name(DROID, [*ARM7, 0.39645]), []),
    ("panda_robomind", PANDA, [*ARM7, 0.9], by_name(PANDA, ARM7), []),
    ("panda_robomind", HAND, [*ARM7, 0.75], by_name(HAND, [*ARM7, 0.01]),
     [{"joint": "panda_finger_joint1", "column": "gripper", "scale": -0.04, "offset": 0.04}]),
    ("ur5e_robomind", UR, [*ARM6, 0.9], by_name(UR, ARM6), []),
    ("xarm6", XARM6, [*ARM6, 0], by_name(XARM6, [*ARM6, 0.05]), []),
    ("xarm7", XARM7, [*ARM7[:3], 1.5, 0.5, 1.6, 0.7, 1], by_name(XARM7, [*ARM7[:3], 1.5, 0.5, 1.6, 0.7, 0.85]), []),
    ("aloha_left", VX300S, [*ARM6, 1, *[9] * 7], by_name(VX300S, [*ARM6, 1.491, 0.058]), []),
    ("aloha_right", VX300S, [*[9] * 7, *ARM6, 0], by_name(VX300S, [*ARM6, -0.6213, 0.01844]), []),
    ("aloha", ALOHA, [*ARM6, 0, *ARM6[::-1][:1], -1, -0.9, 0.3, 0.2, 0.1, 1],
     by_name(ALOHA, [*ARM6, 0.002, 1.6, -1, -0.9, 0.3, 0.2, 0.1, 0.037]), []),
    ("g1", G1, np.arange(29) / 100, by_name(G1, np.arange(29) / 100), []),
    ("g1_dex3", DEX3, np.arange(28) / 100,
     {**by_name([*ARMS, *FINGERS[:10]], np.arange(24) / 100), **REST},
     [{"joint": name, "value": value} for name, value in REST.items()]),
]


def describe(folder, robot, joints, keys=(), suffix="urdf", **more):
    """A chain of links with a box each, and a dataset.yaml."""
    box = '<collision><geometry><box size="0.02 0.02 0.05"/></geometry></collision>'
    text = [f'<robot name="it"><link name="base">{box}</link>']
    for parent, (name, limits) in zip(["base", *joints], joints.items()):
        kind = "continuous" if limits is None else limits[2] if len(limits) > 2 else "revolute"
        limit = f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="1" velocity="1"/>' if limits else ""
        text.append(f'<link name="{name}">{box}</link><joint name="{name}" type="{kind}"><origin xyz="0 0 0.05"/>'
                    f'<axis xyz="0 1 0"/><parent link="{parent}"/><child link="{name}"/>{limit}</joint>')
    (folder / f"robot.{suffix}").write_text("\n".join([*text, "</robot>"]))
    camera = {"width": 32, "height": 24, "fx": 30, "fy": 30, "cx": 16, "cy": 12, "parent": "base",
              "pose": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -2], [0, 0, 0, 1]]}
    whole = {"robot": {"name": robot, "urdf": f"robot.{suffix}"}, "camera": camera,
             "layout": {"columns": "qpos"}, "joints": list(keys), **more}
    (folder / "dataset.yaml").write_text(yaml.safe_dump(whole))
    return folder / "dataset.yaml"


def fault(folder, row, *words, **keys):
    """Of an episode of this row."""
    dataset = datasets.Dataset.load(describe(folder, *words, **keys))
    with pytest.raises(penumbra.InputError) as raised:
        dataset.episode("it", np.array([row, row], float))
    assert "\n" not in str(raised.value)
    return str(raised.value)


@pytest.mark.parametrize("robot, joints, row, expected, keys", TABLE)
def test_joints_are_those_of_a_table(robot, joints, row, expected, keys, tmp_path):
    dataset = datasets.Dataset.load(describe(tmp_path, robot, joints, keys))
    rows = np.array([row, row], float)
    episode = dataset.episode("it", rows)
    assert np.allclose(episode.joints[1], [expected[name] for name in dataset.robot.variables], atol=1e-6)


def test_all_robots_are_in_the_table_and_name_a_description():
    known = yaml.safe_load(dataset_yaml.ROBOTS.read_text())
    assert set(known) == {robot for robot, *_ in TABLE}
    assert all(of["data"] and of["fits"] for of in known.values())


@pytest.mark.parametrize("robot, joints, row, words", [
    ("panda_droid", DROID, [*np.rad2deg(ARM7), 0.5], ["column 0 (joint_0)", "5.73", "panda_joint1", "degrees?"]),
    ("panda_droid", DROID, [*ARM7, 60], ["column 7 (gripper)", "60", "0 to 100?"]),
    ("panda_robomimic", HAND, [*ARM7, 30, -30], ["column 7 (robot0_gripper_qpos 0)", "millimetres?"]),
    ("panda_robomimic", HAND, [*ARM7, 1, 1], ["column 7", "0 to 1?"]),
    ("xarm7", XARM7, [*ARM7[:3], 1.5, 0.5, 1.6, 0.7, 400], ["column 7 (gripper.pos)", "0 to 1000?"]),
    ("ur5e_robomind", UR, [*np.rad2deg(ARM6), 0], ["column 1 (joint 1)", "degrees?"]),
    ("so101", SO101, [0.5, -1.2, 1.1, 0.2, 0.1, 0.5], ["column 0 (shoulder_pan.pos)", "radians?"]),
    ("so101", SO101, [2048, 1000, 3000, 2048, 2048, 2000], ["column 0 (shoulder_pan.pos)", "2048"]),
    ("so101", SO101, [1, 2, 3, 4, 5], ["5 columns", "6", "shoulder_pan.pos", "gripper.pos"]),
])
def test_what_does_not_fit_is_said_by_column(robot, joints, row, words, tmp_path):
    message = fault(tmp_path, row, robot, joints)
    for word in words:
        assert word in message, message


WITHOUT_FINGER = {name: limits for name, limits in HAND.items() if "finger" not in name}


@pytest.mark.parametrize("robot, joints, keys, says", [
    ("so1o1", SO101, [], "so1o1 is not known; did you mean so101.*panda_droid.*g1_dex3"),
    ("panda_robomimic", WITHOUT_FINGER, [], "column 7 .robot0_gripper_qpos 0.*panda_finger_joint1.*franka_ros"),
    ("panda_robomind", HAND, [], r"panda_finger_joint1.*no joint has column 7 \(gripper\)"),
    ("g1_dex3", DEX3, [], r"left_knee_joint.*right_hand_index_0_joint.*column 24 \(kRightHandIndex0\)"),
    ("so101", SO101, ["gripper"], "joints.0"),
    ("so101", SO101, [{"joint": "gripper", "column": "griper.pos"}], "griper.pos.*gripper.pos"),
    ("nothing.yaml", SO101, [], "nothing.yaml"),
])
def test_wrong_robots_are_refused(robot, joints, keys, says, tmp_path):
    refuses(says, lambda: datasets.Dataset.load(describe(tmp_path, robot, joints, keys)))


@pytest.mark.parametrize("mapping, says", [
    ({"columns": ["a"]}, "mine.yaml.*columns"),
    ({"fits": []}, "mine.yaml.*columns is needed"),
    ({"columns": {"a": {"joint": "gripper", "unit": "turns"}}}, "mine.yaml.*column a.*turns"),
    ({"columns": {"a": None}}, "mine.yaml"),
    ({"colums": {}}, "mine.yaml.*colums"),
])
def test_wrong_mapping_files_are_refused(mapping, says, tmp_path):
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(mapping))
    refuses(says, lambda: datasets.Dataset.load(describe(tmp_path, "mine.yaml", SO101)))


def test_a_mapping_file_of_your_own(tmp_path):
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump({"columns": {
        "time": [], **{f"angle of {name}": name for name in [*SO101][:5]},
        "jaw": {"joint": "gripper", "scale": 0.001}}}, sort_keys=False))
    dataset = datasets.Dataset.load(describe(tmp_path, "mine.yaml", SO101))
    episode = dataset.episode("it", np.array([[7e9, *ARM6[:5], 250]]))
    assert np.allclose(episode.joints, [[*ARM6[:5], 0.25]])


def test_arguments_of_the_name_are_for_xacro_and_may_be_changed(tmp_path):
    file = describe(tmp_path, "xarm7", XARM7, suffix="urdf.xacro")
    xacro = tmp_path / "robot.urdf.xacro"
    text = xacro.read_text().replace('<robot name="it">', '<robot name="it" xmlns:xacro="http://ros.org/wiki/xacro">'
                                     '<xacro:arg name="dof" default="1"/><xacro:arg name="add_gripper" default=""/>'
                                     '<link name="dof_$(arg dof)_$(arg add_gripper)"/><joint name="j" type="fixed">'
                                     '<parent link="base"/><child link="dof_$(arg dof)_$(arg add_gripper)"/></joint>')
    xacro.write_text(text)
    assert "dof_7_true" in datasets.Dataset.load(file).robot.links
    whole = yaml.safe_load(file.read_text())
    whole["robot"]["arguments"] = {"dof": 9}
    file.write_text(yaml.safe_dump(whole))
    assert "dof_9_true" in datasets.Dataset.load(file).robot.links


def test_the_command_line_names_robot_and_description(tmp_path):
    describe(tmp_path, "xarm7", SO101)  # of another robot
    with h5py.File(tmp_path / "episode.hdf5", "w") as out:
        out["qpos"] = np.array([[-90, 45, 30, -10, 150, 50]] * 2, float)
    words = ["-m", "penumbra.datasets", "episode.hdf5", "-o", "out", "--dataset", "dataset.yaml", "--save", "npz",
             "--workers", "1"]
    run_python(*words, "--robot", "so101", "--description", "robot.urdf", cwd=tmp_path)
    [masks] = tmp_path.glob("out/*/run/masks.npz")
    assert np.allclose(np.load(masks)["joints"][0][0], -np.pi / 2)
    message = run_python(*words, "--robot", "so102", status=2, cwd=tmp_path).stderr
    assert "so101" in message and len(message.splitlines()) == 1
    message = run_python(*words, "--robot", "so101", "--description", "none.urdf", status=2, cwd=tmp_path).stderr
    assert "none.urdf" in message and len(message.splitlines()) == 1
