# SPDX-License-Identifier: Apache-2.0
# Made by scripts/python_stubs.py from the module's own signatures.
import enum
import os
import pathlib
from typing import (
    Annotated,
    Dict,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    Tuple,
    Union,
    final,
    overload,
)

from numpy import bool_, float32, float64, int32, uint8, uint16, uint32
from numpy.typing import ArrayLike, NDArray

__version__: str
version: str

class InputError(ValueError): ...

class DeviceError(RuntimeError): ...

class Label(enum.IntEnum):
    clear = 0
    front = 1
    occluded = 2
    unknown = 3
    beyond = 4
    fringe = 5

class ImageSpace(enum.Enum):
    raw = "raw"
    rectified = "rectified"

class Backend(enum.Enum):
    cpu = "cpu"
    gl = "gl"
    reference = "reference"

class DistortionModel(enum.Enum):
    none = "none"
    plumb_bob = "plumb_bob"
    rational_polynomial = "rational_polynomial"
    equidistant = "equidistant"

class BeyondMeans(enum.Enum):
    occluded = "occluded"
    visible = "visible"

class Geometry(enum.Enum):
    collision = "collision"
    visual = "visual"

class JointType(enum.Enum):
    revolute = "revolute"
    continuous = "continuous"
    prismatic = "prismatic"
    fixed = "fixed"
    planar = "planar"
    floating = "floating"

class JointStatus(enum.Enum):
    ok = "ok"
    missing = "missing"
    stale = "stale"
    disputed = "disputed"

class PoseSource(enum.Enum):
    joints = "joints"
    transforms = "transforms"
    both = "both"

class FrameStatus(enum.Enum):
    ok = "ok"
    missing_joints = "missing_joints"
    stale_joints = "stale_joints"
    missing_link = "missing_link"
    missing_depth = "missing_depth"
    bad_depth = "bad_depth"
    missing_transform = "missing_transform"
    stale_transform = "stale_transform"
    poses_disagree = "poses_disagree"

class Verdict(enum.Enum):
    visible = "visible"
    partial = "partial"
    hidden = "hidden"
    unknown = "unknown"
    out_of_view = "out_of_view"

class Extent(enum.Enum):
    amodal = "amodal"
    modal = "modal"

class Source(enum.Enum):
    measured = "measured"
    predicted = "predicted"
    held = "held"
    lost = "lost"

class Outcome(enum.Enum):
    accepted = "accepted"
    refused_verdict = "refused_verdict"
    refused_gate = "refused_gate"
    refused_late = "refused_late"
    refused_invalid = "refused_invalid"

class Motion(enum.Enum):
    constant_twist = "constant_twist"
    constant_velocity = "constant_velocity"
    along_direction = "along_direction"
    still = "still"

class PointMotion(enum.Enum):
    hold = "hold"
    constant_velocity = "constant_velocity"

@final
class Intrinsics:
    def __init__(
        self,
        width: int,
        height: int,
        fx: float,
        fy: float,
        cx: float,
        cy: float,
    ) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...
    def binned(self, bx: int, by: int) -> Intrinsics: ...
    def cropped(self, x: int, y: int, width: int, height: int) -> Intrinsics: ...
    def ray(self, u: float, v: float) -> Annotated[NDArray[float64], '(3,)']: ...
    def project(
        self,
        point: Annotated[ArrayLike, '(3,)'],
    ) -> Annotated[NDArray[float64], '(2,)']: ...

@final
class Distortion:
    @overload
    def __init__(self) -> None: ...
    @overload
    def __init__(self, name: str, coefficients: Sequence[float]) -> None: ...
    @property
    def model(self) -> DistortionModel: ...
    @property
    def is_none(self) -> bool: ...
    @property
    def max_radius(self) -> float: ...
    def distort(
        self,
        undistorted: Annotated[ArrayLike, '(2,)'],
    ) -> Annotated[NDArray[float64], '(2,)']: ...
    def undistort(
        self,
        distorted: Annotated[ArrayLike, '(2,)'],
    ) -> Optional[Annotated[NDArray[float64], '(2,)']]: ...

@final
class DepthRange:
    def __init__(self, *, near: float = ..., far: float = ...) -> None: ...
    @property
    def near(self) -> float: ...
    @property
    def far(self) -> float: ...
    def replace(self, *, near: float = ..., far: float = ...) -> DepthRange: ...

@final
class Camera:
    def __init__(
        self,
        intrinsics: Intrinsics,
        *,
        distortion: Distortion = ...,
        range: DepthRange = ...,
        frame_id: str = ...,
    ) -> None: ...
    @property
    def intrinsics(self) -> Intrinsics: ...
    @property
    def distortion(self) -> Distortion: ...
    @property
    def range(self) -> DepthRange: ...
    @property
    def frame_id(self) -> str: ...

def read_camera_info(file: Union[str, os.PathLike[str]], *, rectified: bool) -> Camera: ...

def read_pose_csv(file: Union[str, os.PathLike[str]]) -> Annotated[NDArray[float64], '(4, 4)']: ...

@final
class Rectification:
    def __init__(self, raw: Camera) -> None: ...
    @property
    def pinhole(self) -> Intrinsics: ...
    @property
    def half_angle(self) -> float: ...
    @property
    def raw_to_pinhole(self) -> Annotated[NDArray[int32], '(H, W)']: ...
    @property
    def pinhole_to_raw(self) -> Annotated[NDArray[int32], '(H, W)']: ...

@final
class DepthRegistration:
    def __init__(self, from_camera: Camera, to_camera: Camera) -> None: ...
    def warp(
        self,
        depth: Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)'],
        T_to_from: Annotated[ArrayLike, '(4, 4)'],
    ) -> Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)']: ...

