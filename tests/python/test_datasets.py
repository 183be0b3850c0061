# SPDX-License-Identifier: Apache-2.0
"""Robot masks of episodes: HDF5 files of the known layouts, made here, and dictionaries."""

import io
import json
import pathlib
import shutil

import numpy as np
from PIL import Image
import pytest
import yaml

import penumbra
from penumbra import datasets, mask_files
from conftest import DATA, Opened, read_png, refuses, run_python, SHIPPED, skip_without_data

h5py = pytest.importorskip("h5py")
av = pytest.importorskip("av")

JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3", "gripper_left")
OPEN = 0.045  # metres: the gripper's upper limit
DEGREE = np.pi / 180
HEIGHT, WIDTH = 480, 640


@pytest.fixture(scope="module")
def arm():
    return Opened(SHIPPED, color=True)


@pytest.fixture(scope="module")
def joints(arm):
    """Of the shipped recording, radians and metres."""
    return np.array([frame.pose.positions for frame in arm.frames])[:5]


@pytest.fixture(scope="module")
def truth(arm, joints):
    """Link images of the renderer alone."""
    renderer = penumbra.Renderer(penumbra.Backend.cpu, arm.camera.intrinsics, arm.robot.bodies)
    to_camera = np.linalg.inv(arm.camera.T_parent_camera)
    drawn = []
    for of in joints:
        image = renderer.render(to_camera @ arm.robot.forward_kinematics(of))
        drawn.append(np.where(image.depth > 0, image.links, 0))
    return np.array(drawn)


def recorded(joints):
    """As many robots record it: degrees, and a gripper from 0 (open) to 1 (closed)."""
    return np.column_stack([joints[:, :6] / DEGREE, 1 - joints[:, 6] / OPEN])


MAPPED = [*({"joint": name, "column": i, "unit": "degrees"} for i, name in enumerate(JOINTS[:6])),
          {"joint": "gripper_left", "column": 6, "scale": -OPEN, "offset": OPEN}]


def describe(folder, **keys):
    """A dataset.yaml of the shipped arm."""
    camera = {"info": str(SHIPPED / "camera_info.yaml"), "parent": "base_link",
              "pose": str(SHIPPED / "camera_pose.csv"), **keys.pop("camera", {})}
    robot = {"urdf": str(SHIPPED / "arm_description" / "arm.urdf"),
             "packages": {"arm_description": str(SHIPPED / "arm_description")}}
    camera = {key: value for key, value in camera.items() if value is not None}
    whole = {"robot": robot, "camera": camera, "layout": {"columns": ["qpos"]}, "joints": MAPPED, **keys}
    file = folder / "dataset.yaml"
    file.write_text(yaml.safe_dump({key: value for key, value in whole.items() if value is not None}))
    return file


def encoded(image, kind="PNG"):
    out = io.BytesIO()
    Image.fromarray(image).save(out, kind)
    return np.frombuffer(out.getvalue(), np.uint8)


def write_h5(file, arrays):
    with h5py.File(file, "w") as out:
        for name, array in arrays.items():
            if isinstance(array, list):  # encoded images
                made = out.create_dataset(name, len(array), h5py.vlen_dtype(np.uint8))
                for i, one in enumerate(array):
                    made[i] = one
            else:
                out[name] = array
    return file


def masks_of(dataset, episode):
    return np.array([report.link_image for report in dataset.reports(episode)])


def as_robomimic(folder, joints, color):
    given = recorded(joints)
    arrays = {}
    for demo in (0, 10, 2):
        arrays |= {f"data/demo_{demo}/obs/robot0_joint_pos": given[:, :6],
                   f"data/demo_{demo}/obs/robot0_gripper_qpos": given[:, 6:],
                   f"data/demo_{demo}/obs/front_image": color}
    return describe(folder, layout="robomimic", camera={"name": "front"}), write_h5(folder / "d.hdf5", arrays)


