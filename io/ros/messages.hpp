// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace penumbra::io {

// ROS 2's messages as plain structs, one for each type that is read or written. The .msg files
// describe the fields; units are SI and stamps are nanoseconds. Spans refer to the payload that a
// message was decoded from. layout() lists a message's fields in the order of its definition.
//
// The values of velocities and efforts, and the pose of a hypothesis, are read but not used.
//
// A rotation whose quaternion does not have unit length (its square is off by 1 % or more, as in
// tf2) is read as NaN.

// Messages that are converted to one value of ours (wire_values.hpp).
struct TimeWire;
struct Vector2Wire;
struct PointWire;
struct Vector3Wire;
struct QuaternionWire;
struct TransformWire;
struct PoseWire;

/// A field that is a message `W` on the wire.
template <typename W, typename T>
struct Converted {
  T& value;
};
template <typename W, typename T>
Converted<W, T> as(T& value) {
  return {value};
}

/// References to fields, and converted fields.
template <typename... T>
std::tuple<T...> fields_of(T&&... fields) {
  return {std::forward<T>(fields)...};
}

/// Written stamps must be within 32 bits of seconds.
struct MessageHeader {
  static constexpr std::string_view ros_type = "std_msgs/Header";
  static auto layout(auto& m) { return fields_of(as<TimeWire>(m.stamp), m.frame_id); }

  std::int64_t stamp = 0;
  std::string frame_id = {};
  std::size_t stamp_at = 0;  ///< where the stamp lies in the payload that it was decoded from
};

struct ImageMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/Image";
  static auto layout(auto& m) {
    return fields_of(m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data);
  }

  MessageHeader header = {};
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding = {};
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;  ///< bytes from one row to the next
  std::span<const std::byte> data = {};
};

struct CompressedImageMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/CompressedImage";
  static auto layout(auto& m) { return fields_of(m.header, m.format, m.data); }

  MessageHeader header = {};
  std::string format = {};
  std::span<const std::byte> data = {};
};

/// All 0: the whole image.
struct RegionOfInterest {
  static constexpr std::string_view ros_type = "sensor_msgs/RegionOfInterest";
  static auto layout(auto& m) {
    return fields_of(m.x_offset, m.y_offset, m.height, m.width, m.do_rectify);
  }

  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;
};

/// Matrices are row-major.
struct CameraInfoMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/CameraInfo";
  static auto layout(auto& m) {
    return fields_of(m.header, m.height, m.width, m.distortion_model, m.d, m.k, m.r, m.p,
                     m.binning_x, m.binning_y, m.roi);
  }

  MessageHeader header = {};
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model = {};
  std::vector<double> d = {};
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0;  ///< 0 is 1
  std::uint32_t binning_y = 0;
  RegionOfInterest roi = {};
};

/// Arrays other than the names may be empty.
struct JointStateMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/JointState";
  static auto layout(auto& m) {
    return fields_of(m.header, m.names, m.positions, m.velocities, m.efforts);
  }

  MessageHeader header = {};
  std::vector<std::string> names = {};
  std::vector<double> positions = {};
  std::vector<double> velocities = {};
  std::vector<double> efforts = {};
};

struct TransformMessage {
  static constexpr std::string_view ros_type = "geometry_msgs/TransformStamped";
  static auto layout(auto& m) {
    return fields_of(m.header, m.child_frame_id, as<TransformWire>(m.T_parent_child));
  }

  MessageHeader header = {};  ///< frame_id: the parent
  std::string child_frame_id = {};
  Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
};

struct TfMessage {
  static constexpr std::string_view ros_type = "tf2_msgs/TFMessage";
  static auto layout(auto& m) { return fields_of(m.transforms); }

  std::vector<TransformMessage> transforms = {};
};

struct StringMessage {
  static constexpr std::string_view ros_type = "std_msgs/String";
  static auto layout(auto& m) { return fields_of(m.data); }

  std::string data = {};
};

struct PoseStampedMessage {
  static constexpr std::string_view ros_type = "geometry_msgs/PoseStamped";
  static auto layout(auto& m) { return fields_of(m.header, as<PoseWire>(m.pose)); }

  MessageHeader header = {};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

struct ObjectHypothesis {
  static constexpr std::string_view ros_type = "vision_msgs/ObjectHypothesis";
  static auto layout(auto& m) { return fields_of(m.class_id, m.score); }

  std::string class_id = {};
  double score = 0;
};

struct PoseWithCovariance {
  static constexpr std::string_view ros_type = "geometry_msgs/PoseWithCovariance";
  static auto layout(auto& m) { return fields_of(as<PoseWire>(m.pose), m.covariance); }

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::array<double, 36> covariance{};
};

struct HypothesisMessage {
  static constexpr std::string_view ros_type = "vision_msgs/ObjectHypothesisWithPose";
  static auto layout(auto& m) { return fields_of(m.hypothesis, m.pose); }

