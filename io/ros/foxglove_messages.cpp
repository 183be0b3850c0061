// SPDX-License-Identifier: Apache-2.0
// The field numbers are those of schemas/proto/foxglove of github.com/foxglove/foxglove-sdk.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/files/printable.hpp>
#include <io/ros/foxglove_messages.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/protobuf_structs-inl.hpp>
#include <io/ros/wire_values.hpp>

namespace penumbra::io {
namespace {

// What finish() makes of a schema's fields is `out`, the message of ROS 2.
namespace foxglove {

struct Time {
  static constexpr std::string_view full_name = "google.protobuf.Timestamp";
  void fields(auto& io) {
    io(1, "seconds", seconds);
    io(2, "nanos", nanos);
  }

  std::int64_t seconds = 0;
  std::int32_t nanos = 0;
};

std::string read_stamp(const Time& time, std::int64_t& stamp) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max() / nanoseconds_of_second;
  if (time.seconds < 0 || time.seconds >= most || time.nanos < 0 ||
      time.nanos >= nanoseconds_of_second)
    return "timestamp: " + std::to_string(time.seconds) + " s and " + std::to_string(time.nanos) +
           " ns are no time from 1970 to 2262";
  stamp = time.seconds * nanoseconds_of_second + time.nanos;
  return {};
}

// Without stamps, all messages would be of one instant.
std::string read_stamp(const std::optional<Time>& time, std::int64_t& stamp) {
  return time ? read_stamp(*time, stamp) : "timestamp: is missing";
}

struct RawImage {
  static constexpr std::string_view full_name = "foxglove.RawImage";
  void fields(auto& io) {
    io(1, "timestamp", time);
    io(2, "width", out.width);
    io(3, "height", out.height);
    io(4, "encoding", out.encoding);
    io(5, "step", out.step);
    io(6, "data", out.data);
    io(7, "frame_id", out.header.frame_id);
  }
  std::string finish() {
    if (out.encoding == "uyvy") out.encoding = "yuv422";
    if (out.encoding == "yuyv") out.encoding = "yuv422_yuy2";
    if (out.encoding == "8UC1") out.encoding = "mono8";
    return read_stamp(time, out.header.stamp);
  }

  std::optional<Time> time = {};
  ImageMessage out = {};
};

struct CompressedImage {
  static constexpr std::string_view full_name = "foxglove.CompressedImage";
  void fields(auto& io) {
    io(1, "timestamp", time);
    io(2, "data", out.data);
    io(3, "format", out.format);
    io(4, "frame_id", out.header.frame_id);
  }
  std::string finish() { return read_stamp(time, out.header.stamp); }

  std::optional<Time> time = {};
  CompressedImageMessage out = {};
};

struct CompressedVideo {
  static constexpr std::string_view full_name = "foxglove.CompressedVideo";
  void fields(auto& io) {
    io(1, "timestamp", time);
    io(2, "frame_id", out.header.frame_id);
    io(3, "data", out.data);
    io(4, "format", out.format);
  }
  std::string finish() { return read_stamp(time, out.header.stamp); }

  std::optional<Time> time = {};
  CompressedVideoMessage out = {};
};

template <std::size_t N>
std::string copy_matrix(const char* field, const std::vector<double>& from,
                        std::array<double, N>& to) {
  if (from.size() != N)
    return std::string(field) + ": has " + std::to_string(from.size()) + " values; expected " +
           std::to_string(N);
  std::copy(from.begin(), from.end(), to.begin());
  return {};
}

struct CameraCalibration {
  static constexpr std::string_view full_name = "foxglove.CameraCalibration";
  void fields(auto& io) {
    io(1, "timestamp", time);
    io(2, "width", out.width);
    io(3, "height", out.height);
    io(4, "distortion_model", out.distortion_model);
    io(5, "D", out.d);
    io(6, "K", k);
    io(7, "R", r);
    io(8, "P", p);
    io(9, "frame_id", out.header.frame_id);
  }
  std::string finish() {
    if (out.distortion_model == "kannala_brandt") out.distortion_model = "equidistant";
    if (r.empty()) r = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // only stereo cameras have it
    if (p.empty()) p.resize(out.p.size());           // as ROS says "not known"
    std::string fault = copy_matrix("K", k, out.k);
    if (fault.empty()) fault = copy_matrix("R", r, out.r);
    if (fault.empty()) fault = copy_matrix("P", p, out.p);
    return fault.empty() ? read_stamp(time, out.header.stamp) : fault;
  }