def as_aloha(folder, joints, color):
    """Two arms of 7 columns; JPEG images are padded to one length."""
    jpegs = [encoded(image, "JPEG") for image in color]
    padded = np.array([np.pad(of, (0, max(map(len, jpegs)) - len(of))) for of in jpegs])
    other = np.full((len(joints), 7), 1e3)
    second = [{**entry, "column": entry["column"] + 7} for entry in MAPPED]
    arrays = {"observations/qpos": np.hstack([other, recorded(joints)]),
              "observations/images/cam_high": padded, "action": np.zeros((len(joints), 14))}
    description = describe(folder, layout="aloha", camera={"name": "cam_high"}, joints=second)
    return description, write_h5(folder / "episode_0.hdf5", arrays)


def as_robomind(folder, joints, color):
    arrays = {"puppet/joint_position": recorded(joints),
              "observations/rgb_images/camera_top": [encoded(image, "JPEG") for image in color]}
    return describe(folder, layout="robomind", camera={"name": "camera_top"}), write_h5(
        folder / "trajectory.hdf5", arrays)


def as_droid(folder, joints, color):
    """The camera's pose is in the file: x, y, z and angles about the fixed axes x, y, z."""
    pose = penumbra.read_pose_csv(SHIPPED / "camera_pose.csv")
    turn = pose[:3, :3]
    angles = [np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(turn[2, 0]), np.arctan2(turn[1, 0], turn[0, 0])]
    given = recorded(joints)
    state = "observation/robot_state/"
    arrays = {state + "joint_positions": given[:, :6], state + "gripper_position": given[:, 6],
              "observation/camera_extrinsics/12345_left": np.tile([*pose[:3, 3], *angles], (len(joints), 1))}
    return describe(folder, layout="droid", camera={"name": "12345_left", "pose": None}), write_h5(
        folder / "trajectory.h5", arrays)


@pytest.mark.parametrize("layout", [as_robomimic, as_aloha, as_robomind, as_droid])
def test_known_layouts_give_the_renderers_masks(layout, arm, joints, truth, tmp_path):
    color = np.array([frame.color for frame in arm.frames][:len(joints)])
    description, file = layout(tmp_path, joints, color)
    dataset = datasets.Dataset.load(description)
    groups = dataset.groups(file)
    assert groups == (["data/demo_0", "data/demo_2", "data/demo_10"] if layout == as_robomimic else [""])
    for group in groups:
        episode = dataset.read(file, group)
        assert np.allclose(episode.joints, joints, atol=1e-12)
        drawn = masks_of(dataset, episode)
        assert np.mean(drawn != truth) < 1e-5 if layout == as_droid else np.array_equal(drawn, truth)
        if episode.color:
            assert np.abs(episode.color(3).astype(int) - color[3]).mean() < 3


class Items:
    """As LeRobot's data sets: frames by number, images with channels first, from 0 to 1."""

    def __init__(self, episodes, color=None):
        self.rows = [(number, t, row) for number, of in episodes.items() for t, row in enumerate(of)]
        self.color = color

    def __len__(self):
        return len(self.rows)

    def __getitem__(self, i):
        number, t, row = self.rows[i]
        item = {"observation.state": row.astype(np.float32), "episode_index": np.array(number)}
        if self.color is not None:
            item["observation.images.top"] = np.moveaxis(self.color[t] / np.float32(255), -1, 0)
        return item


def test_dictionaries_give_the_same_and_a_faulty_episode_is_left_out(arm, joints, truth, tmp_path):
    color = np.array([frame.color for frame in arm.frames][:len(joints)])
    given = recorded(joints)
    wrong = given.copy()
    wrong[2, 1] = np.nan
    items = Items({4: given, 5: wrong, 6: given[:1]}, color)
    dataset = datasets.Dataset.load(describe(tmp_path, layout="lerobot", camera={"name": "top"}))
    faults = []
    episodes = list(dataset.from_dicts(items, faults.append))
    assert [episode.name for episode in episodes] == ["episode_000004", "episode_000006"]
    [fault] = map(str, faults)
    assert "episode_000005" in fault and "shoulder_lift" in fault and "frame 2" in fault
    assert np.mean(masks_of(dataset, episodes[0]) != truth) < 1e-4  # states are float32
    assert np.array_equal(episodes[0].color(1), color[1])
    refuses("episode_000005", lambda: list(dataset.from_dicts(items)))
    other = datasets.Dataset.load(describe(tmp_path, layout="lerobot", camera={"name": "front"}))
    refuses("images.front is not among the keys: .*images.top", lambda: list(other.from_dicts(items)))