@final
class TriangleMesh:
    def __init__(
        self,
        vertices: Annotated[NDArray[float32], '(N, 3)'],
        triangles: Annotated[NDArray[uint32], '(M, 3)'],
    ) -> None: ...
    @property
    def vertices(self) -> Annotated[NDArray[float32], '(N, 3)']: ...
    @property
    def triangles(self) -> Annotated[NDArray[uint32], '(M, 3)']: ...

@final
class Body:
    def __init__(self, name: str, meshes: Sequence[TriangleMesh]) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def meshes(self) -> Tuple[TriangleMesh, ...]: ...

@final
class ExtraMesh:
    def __init__(self, *, link: str = ..., mesh: Union[str, os.PathLike[str]] = ...) -> None: ...
    @property
    def link(self) -> str: ...
    @property
    def mesh(self) -> pathlib.Path: ...
    def replace(
        self,
        *,
        link: str = ...,
        mesh: Union[str, os.PathLike[str]] = ...,
    ) -> ExtraMesh: ...

@final
class RobotOptions:
    def __init__(
        self,
        *,
        packages: Mapping[str, Union[str, os.PathLike[str]]] = ...,
        geometry: Geometry = ...,
        geometry_of_links: Mapping[str, Geometry] = ...,
        geometry_fallback: bool = ...,
        ignore_links: Sequence[str] = ...,
        only_links: Sequence[str] = ...,
        margins: Mapping[str, float] = ...,
        extra: Sequence[ExtraMesh] = ...,
        allow_missing_meshes: bool = ...,
    ) -> None: ...
    @property
    def packages(self) -> Mapping[str, pathlib.Path]: ...
    @property
    def geometry(self) -> Geometry: ...
    @property
    def geometry_of_links(self) -> Mapping[str, Geometry]: ...
    @property
    def geometry_fallback(self) -> bool: ...
    @property
    def ignore_links(self) -> Tuple[str, ...]: ...
    @property
    def only_links(self) -> Tuple[str, ...]: ...
    @property
    def margins(self) -> Mapping[str, float]: ...
    @property
    def extra(self) -> Tuple[ExtraMesh, ...]: ...
    @property
    def allow_missing_meshes(self) -> bool: ...
    def replace(
        self,
        *,
        packages: Mapping[str, Union[str, os.PathLike[str]]] = ...,
        geometry: Geometry = ...,
        geometry_of_links: Mapping[str, Geometry] = ...,
        geometry_fallback: bool = ...,
        ignore_links: Sequence[str] = ...,
        only_links: Sequence[str] = ...,
        margins: Mapping[str, float] = ...,
        extra: Sequence[ExtraMesh] = ...,
        allow_missing_meshes: bool = ...,
    ) -> RobotOptions: ...

