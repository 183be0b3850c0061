// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>

#include <io/assembly/depth_input.hpp>

namespace penumbra::io {
namespace {

std::string pixels_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

}  // namespace

DepthInput::DepthInput(const Camera& judged, const std::optional<Camera>& depth_camera)
    : width_((depth_camera ? *depth_camera : judged).intrinsics.width()),
      height_((depth_camera ? *depth_camera : judged).intrinsics.height()) {
  if (depth_camera) registration_.emplace(*depth_camera, judged);
}

template <typename M>
std::string DepthInput::decode(const M& message, DepthView& depth) {
  if (const auto fault = decode_depth(message, decoded_)) return *fault;
  depth = decoded_.view;
  return {};
}

template std::string DepthInput::decode(const ImageMessage&, DepthView&);
template std::string DepthInput::decode(const CompressedImageMessage&, DepthView&);

std::string DepthInput::check_size(DepthView& depth) const {
  const auto [width, height] =
      std::visit([](const auto& view) { return std::pair(view.width, view.height); }, depth);
  if (width == width_ && height == height_) return {};
  depth = {};
  return "the depth image is " + pixels_text(width, height) + ", the camera " +
         pixels_text(width_, height_);
}

std::string DepthInput::bring(const TransformAnswer& T_judged_depth, DepthView& depth) {
  if (T_judged_depth.status != TransformStatus::ok)
    return "depth cannot be brought to the color camera: " + T_judged_depth.message;
  depth = registration_->warp(depth, T_judged_depth.T_target_source);
  return {};
}

}  // namespace penumbra::io
