// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <tuple>

#include <io/ros/messages.hpp>
#include <io/ros/wire_values-inl.hpp>

namespace penumbra::io {

/// A field of a message by its name there.
template <typename M, typename T>
struct Member {
  std::string_view name;
  T M::*at;
};
template <typename M, typename T>
Member(const char*, T M::*) -> Member<M, T>;

/// A field whose message `W` stands for one value of ours.
template <typename W, typename M, typename T>
struct Converted {
  std::string_view name;
  T M::*at;
};

template <typename W, typename M, typename T>
constexpr Converted<W, M, T> as(const char* name, T M::*at) {
  return {name, at};
}

/// A message's type and all its fields in the order of its definition: its layout on the wire.
template <typename M>
struct Fields;

template <>
struct Fields<TimeWire> {
  static constexpr std::string_view type = "builtin_interfaces/Time";
  static constexpr auto members =
      std::tuple{Member{"sec", &TimeWire::sec}, Member{"nanosec", &TimeWire::nanosec}};
};

template <>
struct Fields<Vector2Wire> {
  static constexpr std::string_view type = "vision_msgs/Point2D";
  static constexpr auto members =
      std::tuple{Member{"x", &Vector2Wire::x}, Member{"y", &Vector2Wire::y}};
};

template <>
struct Fields<Vector3Wire> {
  static constexpr std::string_view type = "geometry_msgs/Vector3";
  static constexpr auto members = std::tuple{
      Member{"x", &Vector3Wire::x}, Member{"y", &Vector3Wire::y}, Member{"z", &Vector3Wire::z}};
};

template <>
struct Fields<PointWire> {
  static constexpr std::string_view type = "geometry_msgs/Point";
  static constexpr auto members = std::tuple{Member{"x", &PointWire::x}, Member{"y", &PointWire::y},
                                             Member{"z", &PointWire::z}};
};

template <>
struct Fields<QuaternionWire> {
  static constexpr std::string_view type = "geometry_msgs/Quaternion";
  static constexpr auto members =
      std::tuple{Member{"x", &QuaternionWire::x}, Member{"y", &QuaternionWire::y},
                 Member{"z", &QuaternionWire::z}, Member{"w", &QuaternionWire::w}};
};

template <>
struct Fields<TransformWire> {
  static constexpr std::string_view type = "geometry_msgs/Transform";
  static constexpr auto members = std::tuple{Member{"translation", &TransformWire::translation},
                                             Member{"rotation", &TransformWire::rotation}};
};

template <>
struct Fields<PoseWire> {
  static constexpr std::string_view type = "geometry_msgs/Pose";
  static constexpr auto members = std::tuple{Member{"position", &PoseWire::position},
                                             Member{"orientation", &PoseWire::orientation}};
};

template <>
struct Fields<MessageHeader> {
  static constexpr std::string_view type = "std_msgs/Header";
  static constexpr auto members = std::tuple{as<TimeWire>("stamp", &MessageHeader::stamp),
                                             Member{"frame_id", &MessageHeader::frame_id}};
};

template <>
struct Fields<ImageMessage> {
  using M = ImageMessage;
  static constexpr std::string_view type = "sensor_msgs/Image";
  static constexpr auto members = std::tuple{Member{"header", &M::header},
                                             Member{"height", &M::height},
                                             Member{"width", &M::width},
                                             Member{"encoding", &M::encoding},
                                             Member{"is_bigendian", &M::is_bigendian},
                                             Member{"step", &M::step},
                                             Member{"data", &M::data}};
};

template <>
struct Fields<CompressedImageMessage> {
  using M = CompressedImageMessage;
  static constexpr std::string_view type = "sensor_msgs/CompressedImage";
  static constexpr auto members = std::tuple{
      Member{"header", &M::header}, Member{"format", &M::format}, Member{"data", &M::data}};
};

template <>
struct Fields<RegionOfInterest> {
  using M = RegionOfInterest;
  static constexpr std::string_view type = "sensor_msgs/RegionOfInterest";
  static constexpr auto members =
      std::tuple{Member{"x_offset", &M::x_offset}, Member{"y_offset", &M::y_offset},
                 Member{"height", &M::height}, Member{"width", &M::width},
                 Member{"do_rectify", &M::do_rectify}};
};

template <>
struct Fields<CameraInfoMessage> {
  using M = CameraInfoMessage;
  static constexpr std::string_view type = "sensor_msgs/CameraInfo";
  static constexpr auto members = std::tuple{Member{"header", &M::header},
                                             Member{"height", &M::height},
                                             Member{"width", &M::width},
                                             Member{"distortion_model", &M::distortion_model},
                                             Member{"d", &M::d},
                                             Member{"k", &M::k},
                                             Member{"r", &M::r},
                                             Member{"p", &M::p},
                                             Member{"binning_x", &M::binning_x},
                                             Member{"binning_y", &M::binning_y},
                                             Member{"roi", &M::roi}};
};

template <>
struct Fields<JointStateMessage> {
  using M = JointStateMessage;
  static constexpr std::string_view type = "sensor_msgs/JointState";
  static constexpr auto members = std::tuple{
      Member{"header", &M::header}, Member{"name", &M::names}, Member{"position", &M::positions},
      Member{"velocity", &M::velocities}, Member{"effort", &M::efforts}};
};

template <>
struct Fields<TransformMessage> {
  using M = TransformMessage;
  static constexpr std::string_view type = "geometry_msgs/TransformStamped";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"child_frame_id", &M::child_frame_id},
                 as<TransformWire>("transform", &M::T_parent_child)};
};