def test_an_npz_file_is_an_episode(joints, truth, tmp_path):
    np.savez(tmp_path / "episode.npz", qpos=recorded(joints))
    dataset = datasets.Dataset.load(describe(tmp_path))
    assert np.array_equal(masks_of(dataset, dataset.read(tmp_path / "episode.npz")), truth)


def test_a_camera_that_moves_has_a_pose_for_each_frame(arm, joints, truth):
    dataset = datasets.Dataset(arm.robot, arm.camera, arm.config)
    poses = np.tile(arm.camera.T_parent_camera, (len(joints), 1, 1))
    poses[1, 2, 3] += 0.1
    drawn = masks_of(dataset, dataset.episode("moving", joints, pose=poses))
    same = [np.array_equal(a, b) for a, b in zip(drawn, truth)]
    assert same == [True, False, True, True, True]


def decode(segmentation):
    """COCO's run lengths as its format describes them, one character and one pixel at a time."""
    height, width = segmentation["size"]
    counts, text = [], segmentation["counts"]
    at = 0
    while at < len(text):
        value, bits, more = 0, 0, True
        while more:
            code = ord(text[at]) - 48
            value |= (code & 31) << bits
            bits, more, at = bits + 5, bool(code & 32), at + 1
        if code & 16:
            value -= 1 << bits
        counts.append(value + (counts[-2] if len(counts) > 2 else 0))
    pixels, of = [], False
    for count in counts:
        pixels += [of] * count
        of = not of
    return np.array(pixels, bool).reshape(width, height).T


def test_all_files_hold_the_renderers_masks(arm, joints, truth, tmp_path):
    dataset = datasets.Dataset(arm.robot, arm.camera, arm.config)
    save = ["rle", "npz", "png", "video", "h264", "prompts"]
    contents = datasets.write(dataset, dataset.episode("mine", joints), tmp_path, save)
    assert contents == json.loads((tmp_path / "report.json").read_text())
    assert contents["robot_pixels"] == np.count_nonzero(truth, axis=(1, 2)).tolist()

    coco = json.loads((tmp_path / "masks.json").read_text())
    assert [image["id"] for image in coco["images"]] == list(range(5))
    for annotation, links in zip(coco["annotations"], truth, strict=True):
        assert np.array_equal(decode(annotation["segmentation"]), links > 0)
        left, top, width, height = annotation["bbox"]
        assert annotation["area"] == np.count_nonzero(links)
        assert annotation["area"] == np.count_nonzero(links[top:top + height, left:left + width])
        assert links[top].any() and links[:, left + width - 1].any()

    stored = np.load(tmp_path / "masks.npz")
    assert np.array_equal(stored["links"], truth) and np.array_equal(stored["joints"], joints)
    assert tuple(stored["names"]) == arm.robot.links
    for t, links in enumerate(truth):
        assert np.array_equal(read_png(tmp_path / "robot_mask" / f"{t:06d}.png"), 255 * (links > 0))
    for video in ("links.mkv", "links.mp4"):
        with av.open(str(tmp_path / video)) as opened:
            planes = [frame.planes[0] for frame in opened.decode(video=0)]
            drawn = [np.frombuffer(of, np.uint8).reshape(HEIGHT, -1)[:, :WIDTH] for of in planes]
        assert np.array_equal(drawn, truth)
    names = json.loads((tmp_path / "links.json").read_text())
    assert {int(value): of["link"] for value, of in names.items()} == dict(enumerate(arm.robot.links, 1))

    frames = json.loads((tmp_path / "prompts.json").read_text())["frames"]
    assert len(frames) == 5
    for frame, links in zip(frames, truth):
        assert len(frame["links"]) >= 4
        for name, prompt in frame["links"].items():
            own = links == arm.robot.links.index(name) + 1
            rows, columns = np.nonzero(own)
            assert prompt["box"] == [columns.min(), rows.min(), columns.max(), rows.max()]
            assert len(prompt["points"]) == 3
            for u, v in prompt["points"]:
                assert own[v - 3:v + 4, u].all() and own[v, u - 3:u + 4].all()