  ObjectHypothesis hypothesis = {};
  PoseWithCovariance pose = {};
};

struct BoundingBox2D {
  static constexpr std::string_view ros_type = "vision_msgs/BoundingBox2D";
  static auto layout(auto& m) { return fields_of(m.centre, m.size_x, m.size_y); }

  struct Centre {
    static constexpr std::string_view ros_type = "vision_msgs/Pose2D";
    static auto layout(auto& m) { return fields_of(as<Vector2Wire>(m.position), m.theta); }

    Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< pixels
    double theta = 0;                                    ///< radians
  };
  Centre centre = {};
  double size_x = 0;  ///< pixels
  double size_y = 0;
};

/// Read only.
struct Detection2DMessage {
  static constexpr std::string_view ros_type = "vision_msgs/Detection2D";
  static auto layout(auto& m) { return fields_of(m.header, m.results, m.bbox, m.id); }

  MessageHeader header = {};
  std::vector<HypothesisMessage> results = {};
  BoundingBox2D bbox = {};
  std::string id = {};
};

/// Read only.
struct Detection2DArrayMessage {
  static constexpr std::string_view ros_type = "vision_msgs/Detection2DArray";
  static auto layout(auto& m) { return fields_of(m.header, m.detections); }

  MessageHeader header = {};
  std::vector<Detection2DMessage> detections = {};
};

struct BoundingBox3D {
  static constexpr std::string_view ros_type = "vision_msgs/BoundingBox3D";
  static auto layout(auto& m) { return fields_of(as<PoseWire>(m.centre), as<Vector3Wire>(m.size)); }

  Eigen::Isometry3d centre = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// Read only.
struct Detection3DMessage {
  static constexpr std::string_view ros_type = "vision_msgs/Detection3D";
  static auto layout(auto& m) { return fields_of(m.header, m.results, m.bbox, m.id); }

  MessageHeader header = {};
  std::vector<HypothesisMessage> results = {};
  BoundingBox3D bbox = {};
  std::string id = {};
};

/// Read only.
struct Detection3DArrayMessage {
  static constexpr std::string_view ros_type = "vision_msgs/Detection3DArray";
  static auto layout(auto& m) { return fields_of(m.header, m.detections); }

  MessageHeader header = {};
  std::vector<Detection3DMessage> detections = {};
};

struct PointFieldMessage {
  static constexpr std::string_view ros_type = "sensor_msgs/PointField";
  static auto layout(auto& m) { return fields_of(m.name, m.offset, m.datatype, m.count); }

  static constexpr std::uint8_t float32 = 7;

  std::string name = {};
  std::uint32_t offset = 0;
  std::uint8_t datatype = float32;
  std::uint32_t count = 1;
};

struct PointCloud2Message {
  static constexpr std::string_view ros_type = "sensor_msgs/PointCloud2";
  static auto layout(auto& m) {
    return fields_of(m.header, m.height, m.width, m.fields, m.is_bigendian, m.point_step,
                     m.row_step, m.data, m.is_dense);
  }

  MessageHeader header = {};
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointFieldMessage> fields = {};
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::span<const std::byte> data = {};
  bool is_dense = false;
};

struct KeyValueMessage {
  static constexpr std::string_view ros_type = "diagnostic_msgs/KeyValue";
  static auto layout(auto& m) { return fields_of(m.key, m.value); }

  std::string key = {};
  std::string value = {};
};

struct DiagnosticStatusMessage {
  static constexpr std::string_view ros_type = "diagnostic_msgs/DiagnosticStatus";
  static auto layout(auto& m) {
    return fields_of(m.level, m.name, m.message, m.hardware_id, m.values);
  }

  static constexpr std::uint8_t ok = 0, warn = 1, error = 2, stale = 3;

  std::uint8_t level = stale;
  std::string name = {};
  std::string message = {};
  std::string hardware_id = {};
  std::vector<KeyValueMessage> values = {};
};

struct DiagnosticArrayMessage {
  static constexpr std::string_view ros_type = "diagnostic_msgs/DiagnosticArray";
  static auto layout(auto& m) { return fields_of(m.header, m.status); }

  MessageHeader header = {};
  std::vector<DiagnosticStatusMessage> status = {};
};

struct KeypointMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/Keypoint";
  static auto layout(auto& m) { return fields_of(m.name, m.u, m.v, m.score, m.depth); }

  std::string name = {};
  double u = 0;
  double v = 0;
  double score = 0;
  double depth = 0;  ///< metres; 0 or NaN: not known
};

struct KeypointsMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/Keypoints";
  static auto layout(auto& m) { return fields_of(m.header, m.keypoints); }

  MessageHeader header = {};
  std::vector<KeypointMessage> keypoints = {};
};

/// A pose whose position or orientation may be missing: NaN.
struct LoosePose {
  static constexpr std::string_view ros_type = "geometry_msgs/Pose";
  static auto layout(auto& m) {
    return fields_of(as<PointWire>(m.position), as<QuaternionWire>(m.orientation));
  }

  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  Eigen::Vector3d position = Eigen::Vector3d::Constant(none);
  Eigen::Vector4d orientation = Eigen::Vector4d::Constant(none);  ///< quaternion x, y, z, w
};