template <>
struct Fields<TfMessage> {
  static constexpr std::string_view type = "tf2_msgs/TFMessage";
  static constexpr auto members = std::tuple{Member{"transforms", &TfMessage::transforms}};
};

template <>
struct Fields<StringMessage> {
  static constexpr std::string_view type = "std_msgs/String";
  static constexpr auto members = std::tuple{Member{"data", &StringMessage::data}};
};

template <>
struct Fields<PoseStampedMessage> {
  using M = PoseStampedMessage;
  static constexpr std::string_view type = "geometry_msgs/PoseStamped";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, as<PoseWire>("pose", &M::pose)};
};

template <>
struct Fields<ObjectHypothesis> {
  using M = ObjectHypothesis;
  static constexpr std::string_view type = "vision_msgs/ObjectHypothesis";
  static constexpr auto members =
      std::tuple{Member{"class_id", &M::class_id}, Member{"score", &M::score}};
};

template <>
struct Fields<PoseWithCovariance> {
  using M = PoseWithCovariance;
  static constexpr std::string_view type = "geometry_msgs/PoseWithCovariance";
  static constexpr auto members =
      std::tuple{as<PoseWire>("pose", &M::pose), Member{"covariance", &M::covariance}};
};

template <>
struct Fields<HypothesisMessage> {
  static constexpr std::string_view type = "vision_msgs/ObjectHypothesisWithPose";
  static constexpr auto members = std::tuple{Member{"hypothesis", &HypothesisMessage::hypothesis},
                                             Member{"pose", &HypothesisMessage::pose}};
};

template <>
struct Fields<BoundingBox2D::Centre> {
  using M = BoundingBox2D::Centre;
  static constexpr std::string_view type = "vision_msgs/Pose2D";
  static constexpr auto members =
      std::tuple{as<Vector2Wire>("position", &M::position), Member{"theta", &M::theta}};
};

template <>
struct Fields<BoundingBox2D> {
  using M = BoundingBox2D;
  static constexpr std::string_view type = "vision_msgs/BoundingBox2D";
  static constexpr auto members = std::tuple{
      Member{"center", &M::centre}, Member{"size_x", &M::size_x}, Member{"size_y", &M::size_y}};
};

template <>
struct Fields<Detection2DMessage> {
  using M = Detection2DMessage;
  static constexpr std::string_view type = "vision_msgs/Detection2D";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"results", &M::results},
                 Member{"bbox", &M::bbox}, Member{"id", &M::id}};
};

template <>
struct Fields<Detection2DArrayMessage> {
  using M = Detection2DArrayMessage;
  static constexpr std::string_view type = "vision_msgs/Detection2DArray";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"detections", &M::detections}};
};

template <>
struct Fields<BoundingBox3D> {
  using M = BoundingBox3D;
  static constexpr std::string_view type = "vision_msgs/BoundingBox3D";
  static constexpr auto members =
      std::tuple{as<PoseWire>("center", &M::centre), as<Vector3Wire>("size", &M::size)};
};

template <>
struct Fields<Detection3DMessage> {
  using M = Detection3DMessage;
  static constexpr std::string_view type = "vision_msgs/Detection3D";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"results", &M::results},
                 Member{"bbox", &M::bbox}, Member{"id", &M::id}};
};

template <>
struct Fields<Detection3DArrayMessage> {
  using M = Detection3DArrayMessage;
  static constexpr std::string_view type = "vision_msgs/Detection3DArray";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"detections", &M::detections}};
};

template <>
struct Fields<PointFieldMessage> {
  using M = PointFieldMessage;
  static constexpr std::string_view type = "sensor_msgs/PointField";
  static constexpr auto members =
      std::tuple{Member{"name", &M::name}, Member{"offset", &M::offset},
                 Member{"datatype", &M::datatype}, Member{"count", &M::count}};
};