@pytest.mark.parametrize("recording", ["xarm7_realsense", "xarm7_realsense_2"])
def test_prompts_lie_on_the_robot_of_real_images(recording):
    skip_without_data()
    real = Opened(DATA / recording)
    inside = []
    for frame in real.frames:
        file = DATA / recording / f"robot_mask_{frame.index}.png"
        if file.exists():
            mask = read_png(file) > 0
            report = real.session.process(penumbra.Frame(None, frame.pose.positions))
            for prompt in mask_files.prompts(report.link_image.astype(np.uint8)).values():
                inside += [mask[v, u] for u, v in prompt["points"]]
    print(f"{recording}: {np.mean(inside):.4f} of {len(inside)} points")
    assert len(inside) > 50 and np.mean(inside) >= 0.99


def faults(tmp_path, columns, **keys):
    with pytest.raises(penumbra.InputError) as raised:
        datasets.Dataset.load(describe(tmp_path, **keys)).episode("it", columns)
    return str(raised.value)


def test_degrees_and_normalised_grippers_are_found(joints, tmp_path):
    radians = [{key: entry[key] for key in ("joint", "column")} for entry in MAPPED]
    said = faults(tmp_path, recorded(joints), joints=radians)
    assert "unit: degrees" in said and "0.0174533" in said and "-3.1 to 3.1" in said
    half = np.column_stack([joints[:, :6], 1 - joints[:, 6] / OPEN])
    said = faults(tmp_path, half, joints=radians)
    assert "gripper_left" in said and "scale" in said and "degrees" not in said


WRONG = [
    ({"camrea": {}}, "camrea.*camera"),
    ({"camera": {"poes": 1}}, "camera: unknown key poes.*pose"),
    ({"layout": "robomimik"}, "robomimic"),
    ({"layout": {"columns": "qpos", "colour": "x"}}, "colour.*color"),
    ({"joints": MAPPED[:-1]}, "gripper_left.*value"),
    ({"joints": [*MAPPED, {"joint": "elbwo", "column": 3}]}, "elbwo.*elbow"),
    ({"joints": [{**MAPPED[0], "unit": "turns"}, *MAPPED[1:]]}, "turns"),
    ({"joints": [{"joint": "elbow", "scale": 1}]}, "column is needed"),
    ({"camera": {"parent": None}}, "parent is needed"),
    ({"camera": {"pose": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}}, "rigid"),
    ({"clouds": {"voxels": 0.1}}, "voxels.*voxel"),
    ({"tracks": 0}, "tracks.*got 0"),
]


@pytest.mark.parametrize("keys, says", WRONG)
def test_wrong_descriptions_name_the_key(keys, says, tmp_path):
    refuses(says, lambda: datasets.Dataset.load(describe(tmp_path, **keys)))


def test_joints_that_do_not_move_and_columns_in_order(arm, joints, tmp_path):
    fixed = [*MAPPED[:6], {"joint": "gripper_left", "value": 0.02}]
    episode = datasets.Dataset.load(describe(tmp_path, joints=fixed)).episode("it", recorded(joints)[:, :6])
    assert np.all(episode.joints[:, 6] == 0.02)
    for names in (None, list(JOINTS)):
        episode = datasets.Dataset.load(describe(tmp_path, joints=names)).episode("it", joints)
        assert np.array_equal(episode.joints, joints)


def command(*arguments, status):
    return run_python("-m", "penumbra.datasets", *arguments, status=status)


