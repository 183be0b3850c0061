// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <variant>

#include <penumbra/pipeline/recent_frames-inl.hpp>

namespace penumbra {
namespace {

template <typename T>
ImageView<const T> copy(ImageView<const T> source, Image<T>& image) {
  if (image.width() != source.width || image.height() != source.height)
    image = Image<T>(source.width, source.height);
  for (int v = 0; v < source.height; ++v)
    std::copy(source.row(v), source.row(v) + source.width, &image(0, v));
  return std::as_const(image).view();
}

std::size_t bytes_of(const DepthView& depth) {
  return std::visit(
      [](const auto& view) {
        return static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height) *
               sizeof(*view.data);
      },
      depth);
}

}  // namespace

RecentFrames::RecentFrames(std::size_t links, std::int64_t span)
    : span_(span), frames_(max_frames) {
  for (Kept& kept : frames_) {
    kept.T_root_link.reserve(links);
    kept.T_camera_link.reserve(links);
  }
}

void RecentFrames::keep(const LabelledFrame& frame) {
  const PoseResult& poses = frame.poses;
  if (!poses.stamp) return;
  Kept& kept = place_for(*poses.stamp);
  kept.stamp = poses.stamp;
  kept.status = poses.status;
  kept.message = poses.message;
  kept.T_root_link.assign(poses.T_root_link.begin(), poses.T_root_link.end());
  kept.T_camera_link.assign(poses.T_camera_link.begin(), poses.T_camera_link.end());
  kept.T_root_camera = poses.T_root_camera;
  kept.doubted_links.assign(poses.doubts.links.begin(), poses.doubts.links.end());
  kept.why_doubted = poses.doubts.why;
  if (!keeps_depth()) return;
  KeptDepth& depth = depth_place_for(*poses.stamp, bytes_of(frame.depth));
  depth.stamp = poses.stamp;
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&frame.depth))
    depth.view = copy(*millimetres, depth.millimetres);
  else
    depth.view = copy(std::get<ImageView<const float>>(frame.depth), depth.metres);
}

RecentFrames::Kept& RecentFrames::place_for(std::int64_t stamp) {
  for (Kept& kept : frames_)
    if (kept.stamp == stamp) return kept;
  next_ = (next_ + 1) % max_frames;
  return frames_[next_];
}

/// The place of the same stamp, else of the farthest one that is out of the span, else a new one.
RecentFrames::KeptDepth& RecentFrames::depth_place_for(std::int64_t stamp, std::size_t bytes) {
  KeptDepth* farthest = nullptr;
  std::uint64_t most = 0;
  for (KeptDepth& depth : depths_) {
    const std::uint64_t far = depth.stamp ? stamp_distance(*depth.stamp, stamp) : ~std::uint64_t{0};
    if (far == 0) return depth;
    if (far > most) {
      most = far;
      farthest = &depth;
    }
  }
  const std::size_t places =
      std::clamp<std::size_t>(max_bytes / std::max<std::size_t>(bytes, 1), 1, max_frames);
  const bool is_over = most > static_cast<std::uint64_t>(span_) || depths_.size() >= places;
  if (farthest != nullptr && is_over) return *farthest;
  return depths_.emplace_back();
}

std::optional<PoseResult> RecentFrames::poses_at(std::int64_t stamp) const {
  for (const Kept& kept : frames_)
    if (kept.stamp == stamp)
      return PoseResult{kept.stamp,
                        kept.status,
                        kept.message,
                        kept.T_root_link,
                        kept.T_camera_link,
                        kept.T_root_camera,
                        {kept.doubted_links, kept.why_doubted}};
  return std::nullopt;
}

std::optional<DepthView> RecentFrames::depth_at(std::int64_t stamp) const {
  for (const KeptDepth& kept : depths_)
    if (kept.stamp == stamp) return kept.view;
  return std::nullopt;
}

void RecentFrames::clear() {
  for (Kept& kept : frames_) kept.stamp.reset();
  for (KeptDepth& depth : depths_) depth.stamp.reset();
}

}  // namespace penumbra
