# SPDX-License-Identifier: Apache-2.0
"""Arrays lie where C++ has them, outlive their owners, and never change in silence."""

import gc
import threading
import time
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import penumbra
from conftest import address, only_in_full, Opened, refuses, run_python, SHIPPED


def test_nothing_is_copied_on_the_way_in(opened):
    frame = opened.frames[4]
    assert address(frame.depth) == address(frame.depth)
    depth = frame.depth.copy()
    given = frame.replace(depth=depth)
    assert address(given.depth) == address(depth)
    before = opened.session.process(given).pixels.unknown
    depth[:] = 0  # the frame looks at this very array
    report = opened.session.process(given)
    assert report.status is penumbra.FrameStatus.bad_depth
    assert report.pixels.unknown == depth.size > report.pixels.robot > before


def test_arrays_stay_as_they_are(opened):
    """In a loop that binds arrays to names."""
    alone = Opened(SHIPPED)
    kept = []
    for frame in opened.frames:
        report = opened.session.process(frame)
        labels = report.labels
        assert report.labels is labels and not labels.flags.writeable
        kept.append((labels, report.virtual_depth[10:20, ::2].T, report.link_image, report))
    for frame, (labels, depth, links, report) in zip(alone.frames, kept, strict=True):
        expected = alone.session.process(frame)
        assert np.array_equal(labels, expected.labels)
        assert np.array_equal(depth, expected.virtual_depth[10:20, ::2].T)
        assert np.array_equal(links, expected.link_image)
        assert report.labels is labels, "what was read stays with its report"


def test_old_reports_keep_their_numbers_and_give_no_unread_images(opened):
    old = opened.session.process(opened.frames[0])
    robot, poses = old.pixels.robot, old.T_root_link.copy()
    opened.session.process(opened.frames[8])
    assert old.pixels.robot == robot and old.index == 0
    assert np.array_equal(old.T_root_link, poses)
    refuses("another frame since.*frame 0", lambda: old.labels, ValueError)


def test_stages_give_arrays_that_stay(opened):
    renderer = penumbra.Renderer(penumbra.Backend.cpu, opened.camera.intrinsics, opened.robot.bodies)
    classifier = penumbra.Classifier(640, 480, penumbra.LabelRule())
    registration = penumbra.DepthRegistration(opened.camera, opened.camera)
    poses = opened.session.process(opened.frames[0])
    poses = np.linalg.inv(poses.T_root_camera) @ poses.T_root_link
    shown = renderer.render(poses)
    labelled = classifier.classify(shown, opened.frames[0].depth)
    arrays = (shown.depth, shown.links, labelled.labels, registration.warp(opened.frames[0].depth, np.eye(4)))
    before = [array.copy() for array in arrays]
    poses[:, 0, 3] += 0.3
    moved = renderer.render(poses)
    again = classifier.classify(moved, opened.frames[8].depth)
    registration.warp(opened.frames[8].depth, np.eye(4))
    assert all(np.array_equal(array, same) for array, same in zip(arrays, before))
    assert not np.array_equal(again.labels, labelled.labels)
    assert shown.depth is arrays[0] and labelled.labels is arrays[2]


def test_arrays_outlive_their_owners():
    opened = Opened(SHIPPED, color=True)
    recorded = opened.frames[3]
    report = opened.session.process(recorded)
    arrays = [recorded.depth, recorded.color, report.labels, report.virtual_depth, report.T_root_link,
              opened.robot.meshes(1)[0].vertices, recorded.pose.positions]
    sums = [array.astype(float).sum() for array in arrays]
    gone = weakref.ref(opened)
    del opened, recorded, report
    gc.collect()
    assert gone() is None
    rubbish = [np.random.default_rng(1).random((480, 640)) for _ in range(20)]
    assert [array.astype(float).sum() for array in arrays] == sums and rubbish


def test_every_recorded_frame_has_images_of_its_own(shipped):
    frames = list(shipped.frames)
    assert len({address(frame.depth) for frame in frames}) == len(frames) == 12
    assert np.array_equal(frames[2].depth, shipped.frames[2].depth)


def test_targets_of_a_file_are_values(opened):
    file = opened.targets()
    first = file.of_frame(0)
    assert [t.name for t in first] == ["cube", "cylinder", "lid", "wrist"] and len(file) == 4
    frame = opened.frames[0].replace(targets=first)
    file.of_frame(1)
    assert len(opened.session.process(frame).targets) == 4


SLOW = dict(backend=penumbra.Backend.reference)


def test_other_threads_run_while_a_frame_is_judged():
    opened = Opened(SHIPPED, **SLOW)
    frame = opened.frames[0]
    ticks, done = [0], threading.Event()

    def tick():
        while not done.is_set():
            ticks[0] += 1

    thread = threading.Thread(target=tick)
    thread.start()
    moved = 0
    for _ in range(200):  # one call holds the interpreter throughout, or it does not
        before = ticks[0]
        opened.session.process(frame)
        moved += ticks[0] > before
    done.set()
    thread.join()
    assert moved > 100


def test_a_second_thread_is_refused():
    opened = Opened(SHIPPED, **SLOW)
    frame = opened.frames[0]
    refused = []

    def judge():
        for _ in range(3000):
            if refused:
                break
            try:
                opened.session.process(frame)
            except ValueError as error:
                refused.append(str(error))

    with ThreadPoolExecutor(2) as pool:
        for done in [pool.submit(judge), pool.submit(judge)]:
            done.result()
    assert refused and all("one thread at a time" in message for message in refused)


def test_images_read_in_another_thread_are_those_of_their_report(opened):
    """Or raise, when the session has gone on."""
    frames = list(opened.frames)
    truth = [opened.session.process(frame).virtual_depth for frame in frames]
    latest, done, right, torn = [], threading.Event(), [], []

    def read():
        while not done.is_set():
            try:
                report = latest[0]
                image = report.virtual_depth
            except (IndexError, ValueError):
                continue
            (right if np.array_equal(image, truth[report.index]) else torn).append(1)

    thread = threading.Thread(target=read)
    thread.start()
    for i in range(600):
        latest[:] = [opened.session.process(frames[i % 12].replace(index=i % 12))]
        time.sleep(0.0005 * (i % 3))  # from now and then to hardly ever in time
    while not (right or torn):  # the last report stays readable
        time.sleep(0.001)
    done.set()
    thread.join()
    assert right and not torn


MEMORY = """
import resource, sys
from penumbra import datasets
dataset = datasets.Dataset.load(sys.argv[1])
peaks = []
for file in sys.argv[2:4]:
    datasets.write(dataset, dataset.read(file), sys.argv[4], ["rle", "npz", "video", "prompts"])
    peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print(*peaks)
"""


@only_in_full
def test_data_sets_take_the_same_memory_for_more_frames(tmp_path):
    pytest.importorskip("h5py"), pytest.importorskip("av")
    from test_datasets import describe, recorded, write_h5
    joints = np.array([frame.pose.positions for frame in penumbra.open(SHIPPED)])[:5]
    files = [write_h5(tmp_path / f"{n}.h5", {"qpos": np.resize(recorded(joints), (n, 7))}) for n in (50, 2000)]
    first, last = map(int, run_python("-c", MEMORY, describe(tmp_path), *files, tmp_path / "out").stdout.split())
    assert last - first < 50_000, f"{last - first} kB"