def test_a_batch_goes_on_after_faulty_episodes_and_does_only_what_is_new(joints, truth, tmp_path):
    pytest.importorskip("distributed")
    folder = tmp_path / "in"
    folder.mkdir()
    given = recorded(joints)
    wrong = given.copy()
    wrong[2, 1] = np.nan
    image = np.zeros((len(joints), 48, 64, 3), np.uint8)
    for name, arrays in {
        "good": {"qpos": given}, "empty": {"qpos": given[:0]}, "nan": {"qpos": wrong},
        "other": {"action": given}, "scaled": {"qpos": given / DEGREE}, "narrow": {"qpos": given[:, :4]},
        "small": {"qpos": given, "front": image}, "also_good": {"qpos": given},
    }.items():
        write_h5(folder / f"{name}.hdf5", {"front": np.zeros((len(joints), HEIGHT, WIDTH, 3), np.uint8), **arrays})
    (folder / "text.hdf5").write_text("no HDF5 file")
    description = describe(tmp_path, layout={"columns": "qpos", "color": "front"})
    batch = [folder / "*.hdf5", "-o", tmp_path / "out", "--dataset", description, "--workers", "1", "--save"]
    done = command(*batch, "rle,npz", status=1)
    for says in ("no frames", "shoulder_lift", "qpos is not in the file", "is beyond", "column 4 is missing",
                 "64x48", "text.hdf5"):
        assert says in done.stderr, says
    results = {pathlib.Path(of).parent: of.stat().st_mtime_ns for of in tmp_path.glob("out/*/batch.json")}
    assert len(results) == 9 and "2 done, 7 failed" in done.stdout
    for name in ("good", "also_good"):
        [stored] = tmp_path.glob(f"out/{name}.hdf5-*/run/masks.npz")
        assert np.array_equal(np.load(stored)["links"], truth)

    command(*batch, "rle,npz", status=1)
    assert all((of / "batch.json").stat().st_mtime_ns == time for of, time in results.items())
    command(*batch, "png", status=1)
    assert len(list(tmp_path.glob("out/*/run/robot_mask/*.png"))) == 10
    command(folder / "nan.hdf5", *batch[1:], "rle", status=2)
    assert "prompts" in command(*batch, "masks", status=2).stderr


def test_masks_are_made_again_after_a_change_of_the_robot(joints, tmp_path):
    pytest.importorskip("distributed")
    urdf = tmp_path / "arm.urdf"
    shutil.copy(SHIPPED / "arm_description" / "arm.urdf", urdf)
    description = describe(tmp_path, robot={
        "urdf": str(urdf), "packages": {"arm_description": str(SHIPPED / "arm_description")}})
    file = write_h5(tmp_path / "a.hdf5", {"qpos": recorded(joints)})

    def made():
        datasets.run([file], tmp_path / "out", description, workers=1)
        return [of.stat().st_mtime_ns for of in tmp_path.glob("out/*/batch.json")]

    first = made()
    assert made() == first
    urdf.write_text(urdf.read_text() + "<!-- changed -->")
    assert made() != first


def test_groups_of_one_file_are_episodes_of_a_batch(arm, joints, tmp_path):
    pytest.importorskip("distributed")
    description, file = as_robomimic(tmp_path, joints, np.array([f.color for f in arm.frames][:len(joints)]))
    records = datasets.run([file], tmp_path / "out", description, ["rle"], workers=1)
    assert [record["status"] for record in records] == ["done"] * 3
    assert [record["input"] for record in records] == [f"{file}/data/demo_{i}" for i in (0, 2, 10)]
    assert records[0]["frames"] == 5 and records[0]["pixels_robot"] > 50_000