template <>
struct Fields<PointCloud2Message> {
  using M = PointCloud2Message;
  static constexpr std::string_view type = "sensor_msgs/PointCloud2";
  static constexpr auto members = std::tuple{Member{"header", &M::header},
                                             Member{"height", &M::height},
                                             Member{"width", &M::width},
                                             Member{"fields", &M::fields},
                                             Member{"is_bigendian", &M::is_bigendian},
                                             Member{"point_step", &M::point_step},
                                             Member{"row_step", &M::row_step},
                                             Member{"data", &M::data},
                                             Member{"is_dense", &M::is_dense}};
};

template <>
struct Fields<KeyValueMessage> {
  using M = KeyValueMessage;
  static constexpr std::string_view type = "diagnostic_msgs/KeyValue";
  static constexpr auto members = std::tuple{Member{"key", &M::key}, Member{"value", &M::value}};
};

template <>
struct Fields<DiagnosticStatusMessage> {
  using M = DiagnosticStatusMessage;
  static constexpr std::string_view type = "diagnostic_msgs/DiagnosticStatus";
  static constexpr auto members = std::tuple{
      Member{"level", &M::level}, Member{"name", &M::name}, Member{"message", &M::message},
      Member{"hardware_id", &M::hardware_id}, Member{"values", &M::values}};
};

template <>
struct Fields<DiagnosticArrayMessage> {
  using M = DiagnosticArrayMessage;
  static constexpr std::string_view type = "diagnostic_msgs/DiagnosticArray";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"status", &M::status}};
};

template <>
struct Fields<KeypointMessage> {
  using M = KeypointMessage;
  static constexpr std::string_view type = "penumbra_msgs/Keypoint";
  static constexpr auto members =
      std::tuple{Member{"name", &M::name}, Member{"u", &M::u}, Member{"v", &M::v},
                 Member{"score", &M::score}, Member{"depth", &M::depth}};
};

template <>
struct Fields<KeypointsMessage> {
  using M = KeypointsMessage;
  static constexpr std::string_view type = "penumbra_msgs/Keypoints";
  static constexpr auto members =
      std::tuple{Member{"header", &M::header}, Member{"keypoints", &M::keypoints}};
};

template <>
struct Fields<LoosePose> {
  using M = LoosePose;
  static constexpr std::string_view type = "geometry_msgs/Pose";
  static constexpr auto members = std::tuple{as<PointWire>("position", &M::position),
                                             as<QuaternionWire>("orientation", &M::orientation)};
};

template <>
struct Fields<BlameMessage> {
  using M = BlameMessage;
  static constexpr std::string_view type = "penumbra_msgs/Blame";
  static constexpr auto members =
      std::tuple{Member{"link", &M::link}, Member{"fraction", &M::fraction}};
};

template <>
struct Fields<TargetMessage> {
  using M = TargetMessage;
  static constexpr std::string_view type = "penumbra_msgs/Target";
  static constexpr auto members =
      std::tuple{Member{"name", &M::name},
                 Member{"has_stamp", &M::has_stamp},
                 as<TimeWire>("stamp", &M::stamp),
                 Member{"verdict", &M::verdict},
                 Member{"reason", &M::reason},
                 Member{"judged", &M::judged},
                 Member{"covered", &M::covered},
                 Member{"inside", &M::inside},
                 Member{"occluded_fraction", &M::occluded_fraction},
                 Member{"front_fraction", &M::front_fraction},
                 Member{"clear_fraction", &M::clear_fraction},
                 Member{"unknown_fraction", &M::unknown_fraction},
                 Member{"hidden_by_other_fraction", &M::hidden_by_other_fraction},
                 Member{"measured_fraction", &M::measured_fraction},
                 Member{"seen_past_fraction", &M::seen_past_fraction},
                 Member{"blame", &M::blame},
                 as<PointWire>("point", &M::point),
                 Member{"point_pixels", &M::point_pixels},
                 Member{"point_spread", &M::point_spread},
                 Member{"source", &M::source},
                 Member{"age", &M::age},
                 Member{"pose", &M::pose},
                 Member{"sigma", &M::sigma},
                 Member{"estimate", &M::estimate}};
};

template <>
struct Fields<TargetsMessage> {
  using M = TargetsMessage;
  static constexpr std::string_view type = "penumbra_msgs/Targets";
  static constexpr auto members = std::tuple{
      Member{"header", &M::header}, Member{"root_frame", &M::root_frame},
      Member{"status", &M::status}, Member{"message", &M::message}, Member{"targets", &M::targets}};
};

}  // namespace penumbra::io
