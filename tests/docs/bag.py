# SPDX-License-Identifier: Apache-2.0
"""Writes bags of ROS 2: MCAP and CDR as their specifications say them, and no more than recordings
need (https://mcap.dev/spec, OMG's DDS-XTypes 7.4.3)."""

import struct

import numpy as np

MAGIC = b"\x89MCAP0\r\n"
U32 = np.uint32


def flat(values):
    """Texts, lists and bytes have their lengths before them."""
    for value in values:
        if isinstance(value, str):
            value = value.encode() + b"\0"
        if isinstance(value, (list, bytes)):
            yield U32(len(value))
        if isinstance(value, list):
            yield from flat(value)
        else:
            yield value


def cdr(*values):
    """A message, little endian; NumPy's numbers and arrays lie at multiples of their size."""
    data = b""
    for value in flat(values):
        if not isinstance(value, bytes):
            data += b"\0" * (-len(data) % value.itemsize)
            value = value.tobytes()
        data += value
    return b"\0\1\0\0" + data


def header(stamp, frame):
    return np.int32(stamp // 10**9), U32(stamp % 10**9), frame


def text(words):
    return struct.pack("<I", len(words)) + words.encode()


def write_bag(file, messages):
    """Of (topic, type, stamp, message). No chunks, no index: records one behind another."""
    with open(file, "wb") as out:
        def record(kind, content):
            out.write(struct.pack("<BQ", kind, len(content)) + content)

        out.write(MAGIC)
        record(1, text("ros2") + text("tests"))
        numbers = {}
        for topic, kind, stamp, message in messages:
            if topic not in numbers:
                number = numbers[topic] = len(numbers) + 1
                record(3, struct.pack("<H", number) + text(kind) + text("ros2msg") + text(""))
                record(4, struct.pack("<HH", number, number) + text(topic) + text("cdr") + struct.pack("<I", 0))
            record(5, struct.pack("<HIQQ", numbers[topic], 0, stamp, stamp) + message)
        record(15, struct.pack("<I", 0))
        record(2, struct.pack("<QQI", 0, 0, 0))
        out.write(MAGIC)


def camera_info(camera, stamp):
    i = camera.intrinsics
    k = np.array([[i.fx, 0, i.cx], [0, i.fy, i.cy], [0, 0, 1]])
    return cdr(*header(stamp, camera.frame_id), U32(i.height), U32(i.width), "plumb_bob", [*np.zeros(5)],
               k, np.eye(3), np.insert(k, 3, 0, axis=1), np.zeros(6, U32), np.uint8(0))


def depth_image(depth, frame, stamp):
    height, width = depth.shape
    return cdr(*header(stamp, frame), U32(height), U32(width), "16UC1", np.uint8(0), U32(2 * width),
               depth.astype("<u2").tobytes())


def point_cloud(points, names, frame, stamp):
    """`points`: a column of float32 for each name."""
    fields = [value for i, name in enumerate(names) for value in (name, U32(4 * i), np.uint8(7), U32(1))]
    step = 4 * len(names)
    return cdr(*header(stamp, frame), U32(1), U32(len(points)), U32(len(names)), *fields, np.uint8(0),
               U32(step), U32(step * len(points)), points.tobytes(), np.uint8(1))


def joint_state(names, positions, stamp):
    return cdr(*header(stamp, ""), list(names), [*np.array(positions, float)], [], [])


def static_transform(parent, child, T, stamp):
    """Turned by less than half a turn."""
    R = T[:3, :3]
    w = np.sqrt(1 + np.trace(R)) / 2
    xyz = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4 * w)
    return cdr(U32(1), *header(stamp, parent), child, T[:3, 3], xyz, w)


def messages_of(given, urdf_text, parent):
    """`given`: penumbra.open's. Joint states are of the images' own stamps."""
    frames, frame_id, i = list(given), given.camera.frame_id, given.camera.intrinsics
    start, camera = frames[0].stamp, "/camera/camera/depth/"
    yield "/robot_description", "std_msgs/msg/String", start, cdr(urdf_text)
    mount = static_transform(parent, frame_id, given.camera.T_parent_camera, start)
    yield "/tf_static", "tf2_msgs/msg/TFMessage", start, mount
    for frame in frames:
        stamp = frame.stamp
        joints = joint_state(given.robot.variables, frame.pose.positions, stamp)
        yield "/joint_states", "sensor_msgs/msg/JointState", stamp, joints
        yield camera + "camera_info", "sensor_msgs/msg/CameraInfo", stamp, camera_info(given.camera, stamp)
        yield camera + "image_rect_raw", "sensor_msgs/msg/Image", stamp, depth_image(frame.depth, frame_id, stamp)
        v, u = (part[::20] for part in np.nonzero(frame.depth))
        z = frame.depth[v, u] * 1e-3
        points = np.stack([(u - i.cx) / i.fx * z, (v - i.cy) / i.fy * z, z], axis=1).astype("<f4")
        yield "/points", "sensor_msgs/msg/PointCloud2", stamp, point_cloud(points, "xyz", frame_id, stamp)
