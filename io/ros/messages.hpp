// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace penumbra::io {

// ROS 2's messages as plain structs, one for each type that is read or written. Fields are what
// their .msg files say; units are SI. Stamps are nanoseconds. Spans refer to the payload that a
// message was decoded from.
//
// A rotation whose quaternion is not of unit length (off by 1 % and more of its square, as tf2 has
// it) is NaN as it is read: such a pose is none.

/// std_msgs/Header. Written stamps must be within 32 bits of seconds.
struct MessageHeader {
  std::int64_t stamp = 0;
  std::string frame_id = {};
  std::size_t stamp_at = 0;  ///< where the stamp lies in the payload that it was decoded from
};

/// sensor_msgs/Image
struct ImageMessage {
  MessageHeader header = {};
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding = {};
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;  ///< bytes from one row to the next
  std::span<const std::byte> data = {};
};

/// sensor_msgs/CompressedImage
struct CompressedImageMessage {
  MessageHeader header = {};
  std::string format = {};
  std::span<const std::byte> data = {};
};

/// sensor_msgs/RegionOfInterest; all 0: the whole image.
struct RegionOfInterest {
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;
};

/// sensor_msgs/CameraInfo; matrices by rows.
struct CameraInfoMessage {
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

/// sensor_msgs/JointState; arrays other than the names may be empty.
struct JointStateMessage {
  MessageHeader header = {};
  std::vector<std::string> names = {};
  std::vector<double> positions = {};
  std::vector<double> velocities = {};
  std::vector<double> efforts = {};
};

/// geometry_msgs/TransformStamped
struct TransformMessage {
  MessageHeader header = {};  ///< frame_id: the parent
  std::string child_frame_id = {};
  Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
};

/// tf2_msgs/TFMessage
struct TfMessage {
  std::vector<TransformMessage> transforms = {};
};

/// std_msgs/String
struct StringMessage {
  std::string data = {};
};

/// geometry_msgs/PoseStamped
struct PoseStampedMessage {
  MessageHeader header = {};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// vision_msgs/ObjectHypothesis
struct ObjectHypothesis {
  std::string class_id = {};
  double score = 0;
};

/// geometry_msgs/PoseWithCovariance
struct PoseWithCovariance {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::array<double, 36> covariance{};
};

/// vision_msgs/ObjectHypothesisWithPose
struct HypothesisMessage {
  ObjectHypothesis hypothesis = {};
  PoseWithCovariance pose = {};
};

/// vision_msgs/BoundingBox2D
struct BoundingBox2D {
  struct Centre {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< pixels
    double theta = 0;                                    ///< radians
  };
  Centre centre = {};
  double size_x = 0;  ///< pixels
  double size_y = 0;
};

/// vision_msgs/Detection2D. Read only.
struct Detection2DMessage {
  MessageHeader header = {};
  std::vector<HypothesisMessage> results = {};
  BoundingBox2D bbox = {};
  std::string id = {};
};

/// vision_msgs/Detection2DArray. Read only.
struct Detection2DArrayMessage {
  MessageHeader header = {};
  std::vector<Detection2DMessage> detections = {};
};

/// vision_msgs/BoundingBox3D
struct BoundingBox3D {
  Eigen::Isometry3d centre = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// vision_msgs/Detection3D. Read only.
struct Detection3DMessage {
  MessageHeader header = {};
  std::vector<HypothesisMessage> results = {};
  BoundingBox3D bbox = {};
  std::string id = {};
};

/// vision_msgs/Detection3DArray. Read only.
struct Detection3DArrayMessage {
  MessageHeader header = {};
  std::vector<Detection3DMessage> detections = {};
};

/// sensor_msgs/PointField
struct PointFieldMessage {
  static constexpr std::uint8_t float32 = 7;

  std::string name = {};
  std::uint32_t offset = 0;
  std::uint8_t datatype = float32;
  std::uint32_t count = 1;
};

/// sensor_msgs/PointCloud2
struct PointCloud2Message {
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

/// diagnostic_msgs/KeyValue
struct KeyValueMessage {
  std::string key = {};
  std::string value = {};
};

/// diagnostic_msgs/DiagnosticStatus
struct DiagnosticStatusMessage {
  static constexpr std::uint8_t ok = 0, warn = 1, error = 2, stale = 3;

  std::uint8_t level = stale;
  std::string name = {};
  std::string message = {};
  std::string hardware_id = {};
  std::vector<KeyValueMessage> values = {};
};

/// diagnostic_msgs/DiagnosticArray
struct DiagnosticArrayMessage {
  MessageHeader header = {};
  std::vector<DiagnosticStatusMessage> status = {};
};

/// penumbra_msgs/Keypoint
struct KeypointMessage {
  std::string name = {};
  double u = 0;
  double v = 0;
  double score = 0;
  double depth = 0;  ///< metres; 0 or NaN: not known
};

/// penumbra_msgs/Keypoints
struct KeypointsMessage {
  MessageHeader header = {};
  std::vector<KeypointMessage> keypoints = {};
};

/// geometry_msgs/Pose that may be none, or half of one: NaN.
struct LoosePose {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  Eigen::Vector3d position = Eigen::Vector3d::Constant(none);
  Eigen::Vector4d orientation = Eigen::Vector4d::Constant(none);  ///< quaternion x, y, z, w
};

/// penumbra_msgs/Blame
struct BlameMessage {
  std::string link = {};
  double fraction = 0;
};

/// penumbra_msgs/Target, whose file says what the fields mean. As it is made: unknown.
struct TargetMessage {
  enum VerdictValue : std::uint8_t { unknown, visible, partial, hidden, out_of_view };
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
  std::string reason = {};
  bool judged = false;
  std::uint64_t covered = 0;
  std::uint64_t inside = 0;
  double occluded_fraction = none;
  double front_fraction = none;
  double clear_fraction = none;
  double unknown_fraction = none;
  double hidden_by_other_fraction = none;
  double measured_fraction = none;
  double seen_past_fraction = none;
  std::vector<BlameMessage> blame = {};
  Eigen::Vector3d point = Eigen::Vector3d::Constant(none);
  std::uint64_t point_pixels = 0;
  double point_spread = none;
  std::uint8_t source = not_handled;
  double age = none;
  LoosePose pose = {};
  double sigma = none;
  std::uint8_t estimate = no_estimate;
};

/// penumbra_msgs/Targets
struct TargetsMessage {
  MessageHeader header = {};
  std::string root_frame = {};
  std::string status = {};
  std::string message = {};
  std::vector<TargetMessage> targets = {};
};

}  // namespace penumbra::io