@final
class LinkReport:
    @property
    def link(self) -> str: ...
    @property
    def drawn(self) -> bool: ...
    @property
    def missing(self) -> bool: ...
    @property
    def fault(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def sources(self) -> Tuple[str, ...]: ...
    @property
    def triangles(self) -> int: ...
    @property
    def watertight(self) -> bool: ...
    @property
    def margin(self) -> float: ...
    @property
    def load_ms(self) -> float: ...

@final
class Joint:
    @property
    def name(self) -> str: ...
    @property
    def type(self) -> JointType: ...
    @property
    def parent(self) -> int: ...
    @property
    def child(self) -> int: ...
    @property
    def origin(self) -> Annotated[NDArray[float64], '(4, 4)']: ...
    @property
    def axis(self) -> Annotated[NDArray[float64], '(3,)']: ...
    @property
    def velocity(self) -> Optional[float]: ...
    @property
    def lower(self) -> Optional[float]: ...
    @property
    def upper(self) -> Optional[float]: ...
    @property
    def variable(self) -> Optional[int]: ...
    @property
    def multiplier(self) -> float: ...
    @property
    def offset(self) -> float: ...
    @property
    def mimics(self) -> bool: ...

@final
class Robot:
    @staticmethod
    def load(urdf: Union[str, os.PathLike[str]], options: RobotOptions = ...) -> Robot: ...
    @staticmethod
    def parse(
        xml: str,
        folder: Union[str, os.PathLike[str]],
        options: RobotOptions = ...,
    ) -> Robot: ...
    @property
    def name(self) -> str: ...
    @property
    def links(self) -> Tuple[str, ...]: ...
    @property
    def joints(self) -> Tuple[Joint, ...]: ...
    @property
    def variables(self) -> Tuple[str, ...]: ...
    @property
    def report(self) -> Tuple[LinkReport, ...]: ...
    @property
    def notes(self) -> Tuple[str, ...]: ...
    @property
    def bodies(self) -> Tuple[Body, ...]: ...
    def find_link(self, name: str) -> Optional[int]: ...
    def find_variable(self, name: str) -> Optional[int]: ...
    def rest_positions(self) -> Annotated[NDArray[float64], '(N,)']: ...
    def meshes(self, link: int) -> Tuple[TriangleMesh, ...]: ...
    def forward_kinematics(
        self,
        positions: Annotated[ArrayLike, '(N,)'],
    ) -> Annotated[NDArray[float64], '(N, 4, 4)']: ...

@final
class JointBufferOptions:
    def __init__(
        self,
        *,
        max_gap: float = ...,
        history: float = ...,
        max_states: int = ...,
        compare_sources: bool = ...,
    ) -> None: ...
    @property
    def max_gap(self) -> float: ...
    @property
    def history(self) -> float: ...
    @property
    def max_states(self) -> int: ...
    @property
    def compare_sources(self) -> bool: ...
    def replace(
        self,
        *,
        max_gap: float = ...,
        history: float = ...,
        max_states: int = ...,
        compare_sources: bool = ...,
    ) -> JointBufferOptions: ...

@final
class JointGap:
    @property
    def variable(self) -> int: ...
    @property
    def why(self) -> JointStatus: ...
    @property
    def last_seen(self) -> Optional[int]: ...
    @property
    def jump(self) -> Optional[float]: ...
    @property
    def source(self) -> str: ...

@final
class JointDispute:
    @property
    def variable(self) -> int: ...
    @property
    def stamp(self) -> int: ...
    @property
    def sources(self) -> Tuple[str, ...]: ...
    @property
    def values(self) -> Tuple[float, ...]: ...

@final
class JointAnswer:
    @property
    def status(self) -> JointStatus: ...
    @property
    def positions(self) -> Tuple[float, ...]: ...
    @property
    def age(self) -> int: ...
    @property
    def gaps(self) -> Tuple[JointGap, ...]: ...
    @property
    def disputes(self) -> Tuple[JointDispute, ...]: ...

@final
class JointBuffer:
    def __init__(self, robot: Robot, options: JointBufferOptions = ...) -> None: ...
    def insert(
        self,
        stamp: int,
        names: Sequence[str],
        positions: Annotated[ArrayLike, '(N,)'],
        source: str = ...,
    ) -> int: ...
    def at(self, stamp: int) -> JointAnswer: ...
    def complete_until(self) -> Optional[int]: ...
    def clear(self) -> None: ...
    @property
    def refused_values(self) -> int: ...

@final
class RendererOptions:
    def __init__(self, *, threads: int = ..., isa: str = ..., gl_device: int = ...) -> None: ...
    @property
    def threads(self) -> int: ...
    @property
    def isa(self) -> str: ...
    @property
    def gl_device(self) -> int: ...
    def replace(
        self,
        *,
        threads: int = ...,
        isa: str = ...,
        gl_device: int = ...,
    ) -> RendererOptions: ...

@final
class RendererInfo:
    @property
    def backend(self) -> Backend: ...
    @property
    def isa(self) -> str: ...
    @property
    def threads(self) -> int: ...
    @property
    def device(self) -> str: ...

@final
class GlDevice:
    @property
    def name(self) -> str: ...
    @property
    def version(self) -> str: ...
    @property
    def vendor(self) -> str: ...
    @property
    def software(self) -> bool: ...
    @property
    def fault(self) -> str: ...

def gl_devices() -> List[GlDevice]: ...

@final
class VirtualDepth:
    @property
    def depth(self) -> Annotated[NDArray[float32], '(H, W)']: ...
    @property
    def links(self) -> Annotated[NDArray[uint16], '(H, W)']: ...

@final
class Renderer:
    def __init__(
        self,
        backend: Backend,
        intrinsics: Intrinsics,
        bodies: Sequence[Body],
        options: RendererOptions = ...,
    ) -> None: ...
    def render(self, T_camera_body: Annotated[ArrayLike, '(N, 4, 4)']) -> VirtualDepth: ...
    def submit(self, T_camera_body: Annotated[ArrayLike, '(N, 4, 4)']) -> None: ...
    def collect(self) -> VirtualDepth: ...
    @property
    def pending(self) -> int: ...
    @property
    def max_pending(self) -> int: ...
    @property
    def intrinsics(self) -> Intrinsics: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def info(self) -> RendererInfo: ...

@final
class Tolerance:
    def __init__(self, *, a: float = ..., b: float = ..., c: float = ...) -> None: ...
    @property
    def a(self) -> float: ...
    @property
    def b(self) -> float: ...
    @property
    def c(self) -> float: ...
    def replace(self, *, a: float = ..., b: float = ..., c: float = ...) -> Tolerance: ...
    def at(self, z: float) -> float: ...

@final
class LabelRule:
    def __init__(
        self,
        *,
        tolerance: Tolerance = ...,
        beyond_factor: float = ...,
        front_min_width: int = ...,
        edge_margin: int = ...,
        fringe_reach: int = ...,
        fold_beyond: bool = ...,
        range: DepthRange = ...,
    ) -> None: ...
    @property
    def tolerance(self) -> Tolerance: ...
    @property
    def beyond_factor(self) -> float: ...
    @property
    def front_min_width(self) -> int: ...
    @property
    def edge_margin(self) -> int: ...
    @property
    def fringe_reach(self) -> int: ...
    @property
    def fold_beyond(self) -> bool: ...
    @property
    def range(self) -> DepthRange: ...
    def replace(
        self,
        *,
        tolerance: Tolerance = ...,
        beyond_factor: float = ...,
        front_min_width: int = ...,
        edge_margin: int = ...,
        fringe_reach: int = ...,
        fold_beyond: bool = ...,
        range: DepthRange = ...,
    ) -> LabelRule: ...
    @staticmethod
    def paper() -> LabelRule: ...
    @staticmethod
    def for_sensor(name: str) -> LabelRule: ...
    def check(self) -> None: ...

@final
class Labels:
    @property
    def labels(self) -> Annotated[NDArray[uint8], '(H, W)']: ...
    @property
    def pixels(self) -> Dict[Label, int]: ...

@final
class Classifier:
    def __init__(self, width: int, height: int, rule: LabelRule, isa: str = ...) -> None: ...
    @overload
    def classify(
        self,
        virtual_depth: VirtualDepth,
        measured: Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)'],
    ) -> Labels: ...
    @overload
    def classify(
        self,
        virtual_depth: Annotated[NDArray[float32], '(H, W)'],
        measured: Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)'],
    ) -> Labels: ...
    @property
    def rule(self) -> LabelRule: ...
    @property
    def isa(self) -> str: ...

