// SPDX-License-Identifier: Apache-2.0
// libFuzzer on ROS 2's messages, definitions and images: the first byte says what the others are
// read as.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <penumbra/base/error.hpp>

#include <io/ros/image_codec.hpp>
#include <io/ros/lidar_messages.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/moveit_messages.hpp>
#include <io/ros/restamp.hpp>

namespace penumbra::io {
namespace {

using Bytes = std::span<const std::byte>;

template <typename M>
void decode_as(Bytes bytes) {
  static const Decoder<M> decoder;
  static M message;
  static_cast<void>(decoder.decode(bytes, message));
}

void parse_definition(Bytes bytes) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Decoder<TargetsMessage>("penumbra_msgs/Targets", text);
    Restamper("a/msg/B", text);
  } catch (const InputError&) {
  }
}

template <int kind>
void decode_image(Bytes bytes) {
  static SharedDepth depth;
  static Image<Rgb8> colours;
  constexpr std::array formats = {"16UC1; compressedDepth png", "32FC1; compressedDepth rvl",
                                  "16UC1; png compressed", "jpeg"};
  const CompressedImageMessage message{.format = formats[kind], .data = bytes};
  if (kind == 3)
    static_cast<void>(decode_color(message, colours));
  else
    static_cast<void>(decode_depth(message, depth));
}

constexpr std::array readers = {parse_definition,
                                decode_image<0>,
                                decode_image<1>,
                                decode_image<2>,
                                decode_image<3>,
                                decode_as<ImageMessage>,
                                decode_as<CameraInfoMessage>,
                                decode_as<JointStateMessage>,
                                decode_as<TfMessage>,
                                decode_as<Detection2DArrayMessage>,
                                decode_as<Detection3DArrayMessage>,
                                decode_as<PointCloud2Message>,
                                decode_as<LaserScanMessage>,
                                decode_as<LivoxMessage>,
                                decode_as<DiagnosticArrayMessage>,
                                decode_as<KeypointsMessage>,
                                decode_as<TargetsMessage>,
                                decode_as<AttachedObjectMessage>,
                                decode_as<PlanningSceneMessage>,
                                decode_as<DisplayTrajectoryMessage>};

}  // namespace
}  // namespace penumbra::io

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(data, size));
  penumbra::io::readers[data[0] % penumbra::io::readers.size()](bytes.subspan(1));
  return 0;
}
