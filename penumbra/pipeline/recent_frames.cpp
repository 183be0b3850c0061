// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <variant>

#include <penumbra/pipeline/recent_frames-inl.hpp>

namespace penumbra {
namespace {

/// The tiles of `before` that are not of `now`.
void find_left(const TileMask& before, const TileMask& now, TileMask& left) {
  for (std::size_t j = 0; j < left.rows.size(); ++j) left.rows[j] = before.rows[j] & ~now.rows[j];
}

/// Makes `image` show `source` inside `now` and zeros outside, given that it is zero outside of
/// `now` and `left`.
template <typename T>
void copy_tiles(ImageView<const T> source, const TileMask& left, const TileMask& now,
                Image<T>& image) {
  left.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) std::fill(&image(u0, v), &image(u0, v) + (u1 - u0), T{0});
  });
  now.for_each_span([&](int u0, int u1, int v0, int v1) {
    for (int v = v0; v < v1; ++v) std::copy(source.row(v) + u0, source.row(v) + u1, &image(u0, v));
  });
}

template <typename T>
void fit(ImageView<const T> source, Image<T>& image) {
  if (image.width() != source.width || image.height() != source.height)
    image = Image<T>(source.width, source.height);
}

template <typename T>
ImageView<const T> copy_all(ImageView<const T> source, Image<T>& image) {
  fit(source, image);
  for (int v = 0; v < source.height; ++v)
    std::copy(source.row(v), source.row(v) + source.width, &image(0, v));
  return std::as_const(image).view();
}

}  // namespace

RecentPoses::RecentPoses(std::size_t links) : links_(links), T_root_link_(links * frames) {}

void RecentPoses::keep(std::int64_t stamp, const FramePoses& poses) {
  const auto same = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const Entry& entry) { return entry.stamp == stamp; });
  std::size_t at = next_;
  if (same != entries_.end())
    at = static_cast<std::size_t>(same - entries_.begin());
  else
    next_ = (next_ + 1) % frames;
  entries_[at].stamp = stamp;
  entries_[at].T_root_camera = poses.T_root_camera;
  entries_[at].doubts.keep(poses.doubts);
  std::copy(poses.T_root_link.begin(), poses.T_root_link.end(),
            T_root_link_.begin() + static_cast<std::ptrdiff_t>(at * links_));
}

std::optional<FramePoses> RecentPoses::find(std::int64_t stamp) const {
  for (std::size_t i = 0; i < frames; ++i)
    if (entries_[i].stamp == stamp)
      return FramePoses{links_of(i), entries_[i].T_root_camera, entries_[i].doubts.view()};
  return std::nullopt;
}

std::span<const Eigen::Isometry3d> RecentPoses::links_of(std::size_t entry) const {
  return std::span(T_root_link_).subspan(entry * links_, links_);
}

void RecentPoses::clear() {
  for (Entry& entry : entries_) entry.stamp.reset();
}

void RecentFrames::keep(const JudgedFrame& frame) {
  if (!any() || !frame.stamp) return;
  const ImageView<const std::uint8_t>& labels = frame.images.labels.labels;
  pixels_ = std::max(
      pixels_, static_cast<std::size_t>(labels.width) * static_cast<std::size_t>(labels.height));
  Copy& copy = place_for(*frame.stamp);
  copy.frame = {frame.stamp, frame.status, {}, {}, {}};
  copy.message = frame.message;
  copy.frame.message = copy.message;
  copy.frame.poses.T_root_camera = frame.poses.T_root_camera;
  if (frame.poses.known()) {
    copy.T_root_link.assign(frame.poses.T_root_link.begin(), frame.poses.T_root_link.end());
    copy.frame.poses.T_root_link = copy.T_root_link;
  }
  copy.doubts.keep(frame.poses.doubts);
  copy.frame.poses.doubts = copy.doubts.view();
  if (!frame.images.labels.labels.empty()) copy_images(frame.images, copy);
}

/// The copy of the same stamp, else the oldest of those that are out of the span, else a new one.
RecentFrames::Copy& RecentFrames::place_for(std::int64_t stamp) {
  Copy* farthest = nullptr;
  std::uint64_t most = 0;
  for (Copy& copy : copies_) {
    const std::uint64_t far =
        copy.frame.stamp ? stamp_distance(*copy.frame.stamp, stamp) : ~std::uint64_t{0};
    if (far == 0) return copy;
    if (far > most) {
      most = far;
      farthest = &copy;
    }
  }
  const std::size_t bytes = 11 * pixels_;  // labels, depth, links, measured
  const std::size_t places = std::clamp<std::size_t>(max_bytes / bytes, 1, max_frames);
  const bool is_over = most > static_cast<std::uint64_t>(span_) || copies_.size() >= places;
  if (farthest != nullptr && is_over) return *farthest;
  return copies_.emplace_back();
}

void RecentFrames::copy_images(const JudgedImages& from, Copy& to) {
  const int width = from.labels.labels.width, height = from.labels.labels.height;
  if (everything_.width != width || everything_.height != height) {
    everything_ = TileMask(width, height);
    everything_.mark(0, 0, width - 1, height - 1);
    left_ = TileMask(width, height);
  }
  if (to.labels.width() != width || to.labels.height() != height) {
    to.labels = Image<std::uint8_t>(width, height);
    to.labels_touched = TileMask(width, height);
  }
  const TileMask& labelled = from.labels.touched ? *from.labels.touched : everything_;
  find_left(to.labels_touched, labelled, left_);
  copy_tiles(from.labels.labels, left_, labelled, to.labels);
  to.labels_touched.rows = labelled.rows;

  JudgedImages& images = to.frame.images;
  images = {};
  images.labels = {std::as_const(to.labels).view(), from.labels.pixels,
                   from.labels.touched ? &to.labels_touched : nullptr};
  copy_virtual_depth(from.virtual_depth, to);
  images.is_blind = from.is_blind;
  if (from.is_blind) return;
  if (const auto* millimetres = std::get_if<ImageView<const std::uint16_t>>(&from.measured))
    images.measured = copy_all(*millimetres, to.millimetres);
  else
    images.measured = copy_all(std::get<ImageView<const float>>(from.measured), to.metres);
}

void RecentFrames::copy_virtual_depth(const VirtualDepthView& from, Copy& to) {
  const int width = from.depth.width, height = from.depth.height;
  if (to.depth.width() != width || to.depth.height() != height) {
    to.depth = Image<float>(width, height);
    to.links = Image<std::uint16_t>(width, height);
    to.touched = TileMask(width, height);
  }
  const TileMask& touched = from.touched ? *from.touched : everything_;
  find_left(to.touched, touched, left_);
  copy_tiles(from.depth, left_, touched, to.depth);
  copy_tiles(from.links, left_, touched, to.links);
  to.touched.rows = touched.rows;
  to.frame.images.virtual_depth = {std::as_const(to.depth).view(), std::as_const(to.links).view(),
                                   &to.touched};
}

const JudgedFrame* RecentFrames::find(std::int64_t stamp) const {
  for (const Copy& copy : copies_)
    if (copy.frame.stamp == stamp) return &copy.frame;
  return nullptr;
}

void RecentFrames::clear() {
  for (Copy& copy : copies_) copy.frame.stamp.reset();
}

}  // namespace penumbra