@final
class PoseTrackerConfig:
    def __init__(
        self,
        *,
        motion: Motion = ...,
        direction: Annotated[ArrayLike, '(3,)'] = ...,
        speed: Optional[float] = ...,
        position_sigma: float = ...,
        orientation_sigma: float = ...,
        acceleration: float = ...,
        angular_acceleration: float = ...,
        drift: float = ...,
        angular_drift: float = ...,
        speed_sigma: float = ...,
        angular_speed_sigma: float = ...,
        timeout: float = ...,
        gate: float = ...,
        gate_patience: int = ...,
        memory: float = ...,
        max_estimates: int = ...,
        worst: Verdict = ...,
    ) -> None: ...
    @property
    def motion(self) -> Motion: ...
    @property
    def direction(self) -> Annotated[NDArray[float64], '(3,)']: ...
    @property
    def speed(self) -> Optional[float]: ...
    @property
    def position_sigma(self) -> float: ...
    @property
    def orientation_sigma(self) -> float: ...
    @property
    def acceleration(self) -> float: ...
    @property
    def angular_acceleration(self) -> float: ...
    @property
    def drift(self) -> float: ...
    @property
    def angular_drift(self) -> float: ...
    @property
    def speed_sigma(self) -> float: ...
    @property
    def angular_speed_sigma(self) -> float: ...
    @property
    def timeout(self) -> float: ...
    @property
    def gate(self) -> float: ...
    @property
    def gate_patience(self) -> int: ...
    @property
    def memory(self) -> float: ...
    @property
    def max_estimates(self) -> int: ...
    @property
    def worst(self) -> Verdict: ...
    def replace(
        self,
        *,
        motion: Motion = ...,
        direction: Annotated[ArrayLike, '(3,)'] = ...,
        speed: Optional[float] = ...,
        position_sigma: float = ...,
        orientation_sigma: float = ...,
        acceleration: float = ...,
        angular_acceleration: float = ...,
        drift: float = ...,
        angular_drift: float = ...,
        speed_sigma: float = ...,
        angular_speed_sigma: float = ...,
        timeout: float = ...,
        gate: float = ...,
        gate_patience: int = ...,
        memory: float = ...,
        max_estimates: int = ...,
        worst: Verdict = ...,
    ) -> PoseTrackerConfig: ...
    def check(self) -> None: ...

@final
class PointTrackerConfig:
    def __init__(
        self,
        *,
        motion: PointMotion = ...,
        sigma: float = ...,
        acceleration: float = ...,
        speed_sigma: float = ...,
        held_speed: float = ...,
        timeout: float = ...,
        gate: float = ...,
        gate_patience: int = ...,
        memory: float = ...,
        max_estimates: int = ...,
        worst: Verdict = ...,
    ) -> None: ...
    @property
    def motion(self) -> PointMotion: ...
    @property
    def sigma(self) -> float: ...
    @property
    def acceleration(self) -> float: ...
    @property
    def speed_sigma(self) -> float: ...
    @property
    def held_speed(self) -> float: ...
    @property
    def timeout(self) -> float: ...
    @property
    def gate(self) -> float: ...
    @property
    def gate_patience(self) -> int: ...
    @property
    def memory(self) -> float: ...
    @property
    def max_estimates(self) -> int: ...
    @property
    def worst(self) -> Verdict: ...
    def replace(
        self,
        *,
        motion: PointMotion = ...,
        sigma: float = ...,
        acceleration: float = ...,
        speed_sigma: float = ...,
        held_speed: float = ...,
        timeout: float = ...,
        gate: float = ...,
        gate_patience: int = ...,
        memory: float = ...,
        max_estimates: int = ...,
        worst: Verdict = ...,
    ) -> PointTrackerConfig: ...
    def check(self) -> None: ...

@final
class TrackedPose:
    @property
    def source(self) -> Source: ...
    @property
    def age(self) -> float: ...
    @property
    def pose(self) -> Annotated[NDArray[float64], '(4, 4)']: ...
    @property
    def twist(self) -> Annotated[NDArray[float64], '(6,)']: ...
    @property
    def covariance(self) -> Annotated[NDArray[float64], '(6, 6)']: ...

@final
class TrackedPoint:
    @property
    def source(self) -> Source: ...
    @property
    def age(self) -> float: ...
    @property
    def position(self) -> Annotated[NDArray[float64], '(3,)']: ...
    @property
    def velocity(self) -> Annotated[NDArray[float64], '(3,)']: ...
    @property
    def covariance(self) -> Annotated[NDArray[float64], '(3, 3)']: ...

@final
class PoseTracker:
    def __init__(self, config: PoseTrackerConfig = ...) -> None: ...
    def update(
        self,
        stamp: int,
        pose: Annotated[ArrayLike, '(4, 4)'],
        verdict: Verdict,
        *,
        covariance: Optional[Annotated[ArrayLike, '(6, 6)']] = ...,
    ) -> Outcome: ...
    def at(self, stamp: int) -> TrackedPose: ...
    def reset(self) -> None: ...

@final
class PointTracker:
    def __init__(self, config: PointTrackerConfig = ...) -> None: ...
    def update(
        self,
        stamp: int,
        position: Annotated[ArrayLike, '(3,)'],
        verdict: Verdict,
        *,
        covariance: Optional[Annotated[ArrayLike, '(3, 3)']] = ...,
    ) -> Outcome: ...
    def at(self, stamp: int) -> TrackedPoint: ...
    def reset(self) -> None: ...

