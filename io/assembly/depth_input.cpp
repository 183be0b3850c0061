// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <variant>

#include <io/assembly/depth_input.hpp>
#include <io/files/depth_pixels.hpp>
#include <io/files/ray_depth.hpp>

namespace penumbra::io {
namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

}  // namespace

DepthInput::DepthInput(const JudgedCameras& cameras)
    : has_depth_(cameras.has_depth), scale_(cameras.depth_scale) {
  const Camera& camera = cameras.depth ? *cameras.depth : cameras.judged;
  width_ = camera.intrinsics.width();
  height_ = camera.intrinsics.height();
  if (cameras.depth_along_ray) z_of_ray_ = z_of_rays(camera);
  if (cameras.depth) registration_.emplace(*cameras.depth, cameras.judged);
}

std::string DepthInput::read(AssembledFrame& job) {
  std::string undecoded;
  std::string& fault = job.source_message;
  if (!has_depth_) {
    if (!fault.empty()) job.source_status = FrameStatus::bad_depth;
    return undecoded;
  }
  if (fault.empty()) fault = undecoded = decode(job.image, job.depth.view);
  if (fault.empty()) fault = bring(job, job.depth.view);
  if (!fault.empty()) {
    job.source_status = FrameStatus::bad_depth;
    job.depth = DepthView();
  }
  return undecoded;
}

std::string DepthInput::decode(const KeptImage& image, DepthView& depth) {
  const auto fault = image.image ? decode_depth(*image.image, decoded_)
                                 : decode_depth(*image.compressed, decoded_);
  if (fault) return *fault;
  depth = decoded_.view;
  if (scale_) {
    scaled_ = std::visit(
        [this](const auto& view) { return shared_depth_of(copy_of(view), scale_); }, depth);
    depth = scaled_.view;
  }
  return {};
}

std::string DepthInput::bring(const AssembledFrame& from, DepthView& depth) {
  const auto [width, height] =
      std::visit([](const auto& view) { return std::pair(view.width, view.height); }, depth);
  if (width != width_ || height != height_)
    return "the depth image is " + size_text(width, height) + ", the camera " +
           size_text(width_, height_);
  if (z_of_ray_.width() > 0) {
    along_z_ = along_z(depth, z_of_ray_);
    depth = along_z_.view;
  }
  if (!registration_) return {};
  if (!knows_robot(from.pose)) {
    depth = DepthView();  // the depth camera's position is not known
    return {};
  }
  if (from.T_judged_depth.status != TransformStatus::ok)
    return "depth cannot be registered to the color camera: " + from.T_judged_depth.message;
  depth = registration_->warp(depth, from.T_judged_depth.T_target_source);
  return {};
}

}  // namespace penumbra::io
