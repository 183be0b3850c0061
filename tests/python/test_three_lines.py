# SPDX-License-Identifier: Apache-2.0
"""robot_mask() and Session.process(depth, joints): a robot, a camera with its pose, joints."""

import numpy as np
import pytest

import penumbra
from conftest import refuses, SHIPPED

URDF = """<robot name="bar">
  <link name="base"/>
  <link name="bar"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.5 0.1 0.08"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>"""
WIDTH, HEIGHT = 161, 121
K = np.array([[140.3, 0, 83.2], [0, 138.7, 55.4], [0, 0, 1]])
T_ROOT_CAMERA = np.array([[1, 0, 0, 0.1], [0, -1, 0, 0.05], [0, 0, -1, 1.2], [0, 0, 0, 1.0]])  # looks down
CAMERA = penumbra.Camera.from_matrix(K, (WIDTH, HEIGHT), T_parent_camera=T_ROOT_CAMERA)
NAN = float("nan")


def box_on_rays(turn):
    """Which pixels' rays meet the bar: the slab method, in the bar's frame."""
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    rays = np.stack([(u - K[0, 2]) / K[0, 0], (v - K[1, 2]) / K[1, 1], np.ones_like(u)], -1)
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])  # from the root to the bar
    origin = R @ T_ROOT_CAMERA[:3, 3] - [0.2, 0, 0]
    direction = rays @ T_ROOT_CAMERA[:3, :3].T @ R.T
    with np.errstate(divide="ignore"):
        ends = np.stack([(side * np.array([0.25, 0.05, 0.04]) - origin) / direction for side in (-1, 1)])
    near, far = ends.min(0).max(-1), ends.max(0).min(-1)
    return (near <= far) & (near > 0)


@pytest.fixture
def urdf(tmp_path):
    file = tmp_path / "bar.urdf"
    file.write_text(URDF)
    return file


@pytest.mark.parametrize("turn", [0.0, 0.4, -1.3, 2.9])
def test_the_mask_is_the_silhouette(urdf, turn):
    expected = box_on_rays(turn)
    assert expected.sum() > 300
    masks = [penumbra.robot_mask(robot, CAMERA, joints)
             for robot in (urdf, str(urdf), penumbra.Robot.load(urdf)) for joints in ([turn], {"turn": turn})]
    for mask in masks:
        assert mask.dtype == bool and np.array_equal(mask, expected)
    report = penumbra.Session(urdf, CAMERA).process(np.full((HEIGHT, WIDTH), 900, np.uint16), [turn])
    assert np.array_equal(report.robot_mask, expected)


def test_the_mask_of_the_shipped_arm_is_where_the_reference_draws_it():
    given = penumbra.open(SHIPPED)
    renderer = penumbra.Renderer(penumbra.Backend.reference, given.camera.intrinsics, given.robot.bodies)
    for frame in list(given)[::4]:
        links = given.robot.forward_kinematics(frame.pose.positions)
        drawn = renderer.render(np.linalg.inv(given.camera.T_parent_camera) @ links).depth > 0
        mask = penumbra.robot_mask(given.robot, given.camera, frame.pose.positions)
        assert mask.sum() > 10_000 and np.count_nonzero(mask != drawn) <= 4


def test_depth_and_joints_are_a_frame():
    given = penumbra.open(SHIPPED)
    one, other = (penumbra.Session(given.robot, given.camera, given.config) for _ in range(2))
    box = penumbra.Target("box", penumbra.RegionTarget(penumbra.PixelBox(460, 172, 38, 98), expected_depth=1.87))
    for frame in given:
        of_frame = one.process(frame.replace(targets=[box]))
        report = other.process(frame.depth, frame.pose.positions, stamp=frame.stamp, targets=[box])
        assert report.index == of_frame.index and report.stamp == frame.stamp
        assert np.array_equal(report.labels, of_frame.labels)
        assert report.targets[0].verdict is of_frame.targets[0].verdict
    assert report.label(320, 240) is penumbra.Label(report.labels[240, 320])
    for u, v in ((640, 0), (0, 480), (-1, 0), (0, -1)):
        refuses("outside", lambda: report.label(u, v), IndexError)
    kept = report.without_robot()
    assert np.array_equal(kept > 0, (frame.depth > 0) & np.isin(report.labels, [penumbra.Label.clear, penumbra.Label.front]))


