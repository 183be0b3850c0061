# SPDX-License-Identifier: Apache-2.0
"""Writes a recording as a bag of ROS 2: MCAP and CDR as their specifications say them, and no more
than recordings need (https://mcap.dev/spec, OMG's DDS-XTypes 7.4.3)."""

import struct

import numpy as np

MAGIC = b"\x89MCAP0\r\n"


class Cdr:
    """A message, little endian; numbers lie at multiples of their size."""

    def __init__(self):
        self.bytes = bytearray()

    def put(self, kind, *values):
        for value in values:
            self.bytes += b"\0" * (-len(self.bytes) % struct.calcsize(kind))
            self.bytes += struct.pack("<" + kind, value)
        return self

    def text(self, text):
        data = text.encode() + b"\0"
        self.put("I", len(data)).bytes += data
        return self

    def sequence(self, kind, values):
        return self.put("I", len(values)).put(kind, *values)

    def header(self, stamp, frame):
        return self.put("i", stamp // 10**9).put("I", stamp % 10**9).text(frame)

    def message(self):
        return b"\0\1\0\0" + bytes(self.bytes)


class McapWriter:
    """No chunks, no index: records one behind another."""

    def __init__(self, file):
        self.file = open(file, "wb")
        self.file.write(MAGIC)
        self.record(1, self.text("ros2") + self.text("tests"))
        self.channels = {}

    @staticmethod
    def text(text):
        return struct.pack("<I", len(text)) + text.encode()

    def record(self, kind, content):
        self.file.write(struct.pack("<BQ", kind, len(content)) + content)

    def write(self, topic, kind, stamp, message):
        if topic not in self.channels:
            number = self.channels[topic] = len(self.channels) + 1
            self.record(3, struct.pack("<H", number) + self.text(kind) + self.text("ros2msg") + self.text(""))
            self.record(4, struct.pack("<HH", number, number) + self.text(topic) +
                        self.text("cdr") + struct.pack("<I", 0))
        self.record(5, struct.pack("<HIQQ", self.channels[topic], 0, stamp, stamp) + message)

    def close(self):
        self.record(15, struct.pack("<I", 0))
        self.record(2, struct.pack("<QQI", 0, 0, 0))
        self.file.write(MAGIC)
        self.file.close()


def camera_info(camera, stamp):
    i = camera.intrinsics
    k = [i.fx, 0, i.cx, 0, i.fy, i.cy, 0, 0, 1]
    p = [i.fx, 0, i.cx, 0, 0, i.fy, i.cy, 0, 0, 0, 1, 0]
    out = Cdr().header(stamp, camera.frame_id).put("I", i.height, i.width).text("plumb_bob")
    out.sequence("d", [0.0] * 5).put("d", *k).put("d", *np.eye(3).flat).put("d", *p)
    return out.put("I", 0, 0, 0, 0, 0, 0).put("?", False).message()


def depth_image(depth, frame, stamp):
    out = Cdr().header(stamp, frame).put("I", *depth.shape).text("16UC1").put("B", 0)
    out.put("I", 2 * depth.shape[1], depth.nbytes).bytes += depth.astype("<u2").tobytes()
    return out.message()


def point_cloud(camera, depth, stamp):
    """Some of the depth image's points, in metres."""
    i = camera.intrinsics
    v, u = (part[::20] for part in np.nonzero(depth))
    z = depth[v, u] * 1e-3
    points = np.stack([(u - i.cx) / i.fx * z, (v - i.cy) / i.fy * z, z], axis=1).astype("<f4")
    out = Cdr().header(stamp, camera.frame_id).put("I", 1, len(points), 3)
    for axis in range(3):
        out.text("xyz"[axis]).put("I", 4 * axis).put("B", 7).put("I", 1)
    out.put("?", False).put("I", 12, 12 * len(points), points.nbytes).bytes += points.tobytes()
    return out.put("?", True).message()


def joint_state(names, positions, stamp):
    out = Cdr().header(stamp, "").put("I", len(names))
    for name in names:
        out.text(name)
    return out.sequence("d", positions).sequence("d", []).sequence("d", []).message()


def quaternion(R):
    """x, y, z, w of a rotation by less than half a turn."""
    w = np.sqrt(1 + np.trace(R)) / 2
    return [(R[2, 1] - R[1, 2]) / (4 * w), (R[0, 2] - R[2, 0]) / (4 * w), (R[1, 0] - R[0, 1]) / (4 * w), w]


def static_transform(parent, child, T, stamp):
    out = Cdr().put("I", 1).header(stamp, parent).text(child)
    return out.put("d", *T[:3, 3], *quaternion(T[:3, :3])).message()


def write_bag(file, given, frames, urdf_text, parent):
    """`given`: penumbra.open_input's. Joint states are of the images' own stamps."""
    bag = McapWriter(file)
    start, frame_id = frames[0].stamp, given.camera.frame_id
    bag.write("/robot_description", "std_msgs/msg/String", start, Cdr().text(urdf_text).message())
    bag.write("/tf_static", "tf2_msgs/msg/TFMessage", start,
              static_transform(parent, frame_id, given.config.T_parent_camera, start))
    for frame in frames:
        joints = joint_state(given.robot.variables, frame.pose.positions, frame.stamp)
        bag.write("/joint_states", "sensor_msgs/msg/JointState", frame.stamp, joints)
        camera = "/camera/camera/depth/"
        bag.write(camera + "camera_info", "sensor_msgs/msg/CameraInfo", frame.stamp,
                  camera_info(given.camera, frame.stamp))
        bag.write(camera + "image_rect_raw", "sensor_msgs/msg/Image", frame.stamp,
                  depth_image(frame.depth, frame_id, frame.stamp))
        bag.write("/points", "sensor_msgs/msg/PointCloud2", frame.stamp,
                  point_cloud(given.camera, frame.depth, frame.stamp))
    bag.close()