def test_write_replaces_its_own_files_and_no_others(arm, joints, tmp_path):
    dataset = datasets.Dataset(arm.robot, arm.camera, arm.config)
    out = tmp_path / "out"

    def write(*save):
        datasets.write(dataset, dataset.episode("mine", joints[:2]), out, save)
        return {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}

    assert write("rle", "png") == {"report.json", "masks.json", "robot_mask/000000.png", "robot_mask/000001.png"}
    (out / "notes.txt").write_text("mine")
    (out / "report.json").rename(out / "report.json.penumbra.part")  # as a killed program leaves it
    (out / "robot_mask" / "000007.png").touch()
    assert write("npz") == {"report.json", "masks.npz", "notes.txt"}
    (out / "report.json").unlink()
    refuses("choose another folder", lambda: write("rle"))
    (out / "masks.npz").unlink()
    (out / "robot_mask").rmdir()
    (out / "masks.json").write_text("mine")
    refuses("masks.json", lambda: write("rle"))
    assert (out / "masks.json").read_text() == "mine"


def test_files_without_episodes_or_with_few_images_are_faults(joints, tmp_path):
    file = write_h5(tmp_path / "it.hdf5", {"qpos": recorded(joints), "depth": np.zeros((3, HEIGHT, WIDTH), np.uint16)})
    dataset = datasets.Dataset.load(describe(tmp_path, layout="robomimic"))
    for call in (dataset.groups, dataset.read):
        refuses(r"no group data/\*", lambda: call(file))
    dataset = datasets.Dataset.load(describe(tmp_path, layout={"columns": "qpos", "depth": "depth"}))
    refuses("3 images", lambda: datasets.write(dataset, dataset.read(file), tmp_path / "out", ["clouds"]))


def depth_files(folder, depth, kind):
    if kind == "video":
        with av.open(str(folder / "depth.mkv"), "w") as out:
            stream = out.add_stream("ffv1", rate=30)
            stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "gray16le"
            for image in depth:
                out.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="gray16le")))
            out.mux(stream.encode())
        return "depth.mkv"
    for t, image in enumerate(depth):
        Image.fromarray(image).save(folder / f"depth_{t:03d}.{kind}")
    return f"depth_%03d.{kind}"


CLOUDS = {"frame": "base_link", "crop": [[-1.0, -1.0, -0.2], [1.0, 1.0, 1.0]], "voxel": 0.01, "points": 256,
          "robot_points": 128}


@pytest.mark.parametrize("kind", ["array", "encoded", "metres", "png", "tiff", "video"])
def test_clouds_are_the_pipelines_without_the_robot(kind, arm, joints, tmp_path):
    frames = [frame for frame, _ in zip(arm.frames, joints)]
    depth = np.array([frame.depth for frame in frames])
    color = np.array([frame.color for frame in frames])
    arrays = {"qpos": recorded(joints), "rgb": color}
    place = "depth"
    if kind in ("png", "tiff", "video"):
        place = depth_files(tmp_path, depth, kind)
    elif kind == "encoded":
        arrays["depth"] = [encoded(image) for image in depth]
    else:
        arrays["depth"] = depth if kind == "array" else depth.astype(np.float64) / 1000
    file = write_h5(tmp_path / "episode.hdf5", arrays)
    dataset = datasets.Dataset.load(describe(
        tmp_path, layout={"columns": "qpos", "color": "rgb", "depth": place}, clouds=CLOUDS))
    datasets.write(dataset, dataset.read(file), tmp_path / "out", ["clouds"])
    clouds = np.load(tmp_path / "out" / "clouds.npz")
    assert clouds["points"].shape == (5, 256, 3) and clouds["colors"].shape == (5, 256, 3)
    assert clouds["robot_points"].shape == (5, 128, 3) and (clouds["counts"] == 256).all()
    to_camera = np.linalg.inv(arm.camera.T_parent_camera)
    for t, frame in enumerate(frames):
        image = (frame.depth / 1000).astype(np.float32) if kind == "metres" else frame.depth
        report = arm.session.process(penumbra.Frame(image, frame.pose.positions))
        whole, mask = report.points("base_link", frame.color), np.pad(report.robot_mask, 1)
        chosen = np.hstack([clouds["points"][t], clouds["colors"][t]]).astype(float)
        known = {row.tobytes() for row in np.hstack([whole.points, whole.colors]).astype(float)}
        assert all(row.tobytes() in known for row in chosen)
        assert (np.abs(clouds["points"][t]) <= 1.0001).all()
        cells = np.floor(clouds["points"][t] / 0.01).astype(int)
        assert len(np.unique(cells, axis=0)) == 256
        # The model's points are in the robot's mask, within a pixel.
        at = clouds["robot_points"][t] @ to_camera[:3, :3].T + to_camera[:3, 3]
        k = arm.camera.intrinsics
        u, v = np.rint([at[:, 0] / at[:, 2] * k.fx + k.cx, at[:, 1] / at[:, 2] * k.fy + k.cy]).astype(int) + 1
        seen = (u > 0) & (u <= WIDTH) & (v > 0) & (v <= HEIGHT)
        near = np.max([mask[v[seen] + i, u[seen] + j] for i in (-1, 0, 1) for j in (-1, 0, 1)
                       if (v[seen] + i).max() < HEIGHT + 2 and (u[seen] + j).max() < WIDTH + 2], axis=0)
        assert seen.sum() > 60 and near.all()