BAD_JOINTS = [
    ([], ValueError, "expected 1 position"),
    (None, ValueError, "expected 1 position"),
    ([0.0, 0.0], ValueError, "expected 1 position"),
    ([NAN], ValueError, "'turn' is nan"),
    ({"turn": NAN}, ValueError, "'turn' is nan"),
    ({"tern": 0.0}, KeyError, "tern"),
    ({}, KeyError, "'turn' is missing"),
    ([[0.0]], ValueError, "shape"),
    ("zero", TypeError, ""),
    (penumbra.RobotPose(status=penumbra.FrameStatus.stale_joints, message="too old"), penumbra.InputError, "too old"),
]


@pytest.mark.parametrize("joints, error, says", BAD_JOINTS)
def test_bad_joints_are_errors(urdf, joints, error, says):
    refuses(says, lambda: penumbra.robot_mask(urdf, CAMERA, joints), error)
    if isinstance(joints, penumbra.RobotPose):
        return  # a frame's fault: its status
    session = penumbra.Session(urdf, CAMERA)
    refuses(says, lambda: session.process(np.full((HEIGHT, WIDTH), 900, np.uint16), joints), error)


def test_a_camera_without_a_pose_is_an_error_and_never_at_the_root(urdf):
    nowhere = CAMERA.replace(T_parent_camera=None)
    for use in (lambda: penumbra.robot_mask(urdf, nowhere, [0.0]), lambda: penumbra.Session(urdf, nowhere),
                lambda: penumbra.Session(urdf, nowhere, penumbra.PipelineConfig(has_depth=False))):
        refuses("T_parent_camera", use)


def test_a_mask_that_would_lack_something_is_an_error(tmp_path, urdf):
    lost = tmp_path / "lost.urdf"
    mesh = '<link name="lost"><collision><geometry><mesh filename="none.stl"/></geometry></collision></link>'
    weld = '<joint name="weld" type="fixed"><parent link="bar"/><child link="lost"/></joint>'
    lost.write_text(URDF.replace("</robot>", mesh + weld + "</robot>"))
    refuses("none.stl", lambda: penumbra.robot_mask(lost, CAMERA, [0.0]))
    robot = penumbra.Robot.load(lost, penumbra.RobotOptions(allow_missing_meshes=True))
    refuses("'lost'", lambda: penumbra.robot_mask(robot, CAMERA, [0.0]))
    close = CAMERA.replace(T_parent_camera=np.array([[1, 0, 0, 0.2], [0, -1, 0, 0], [0, 0, -1, 0.045], [0, 0, 0, 1]]))
    refuses("within 1 cm", lambda: penumbra.robot_mask(urdf, close, [0.0]))
    refuses("nowhere.urdf", lambda: penumbra.robot_mask("nowhere.urdf", CAMERA, [0.0]))


class Tensor:
    """What PyTorch and JAX offer of an array."""

    def __init__(self, array, device=(1, 0)):
        self.array, self.device = array, device

    def __dlpack__(self, **options):
        if self.device != (1, 0):
            raise BufferError("it is on a GPU")
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.device


def test_tensors_are_arrays():
    given = penumbra.open(SHIPPED)
    session = penumbra.Session(given.robot, given.camera, given.config)
    depth, joints = given[4].depth.copy(), given[4].pose.positions.copy()
    expected = session.process(depth, joints).labels
    assert np.array_equal(session.process(Tensor(depth), Tensor(joints)).labels, expected)
    scan = penumbra.Scan(Tensor(np.ones((5, 3), np.float32)))
    assert scan.points.shape == (5, 3)
    mask = penumbra.PixelMask(Tensor(np.ones((480, 640), np.uint8)))
    assert mask.mask.all()
    color = Tensor(np.zeros((480, 640, 3), np.uint8))
    assert penumbra.Frame(None, joints, color=color).color.shape == (480, 640, 3)
    refuses("float32", lambda: session.process(Tensor(depth.astype(float)), joints), TypeError)
    refuses("CPU", lambda: session.process(Tensor(depth, device=(2, 0)), joints), TypeError)