@final
class PixelBox:
    def __init__(self, u: float, v: float, width: float, height: float) -> None: ...
    @property
    def u(self) -> float: ...
    @property
    def v(self) -> float: ...
    @property
    def width(self) -> float: ...
    @property
    def height(self) -> float: ...

@final
class PixelPolygon:
    def __init__(self, corners: Annotated[ArrayLike, '(N, 2)']) -> None: ...

@final
class PixelEllipse:
    def __init__(
        self,
        *,
        centre: Annotated[ArrayLike, '(2,)'] = ...,
        semi_axes: Annotated[ArrayLike, '(2,)'] = ...,
        angle: float = ...,
    ) -> None: ...
    @property
    def centre(self) -> Annotated[NDArray[float64], '(2,)']: ...
    @property
    def semi_axes(self) -> Annotated[NDArray[float64], '(2,)']: ...
    @property
    def angle(self) -> float: ...
    def replace(
        self,
        *,
        centre: Annotated[ArrayLike, '(2,)'] = ...,
        semi_axes: Annotated[ArrayLike, '(2,)'] = ...,
        angle: float = ...,
    ) -> PixelEllipse: ...

@final
class PixelMask:
    def __init__(
        self,
        mask: Annotated[Union[NDArray[uint8], NDArray[bool_]], '(H, W)'],
    ) -> None: ...
    @property
    def mask(self) -> Annotated[NDArray[uint8], '(H, W)']: ...

@final
class RunLengthMask:
    def __init__(self, width: int, height: int, counts: Sequence[int]) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def counts(self) -> Tuple[int, ...]: ...

@final
class RenderedRegion:
    def __init__(self, depth: Annotated[NDArray[float32], '(H, W)']) -> None: ...
    @property
    def depth(self) -> Annotated[NDArray[float32], '(H, W)']: ...

def check_region(
    region: Union[PixelBox, PixelPolygon, PixelMask, RunLengthMask, PixelEllipse, RenderedRegion],
    width: int,
    height: int,
) -> None: ...

@final
class TargetThresholds:
    def __init__(
        self,
        *,
        partial_enter: float = ...,
        partial_leave: float = ...,
        hidden_enter: float = ...,
        hidden_leave: float = ...,
        unknown_limit: Optional[float] = ...,
        past_limit: float = ...,
        min_measured: float = ...,
        min_inside: float = ...,
        beyond_hides: bool = ...,
        others_hide: bool = ...,
        point_min_pixels: int = ...,
        point_min_fraction: float = ...,
    ) -> None: ...
    @property
    def partial_enter(self) -> float: ...
    @property
    def partial_leave(self) -> float: ...
    @property
    def hidden_enter(self) -> float: ...
    @property
    def hidden_leave(self) -> float: ...
    @property
    def unknown_limit(self) -> Optional[float]: ...
    @property
    def past_limit(self) -> float: ...
    @property
    def min_measured(self) -> float: ...
    @property
    def min_inside(self) -> float: ...
    @property
    def beyond_hides(self) -> bool: ...
    @property
    def others_hide(self) -> bool: ...
    @property
    def point_min_pixels(self) -> int: ...
    @property
    def point_min_fraction(self) -> float: ...
    def replace(
        self,
        *,
        partial_enter: float = ...,
        partial_leave: float = ...,
        hidden_enter: float = ...,
        hidden_leave: float = ...,
        unknown_limit: Optional[float] = ...,
        past_limit: float = ...,
        min_measured: float = ...,
        min_inside: float = ...,
        beyond_hides: bool = ...,
        others_hide: bool = ...,
        point_min_pixels: int = ...,
        point_min_fraction: float = ...,
    ) -> TargetThresholds: ...
    def check(self) -> None: ...

@final
class RegionTarget:
    def __init__(
        self,
        region: Union[PixelBox, PixelPolygon, PixelMask, RunLengthMask, PixelEllipse, RenderedRegion],
        *,
        extent: Extent = ...,
        expected_depth: Optional[float] = ...,
    ) -> None: ...
    @property
    def extent(self) -> Extent: ...
    @property
    def expected_depth(self) -> Optional[float]: ...

@final
class KeypointTarget:
    def __init__(
        self,
        *,
        pixel: Annotated[ArrayLike, '(2,)'] = ...,
        score: float = ...,
        min_score: float = ...,
        semi_axes: Annotated[ArrayLike, '(2,)'] = ...,
        angle: float = ...,
        in_metres: bool = ...,
        expected_depth: Optional[float] = ...,
    ) -> None: ...
    @property
    def pixel(self) -> Annotated[NDArray[float64], '(2,)']: ...
    @property
    def score(self) -> float: ...
    @property
    def min_score(self) -> float: ...
    @property
    def semi_axes(self) -> Annotated[NDArray[float64], '(2,)']: ...
    @property
    def angle(self) -> float: ...
    @property
    def in_metres(self) -> bool: ...
    @property
    def expected_depth(self) -> Optional[float]: ...
    def replace(
        self,
        *,
        pixel: Annotated[ArrayLike, '(2,)'] = ...,
        score: float = ...,
        min_score: float = ...,
        semi_axes: Annotated[ArrayLike, '(2,)'] = ...,
        angle: float = ...,
        in_metres: bool = ...,
        expected_depth: Optional[float] = ...,
    ) -> KeypointTarget: ...

@final
class PointTarget:
    def __init__(
        self,
        position: Annotated[ArrayLike, '(3,)'],
        *,
        radius: float = ...,
        frame: Optional[str] = ...,
    ) -> None: ...
    @property
    def position(self) -> Annotated[NDArray[float64], '(3,)']: ...
    @property
    def radius(self) -> float: ...
    @property
    def frame(self) -> Optional[str]: ...