@pytest.mark.parametrize("has_depth", [False, True])
def test_tracks_are_the_views_of_points_by_area(has_depth, arm, joints, tmp_path):
    frames = [frame for frame, _ in zip(arm.frames, joints)]
    arrays = {"qpos": recorded(joints)}
    if has_depth:
        arrays["depth"] = np.array([frame.depth for frame in frames])
    file = write_h5(tmp_path / "episode.hdf5", arrays)
    layout = {"columns": "qpos", **({"depth": "depth"} if has_depth else {})}
    dataset = datasets.Dataset.load(describe(tmp_path, layout=layout, tracks=300))
    datasets.write(dataset, dataset.read(file), tmp_path / "out", ["tracks"])
    tracks = np.load(tmp_path / "out" / "tracks.npz")
    assert tracks["pixels"].shape == (5, 300, 2) and tracks["visible"].shape == (5, 300)
    assert tracks["points"].shape == (300, 3) and list(tracks["names"]) == list(arm.robot.links)
    session = penumbra.Session(arm.robot, arm.camera, arm.config.replace(has_depth=has_depth))
    number = arm.robot.links.index("upper_arm") + 1
    mine = tracks["links"] == number
    points = arm.robot.points_on("upper_arm", int(mine.sum()))
    assert np.array_equal(tracks["points"][mine], points) and len(points) > 30
    for t, frame in enumerate(frames):
        report = session.process(frame if has_depth else penumbra.Frame(None, frame.pose.positions))
        views = report.point_views("upper_arm", points)
        assert np.array_equal(tracks["visible"][t, mine], views.visible)
        assert np.array_equal(tracks["hidden_by"][t, mine], views.hidden_by)
        assert np.allclose(tracks["pixels"][t, mine], views.pixels, atol=1e-4)
    assert 50 < tracks["visible"].sum() < 0.6 * 5 * 300  # half of it faces away


def test_points_are_spread_and_few_are_repeated_and_none_are_zeros(arm, joints, tmp_path):
    line = np.zeros((101, 3), np.float32)
    line[:, 0] = np.arange(101)
    assert line[mask_files.farthest_points(line, 5), 0].tolist() == [0, 100, 50, 25, 75]
    frame = arm.frames[0]
    report = arm.session.process(frame)
    options = datasets.CloudOptions(crop=((-9, -9, 0), (9, 9, 9)), voxel=0.5, points=500)
    made = mask_files.cloud(report, options)
    few = len(np.unique(made["points"], axis=0))
    assert made["counts"] == few < 500 == len(made["points"])
    assert mask_files.cloud(report, options._replace(crop=((0, 0, -2), (1, 1, -1))))["counts"] == 0
    dataset = datasets.Dataset(arm.robot, arm.camera, arm.config)
    refuses("no depth", lambda: datasets.write(dataset, dataset.episode("it", joints), tmp_path, ["clouds"]))
