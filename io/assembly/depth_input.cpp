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
  if (fault.empty()) fault = undecoded = decode(job.image, job.depth);
  if (fault.empty()) fault = bring(job, job.depth);
  if (!fault.empty()) {
    job.source_status = FrameStatus::bad_depth;
    job.depth = {};
  }
  return undecoded;
}

std::string DepthInput::decode(const KeptImage& image, SharedDepth& depth) const {
  const auto fault = image.image ? decode_depth(*image.image, depth, image.owner)
                                 : decode_depth(*image.compressed, depth);
  if (fault) return *fault;
  if (scale_)
    depth = std::visit([this](const auto& view) { return shared_depth_of(copy_of(view), scale_); },
                       depth.view);
  return {};
}

std::string DepthInput::bring(const AssembledFrame& from, SharedDepth& depth) {
  const auto [width, height] =
      std::visit([](const auto& view) { return std::pair(view.width, view.height); }, depth.view);
  if (width != width_ || height != height_)
    return "the depth image is " + size_text(width, height) + ", the camera " +
           size_text(width_, height_);
  if (z_of_ray_.width() > 0) depth = along_z(depth.view, z_of_ray_);
  if (!registration_) return {};
  if (!knows_robot(from.pose)) {
    depth = {};  // the depth camera's position is not known
    return {};
  }
  if (from.T_judged_depth.status != TransformStatus::ok)
    return "depth cannot be registered to the color camera: " + from.T_judged_depth.message;
  depth = std::visit([](const auto& view) { return shared_depth_of(copy_of(view), {}); },
                     registration_->warp(depth.view, from.T_judged_depth.T_target_source));
  return {};
}

}  // namespace penumbra::io