@final
class BoxTarget:
    def __init__(
        self,
        pose: Annotated[ArrayLike, '(4, 4)'],
        size: Annotated[ArrayLike, '(3,)'],
        *,
        frame: Optional[str] = ...,
    ) -> None: ...
    @property
    def pose(self) -> Annotated[NDArray[float64], '(4, 4)']: ...
    @property
    def size(self) -> Annotated[NDArray[float64], '(3,)']: ...
    @property
    def frame(self) -> Optional[str]: ...

@final
class MeshTarget:
    def __init__(
        self,
        mesh: TriangleMesh,
        pose: Annotated[ArrayLike, '(4, 4)'],
        *,
        frame: Optional[str] = ...,
    ) -> None: ...
    @property
    def mesh(self) -> TriangleMesh: ...
    @property
    def pose(self) -> Annotated[NDArray[float64], '(4, 4)']: ...
    @property
    def frame(self) -> Optional[str]: ...

@final
class TargetEstimate:
    def __init__(
        self,
        value: Annotated[ArrayLike, '(4, 4) or (3,)'],
        *,
        stamp: Optional[int] = ...,
        frame: Optional[str] = ...,
        covariance: Optional[Annotated[ArrayLike, '(6, 6)']] = ...,
    ) -> None: ...

@final
class Target:
    def __init__(
        self,
        name: str,
        shape: Union[None, RegionTarget, KeypointTarget, PointTarget, BoxTarget, MeshTarget],
        *,
        has_identity: bool = ...,
        frame_id: str = ...,
        stamp: Optional[int] = ...,
        depth_margin: float = ...,
        thresholds: TargetThresholds = ...,
        handling: Union[None, PoseTrackerConfig, PointTrackerConfig] = ...,
        estimate: Optional[TargetEstimate] = ...,
        fault: str = ...,
    ) -> None: ...
    @property
    def name(self) -> str: ...
    def check(self) -> None: ...

@final
class SourceTargets:
    def __len__(self) -> int: ...
    @property
    def names(self) -> Tuple[str, ...]: ...

@final
class Blame:
    @property
    def link(self) -> str: ...
    @property
    def fraction(self) -> float: ...

@final
class Judgement:
    @property
    def covered(self) -> int: ...
    @property
    def inside(self) -> int: ...
    @property
    def occluded(self) -> float: ...
    @property
    def front(self) -> float: ...
    @property
    def unknown(self) -> float: ...
    @property
    def clear(self) -> float: ...
    @property
    def hidden_by_other(self) -> Optional[float]: ...
    @property
    def measured(self) -> Optional[float]: ...
    @property
    def seen_past(self) -> Optional[float]: ...
    @property
    def blame(self) -> Tuple[Blame, ...]: ...
    @property
    def point_pixels(self) -> int: ...
    @property
    def point_spread(self) -> float: ...

@final
class HandledTarget:
    @property
    def source(self) -> Source: ...
    @property
    def age(self) -> float: ...
    @property
    def position(self) -> Optional[Annotated[NDArray[float64], '(3,)']]: ...
    @property
    def orientation(self) -> Optional[Annotated[NDArray[float64], '(4,) x y z w']]: ...
    @property
    def sigma(self) -> float: ...

@final
class TargetReport:
    @property
    def name(self) -> str: ...
    @property
    def stamp(self) -> Optional[int]: ...
    @property
    def verdict(self) -> Verdict: ...
    @property
    def reason(self) -> str: ...
    @property
    def judgement(self) -> Optional[Judgement]: ...
    @property
    def point(self) -> Optional[Annotated[NDArray[float64], '(3,)']]: ...
    @property
    def handled(self) -> Optional[HandledTarget]: ...
    @property
    def estimate(self) -> Optional[Outcome]: ...

@final
class Frame:
    def __init__(
        self,
        depth: Optional[Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)']],
        joints: Union[None, JointAnswer, Annotated[ArrayLike, '(N,)']],
        *,
        stamp: Optional[int] = ...,
        targets: Union[Sequence[Target], SourceTargets] = ...,
        T_root_link: Optional[Annotated[ArrayLike, '(N, 4, 4)']] = ...,
        T_parent_camera: Optional[Annotated[ArrayLike, '(4, 4)']] = ...,
        source_status: FrameStatus = ...,
        source_message: str = ...,
        index: Optional[int] = ...,
        joint_age: Optional[int] = ...,
        doubted_links: Sequence[int] = ...,
        doubt: str = ...,
    ) -> None: ...
    @property
    def depth(self) -> Optional[Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)']]: ...
    @property
    def joints(self) -> Union[None, JointAnswer, Annotated[NDArray[float64], '(N,)']]: ...
    @property
    def stamp(self) -> Optional[int]: ...
    @property
    def targets(self) -> Union[List[Target], SourceTargets]: ...
    @property
    def T_root_link(self) -> Optional[Annotated[NDArray[float64], '(N, 4, 4)']]: ...
    @property
    def T_parent_camera(self) -> Optional[Annotated[NDArray[float64], '(4, 4)']]: ...
    @property
    def source_status(self) -> FrameStatus: ...
    @property
    def source_message(self) -> str: ...
    @property
    def index(self) -> Optional[int]: ...
    @property
    def joint_age(self) -> Optional[int]: ...
    @property
    def doubted_links(self) -> List[int]: ...
    @property
    def doubt(self) -> str: ...
    def replace(
        self,
        *,
        depth: Optional[Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)']] = ...,
        joints: Union[None, JointAnswer, Annotated[ArrayLike, '(N,)']] = ...,
        stamp: Optional[int] = ...,
        targets: Union[Sequence[Target], SourceTargets] = ...,
        T_root_link: Optional[Annotated[ArrayLike, '(N, 4, 4)']] = ...,
        T_parent_camera: Optional[Annotated[ArrayLike, '(4, 4)']] = ...,
        source_status: FrameStatus = ...,
        source_message: str = ...,
        index: Optional[int] = ...,
        joint_age: Optional[int] = ...,
        doubted_links: Sequence[int] = ...,
        doubt: str = ...,
    ) -> Frame: ...