  Time time = {};
  std::vector<double> k = {}, r = {}, p = {};
  CameraInfoMessage out = {};
};

struct Vector3 : Vector3Wire {
  static constexpr std::string_view full_name = "foxglove.Vector3";
  void fields(auto& io) {
    io(1, "x", x);
    io(2, "y", y);
    io(3, "z", z);
  }
};

struct Quaternion : QuaternionWire {
  static constexpr std::string_view full_name = "foxglove.Quaternion";
  Quaternion() { w = 0; }  // protobuf leaves out zeros
  void fields(auto& io) {
    io(1, "x", x);
    io(2, "y", y);
    io(3, "z", z);
    io(4, "w", w);
  }
};

struct FrameTransform {
  static constexpr std::string_view full_name = "foxglove.FrameTransform";
  void fields(auto& io) {
    io(1, "timestamp", time);
    io(2, "parent_frame_id", transform.header.frame_id);
    io(3, "child_frame_id", transform.child_frame_id);
    io(4, "translation", translation);
    io(5, "rotation", rotation);
  }
  std::string finish() {
    if (transform.child_frame_id.empty()) return "child_frame_id: is missing";
    transform.T_parent_child = isometry_of(translation, rotation);
    std::string fault = read_stamp(time, transform.header.stamp);
    out.transforms = {transform};
    return fault;
  }

  Time time = {};
  TransformMessage transform = {};
  Vector3 translation = {};
  Quaternion rotation = {};
  TfMessage out = {};
};

struct FrameTransforms {
  static constexpr std::string_view full_name = "foxglove.FrameTransforms";
  void fields(auto& io) { io(1, "transforms", transforms); }
  std::string finish() {
    for (const FrameTransform& one : transforms) out.transforms.push_back(one.transform);
    return {};
  }

  std::vector<FrameTransform> transforms = {};
  TfMessage out = {};
};

struct JointState {
  static constexpr std::string_view full_name = "foxglove.JointState";
  void fields(auto& io) {
    io(1, "name", joint);
    io(2, "position", position);
  }
  [[nodiscard]] std::string finish() const { return joint.empty() ? "name: is missing" : ""; }

  std::string joint = {};
  std::optional<double> position = {};
};

struct JointStates {
  static constexpr std::string_view full_name = "foxglove.JointStates";
  void fields(auto& io) {
    io(1, "timestamp", time);
    io(2, "joints", joints);
  }
  std::string finish() {
    for (const JointState& state : joints) {
      if (std::isnan(state.position.value_or(NAN))) continue;  // by the schema both say "none"
      out.names.push_back(state.joint);
      out.positions.push_back(*state.position);
    }
    return read_stamp(time, out.header.stamp);
  }

  std::optional<Time> time = {};
  std::vector<JointState> joints = {};
  JointStateMessage out = {};
};

using Schemas = std::tuple<RawImage, CompressedImage, CompressedVideo, CameraCalibration,
                           FrameTransform, FrameTransforms, JointStates>;

// Calls `call` with the struct of a schema, if it is one of Schemas.
template <typename F>
void with_schema(std::string_view name, const F& call) {
  const auto call_if_named = [&](auto& schema) {
    if (schema.full_name == name) call(schema);
  };
  Schemas all;
  std::apply([&](auto&... schemas) { (call_if_named(schemas), ...); }, all);
}

}  // namespace foxglove
}  // namespace

std::string ros_type_of(std::string_view type) {
  std::string ros_type(type);
  foxglove::with_schema(type, [&](const auto& schema) {
    ros_type = message_type<std::remove_cvref_t<decltype(schema.out)>>();
  });
  return ros_type;
}

bool is_readable(std::string_view type, std::string_view encoding) {
  return encoding == (ros_type_of(type) == type ? "cdr" : "protobuf");
}

void check_foxglove_schema(std::string_view schema, std::string_view descriptors) {
  protobuf::DescribedFiles described;
  std::string fault = protobuf::read(std::as_bytes(std::span(descriptors)), described);
  foxglove::with_schema(schema, [&]<typename S>(const S&) {
    if (fault.empty()) fault = protobuf::difference<S>(described);
  });
  if (!fault.empty())
    throw InputError("schema of " + printable(schema) + ": " + fault +
                     "; messages are read as foxglove-sdk defines them");
}

template <typename M>
std::optional<std::string> decode_foxglove(std::string_view schema,
                                           std::span<const std::byte> payload, M& message) {
  std::string fault = "cannot be read as " + std::string(M::ros_type);
  foxglove::with_schema(schema, [&](auto& found) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(found.out)>, M>) {
      fault = protobuf::read(payload, found);
      message = std::move(found.out);
    }
  });
  if (fault.empty()) return std::nullopt;
  return printable(schema) + ": " + fault;
}

using FoxgloveFault = std::optional<std::string>;
using FoxgloveBytes = std::span<const std::byte>;
template FoxgloveFault decode_foxglove(std::string_view, FoxgloveBytes, ImageMessage&);
template FoxgloveFault decode_foxglove(std::string_view, FoxgloveBytes, CompressedImageMessage&);
template FoxgloveFault decode_foxglove(std::string_view, FoxgloveBytes, CompressedVideoMessage&);
template FoxgloveFault decode_foxglove(std::string_view, FoxgloveBytes, CameraInfoMessage&);
template FoxgloveFault decode_foxglove(std::string_view, FoxgloveBytes, JointStateMessage&);
template FoxgloveFault decode_foxglove(std::string_view, FoxgloveBytes, TfMessage&);

}  // namespace penumbra::io