struct BlameMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/Blame";
  static auto layout(auto& m) { return fields_of(m.link, m.fraction); }

  std::string link = {};
  double fraction = 0;
};

/// The .msg file explains the fields.
struct TargetMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/Target";
  static auto layout(auto& m) {
    return fields_of(m.name, m.has_stamp, as<TimeWire>(m.stamp), m.verdict, m.verdict_name,
                     m.reason, m.judged, m.covered, m.inside, m.occluded_fraction, m.front_fraction,
                     m.clear_fraction, m.unknown_fraction, m.hidden_by_other_fraction,
                     m.measured_fraction, m.seen_past_fraction, m.blame, as<PointWire>(m.point),
                     m.point_pixels, m.point_spread, m.source, m.age, m.pose, m.sigma,
                     m.forecast_seconds, m.hidden_in, m.hidden_for, m.lost_in, m.hidden_by,
                     m.forecast_reason, m.estimate);
  }

  enum VerdictValue : std::uint8_t { unknown, visible, partial, hidden, out_of_view, held_by_link };
  enum SourceValue : std::uint8_t { not_handled, measured, predicted, held, lost };
  enum EstimateValue : std::uint8_t {
    no_estimate,
    accepted,
    refused_verdict,
    refused_gate,
    refused_late,
    refused_invalid
  };
  static constexpr double none = LoosePose::none;

  std::string name = {};
  bool has_stamp = false;
  std::int64_t stamp = 0;
  std::uint8_t verdict = unknown;
  std::string verdict_name = "unknown";
  std::string reason = {};
  bool judged = false;
  std::uint64_t covered = 0;
  std::uint64_t inside = 0;
  double occluded_fraction = none;
  double front_fraction = none;
  double clear_fraction = none;
  double unknown_fraction = none;
  double hidden_by_other_fraction = 0;
  double measured_fraction = 0;
  double seen_past_fraction = 0;
  std::vector<BlameMessage> blame = {};
  Eigen::Vector3d point = Eigen::Vector3d::Constant(none);
  std::uint64_t point_pixels = 0;
  double point_spread = 0;
  std::uint8_t source = not_handled;
  double age = 0;
  LoosePose pose = {};
  double sigma = 0;
  double forecast_seconds = 0;
  double hidden_in = none;
  double hidden_for = none;
  double lost_in = std::numeric_limits<double>::infinity();
  std::string hidden_by = {};
  std::string forecast_reason = {};
  std::uint8_t estimate = no_estimate;
};

struct TargetsMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/Targets";
  static auto layout(auto& m) {
    return fields_of(m.header, m.root_frame, m.status, m.message, m.targets);
  }

  MessageHeader header = {};
  std::string root_frame = {};
  std::string status = {};
  std::string message = {};
  std::vector<TargetMessage> targets = {};
};

/// The .msg file explains the fields.
struct CameraViewMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/CameraView";
  static auto layout(auto& m) {
    return fields_of(m.camera, m.has_stamp, as<TimeWire>(m.stamp), m.verdict, m.verdict_name,
                     m.reason, m.visible_fraction, as<PointWire>(m.point), m.distance, m.angle);
  }

  static constexpr double none = LoosePose::none;

  std::string camera = {};
  bool has_stamp = false;
  std::int64_t stamp = 0;
  std::uint8_t verdict = TargetMessage::unknown;
  std::string verdict_name = "unknown";
  std::string reason = {};
  double visible_fraction = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Constant(none);
  double distance = 0;
  double angle = 0;
};

/// The .msg file explains the fields.
struct TargetViewMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/TargetView";
  static auto layout(auto& m) {
    return fields_of(m.name, m.verdict, m.verdict_name, m.reason, m.best, as<PointWire>(m.point),
                     m.covariance, m.contradicting, m.contradiction_distance,
                     m.contradiction_chi_square, m.views);
  }

  static constexpr double none = LoosePose::none;

  std::string name = {};
  std::uint8_t verdict = TargetMessage::unknown;
  std::string verdict_name = "unknown";
  std::string reason = {};
  std::string best = {};
  Eigen::Vector3d point = Eigen::Vector3d::Constant(none);
  std::array<double, 9> covariance = {none, none, none, none, none, none, none, none, none};
  std::vector<std::string> contradicting = {};
  double contradiction_distance = 0;
  double contradiction_chi_square = 0;
  std::vector<CameraViewMessage> views = {};
};

struct TargetViewsMessage {
  static constexpr std::string_view ros_type = "penumbra_msgs/TargetViews";
  static auto layout(auto& m) { return fields_of(m.header, m.targets); }

  MessageHeader header = {};
  std::vector<TargetViewMessage> targets = {};
};

}  // namespace penumbra::io