@final
class PixelCounts:
    @property
    def robot(self) -> Optional[int]: ...
    @property
    def front(self) -> int: ...
    @property
    def occluded(self) -> int: ...
    @property
    def unknown(self) -> int: ...
    @property
    def beyond(self) -> int: ...
    @property
    def fringe(self) -> int: ...
    @property
    def uncovered(self) -> int: ...

@final
class StageTimes:
    @property
    def kinematics(self) -> Optional[float]: ...
    @property
    def render(self) -> Optional[float]: ...
    @property
    def classify(self) -> Optional[float]: ...
    @property
    def targets(self) -> Optional[float]: ...

@final
class FrameReport:
    @property
    def index(self) -> int: ...
    @property
    def stamp(self) -> Optional[int]: ...
    @property
    def joint_age(self) -> Optional[int]: ...
    @property
    def status(self) -> FrameStatus: ...
    @property
    def message(self) -> str: ...
    @property
    def nothing_measured(self) -> bool: ...
    @property
    def pixels(self) -> PixelCounts: ...
    @property
    def timing(self) -> StageTimes: ...
    @property
    def T_root_camera(self) -> Optional[Annotated[NDArray[float64], '(4, 4)']]: ...
    @property
    def T_root_link(self) -> Optional[Annotated[NDArray[float64], '(N, 4, 4)']]: ...
    @property
    def near_links(self) -> Tuple[str, ...]: ...
    @property
    def targets(self) -> Tuple[TargetReport, ...]: ...
    @property
    def links(self) -> Tuple[str, ...]: ...
    @property
    def missing_links(self) -> Tuple[str, ...]: ...
    @property
    def virtual_depth(self) -> Optional[Annotated[NDArray[float32], '(H, W)']]: ...
    @property
    def link_image(self) -> Optional[Annotated[NDArray[uint16], '(H, W)']]: ...
    @property
    def labels(self) -> Annotated[NDArray[uint8], '(H, W)']: ...
    def filtered_depth(self) -> Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)']: ...
    def points(self, frame: Optional[str] = ..., color: object = ...) -> PointCloud: ...

@final
class PointCloud:
    @property
    def points(self) -> Annotated[NDArray[float32], '(N, 3)']: ...
    @property
    def pixels(self) -> numpy.ndarray: ...
    @property
    def colors(self) -> numpy.ndarray: ...
    def __len__(self) -> int: ...

@final
class PipelineConfig:
    def __init__(
        self,
        *,
        backend: Backend = ...,
        renderer: RendererOptions = ...,
        rule: LabelRule = ...,
        image: ImageSpace = ...,
        camera_parent: str = ...,
        T_parent_camera: Annotated[ArrayLike, '(4, 4)'] = ...,
        target_history: float = ...,
    ) -> None: ...
    @property
    def backend(self) -> Backend: ...
    @property
    def renderer(self) -> RendererOptions: ...
    @property
    def rule(self) -> LabelRule: ...
    @property
    def image(self) -> ImageSpace: ...
    @property
    def camera_parent(self) -> str: ...
    @property
    def T_parent_camera(self) -> Annotated[NDArray[float64], '(4, 4)']: ...
    @property
    def target_history(self) -> float: ...
    def replace(
        self,
        *,
        backend: Backend = ...,
        renderer: RendererOptions = ...,
        rule: LabelRule = ...,
        image: ImageSpace = ...,
        camera_parent: str = ...,
        T_parent_camera: Annotated[ArrayLike, '(4, 4)'] = ...,
        target_history: float = ...,
    ) -> PipelineConfig: ...

@final
class Pipeline:
    def __init__(self, robot: Robot, camera: Camera, config: PipelineConfig = ...) -> None: ...
    def process(self, frame: Frame) -> FrameReport: ...
    def forget_target(self, name: str) -> None: ...
    def forget_targets(self) -> None: ...
    @property
    def robot(self) -> Robot: ...
    @property
    def renderer(self) -> RendererInfo: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def rule(self) -> LabelRule: ...
    @property
    def intrinsics(self) -> Intrinsics: ...
    @property
    def missing_links(self) -> Tuple[str, ...]: ...

@final
class RecordingCamera:
    @property
    def info(self) -> pathlib.Path: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def rectified(self) -> bool: ...
    @property
    def parent(self) -> str: ...
    @property
    def T_parent_camera(self) -> Annotated[NDArray[float64], '(4, 4)']: ...
    @property
    def range(self) -> Optional[DepthRange]: ...
    @property
    def tolerance(self) -> Optional[Tolerance]: ...
    @property
    def front_min_width(self) -> Optional[int]: ...
    @property
    def fringe_reach(self) -> Optional[int]: ...
    @property
    def sensor(self) -> Optional[str]: ...
    @property
    def beyond(self) -> Optional[BeyondMeans]: ...

@final
class Recording:
    @staticmethod
    def open(folder_or_yaml: Union[str, os.PathLike[str]]) -> Recording: ...
    def pipeline_config(self) -> PipelineConfig: ...
    @property
    def file(self) -> pathlib.Path: ...
    @property
    def urdf(self) -> pathlib.Path: ...
    @property
    def robot(self) -> RobotOptions: ...
    @property
    def camera(self) -> RecordingCamera: ...
    @property
    def targets(self) -> Optional[pathlib.Path]: ...

@final
class RecordedFrame:
    @property
    def frame(self) -> Frame: ...
    @property
    def index(self) -> int: ...
    @property
    def stamp(self) -> Optional[int]: ...
    @property
    def status(self) -> FrameStatus: ...
    @property
    def message(self) -> str: ...
    @property
    def depth(self) -> Optional[Annotated[Union[NDArray[uint16], NDArray[float32]], '(H, W)']]: ...
    @property
    def color(self) -> Optional[Annotated[NDArray[uint8], '(H, W, 3)']]: ...
    @property
    def color_message(self) -> str: ...

@final
class FrameReader:
    def __init__(self, recording: Recording, robot: Robot, *, color: bool) -> None: ...
    def __len__(self) -> int: ...
    def __getitem__(self, i: int) -> RecordedFrame: ...
    def __iter__(self) -> Iterator[RecordedFrame]: ...

@final
class TargetsFile:
    @staticmethod
    def open(
        file: Union[str, os.PathLike[str]],
        *,
        robot: Robot,
        image: ImageSpace,
        images: Intrinsics,
        is_bent: bool,
        beyond_hides: bool,
        history: float = ...,
        camera_frame: str = ...,
    ) -> TargetsFile: ...
    def of_frame(self, index: int) -> SourceTargets: ...
    def __len__(self) -> int: ...
    @property
    def history(self) -> float: ...

@final
class BagOptions:
    def __init__(
        self,
        *,
        depth_topic: Optional[str] = ...,
        camera_info_topic: Optional[str] = ...,
        color_topic: Optional[str] = ...,
        joint_topics: Sequence[str] = ...,
        target_topics: Sequence[str] = ...,
        poses: Optional[PoseSource] = ...,
        robot: Optional[Union[str, os.PathLike[str]]] = ...,
        packages: Mapping[str, Union[str, os.PathLike[str]]] = ...,
        frame_prefix: str = ...,
        camera_frame: Optional[str] = ...,
        parent: Optional[str] = ...,
        pose: Optional[Union[str, os.PathLike[str]]] = ...,
        rectified: bool = ...,
        first_publisher: bool = ...,
        time_offset: float = ...,
    ) -> None: ...
    @property
    def depth_topic(self) -> Optional[str]: ...
    @property
    def camera_info_topic(self) -> Optional[str]: ...
    @property
    def color_topic(self) -> Optional[str]: ...
    @property
    def joint_topics(self) -> Tuple[str, ...]: ...
    @property
    def target_topics(self) -> Tuple[str, ...]: ...
    @property
    def poses(self) -> Optional[PoseSource]: ...
    @property
    def robot(self) -> Optional[pathlib.Path]: ...
    @property
    def packages(self) -> Mapping[str, pathlib.Path]: ...
    @property
    def frame_prefix(self) -> str: ...
    @property
    def camera_frame(self) -> Optional[str]: ...
    @property
    def parent(self) -> Optional[str]: ...
    @property
    def pose(self) -> Optional[pathlib.Path]: ...
    @property
    def rectified(self) -> bool: ...
    @property
    def first_publisher(self) -> bool: ...
    @property
    def time_offset(self) -> float: ...
    def replace(
        self,
        *,
        depth_topic: Optional[str] = ...,
        camera_info_topic: Optional[str] = ...,
        color_topic: Optional[str] = ...,
        joint_topics: Sequence[str] = ...,
        target_topics: Sequence[str] = ...,
        poses: Optional[PoseSource] = ...,
        robot: Optional[Union[str, os.PathLike[str]]] = ...,
        packages: Mapping[str, Union[str, os.PathLike[str]]] = ...,
        frame_prefix: str = ...,
        camera_frame: Optional[str] = ...,
        parent: Optional[str] = ...,
        pose: Optional[Union[str, os.PathLike[str]]] = ...,
        rectified: bool = ...,
        first_publisher: bool = ...,
        time_offset: float = ...,
    ) -> BagOptions: ...

@final
class InputFrames:
    def __iter__(self) -> InputFrames: ...
    def __next__(self) -> RecordedFrame: ...
    @property
    def size(self) -> Optional[int]: ...
    @property
    def notes(self) -> Tuple[str, ...]: ...

@final
class Input:
    def __iter__(self) -> InputFrames: ...
    @property
    def robot(self) -> Robot: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def config(self) -> PipelineConfig: ...
    @property
    def targets(self) -> Optional[pathlib.Path]: ...
    @property
    def target_history(self) -> float: ...
    @property
    def beyond(self) -> Optional[BeyondMeans]: ...
    @property
    def told(self) -> Tuple[str, ...]: ...

def open_input(
    path: Union[str, os.PathLike[str]],
    *,
    color: bool = ...,
    geometry: Optional[Geometry] = ...,
    geometry_fallback: bool = ...,
    allow_missing_meshes: bool = ...,
    frames: Optional[Tuple[int, int]] = ...,
    bag: Optional[BagOptions] = ...,
) -> Input: ...

def experiments() -> List[str]: ...

def run_experiment(
    experiment: str,
    output: Union[str, os.PathLike[str]],
    *,
    first_seed: int = ...,
    end_seed: int = ...,
    duration: float = ...,
    threads: int = ...,
    frames: bool = ...,
) -> None: ...
