// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/mesh/simplified.hpp>

namespace penumbra::calibration {
namespace {

constexpr int small_width = 128;            // pixels
constexpr double coarse = 0.004;            // metres by which meshes are simplified
constexpr float before_background = 0.05f;  // metres nearer than the background: something moved
constexpr float noise_of_square = 0.03f;    // metres per square metre of depth
constexpr double least_robot = 0.01;        // of the image; less explains nothing

/// Each block's measurement nearest to its centre, of the first few.
Image<float> made_small(const Image<float>& depth, int block) {
  Image<float> out(depth.width() / block, depth.height() / block);
  for (int v = 0; v < out.height(); ++v)
    for (int u = 0; u < out.width(); ++u)
      for (int i = 0; i < block * block && out(u, v) == 0.0f; ++i) {
        const int at = (i + block / 2 * (block + 1)) % (block * block);  // from the middle on
        out(u, v) = depth(u * block + at % block, v * block + at / block);
      }
  return out;
}

/// 1 where the mask covers at least half of what is known of a pixel.
Image<std::uint8_t> made_small(const Image<std::uint8_t>& mask, int block) {
  Image<std::uint8_t> out(mask.width() / block, mask.height() / block);
  for (int v = 0; v < out.height(); ++v)
    for (int u = 0; u < out.width(); ++u) {
      int covered = 0, known = 0;
      for (int i = 0; i < block * block; ++i) {
        const std::uint8_t value = mask(u * block + i % block, v * block + i / block);
        known += value != KeptFrame::not_known;
        covered += value != 0 && value != KeptFrame::not_known;
      }
      out(u, v) = known == 0 ? KeptFrame::not_known : 2 * covered >= known;
    }
  return out;
}

/// The mean brightness of a pixel's block (ITU-R BT.601).
Image<float> made_small(const Image<Rgb8>& color, int block) {
  Image<float> out(color.width() / block, color.height() / block);
  for (int v = 0; v < out.height(); ++v)
    for (int u = 0; u < out.width(); ++u) {
      float sum = 0.0f;
      for (int i = 0; i < block * block; ++i) {
        const Rgb8& pixel = color(u * block + i % block, v * block + i / block);
        sum += 0.299f * pixel.r + 0.587f * pixel.g + 0.114f * pixel.b;
      }
      out(u, v) = sum / static_cast<float>(block * block);
    }
  return out;
}

}  // namespace

SmallFrames::SmallFrames(const Robot& robot, const Intrinsics& camera,
                         std::span<const KeptFrame* const> frames)
    : block_(std::min(std::max(1, camera.width() / small_width), camera.height())) {
  for (const KeptFrame* frame : frames) {
    Small& small = frames_.emplace_back(Small{frame, {}, {}, {}, 1.0f, {}});
    if (frame->depth.empty() && frame->mask.empty()) {
      small.grey = made_small(frame->color, block_);
    } else if (frame->depth.empty()) {
      small.moved = made_small(frame->mask, block_);
    } else {
      small.depth = made_small(frame->depth, block_);
      small.moved = Image<std::uint8_t>(small.depth.width(), small.depth.height());
      small.moved_tiles = TileMask(small.depth.width(), small.depth.height());
    }
  }
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    std::vector<PreparedMesh>& meshes = meshes_.emplace_back();
    for (const PreparedMesh& mesh : robot.meshes(link))
      meshes.emplace_back(simplified(static_cast<const TriangleMesh&>(mesh), coarse));
  }
  set_camera(camera);
}

void SmallFrames::set_camera(const Intrinsics& camera) {
  const Intrinsics small = camera.binned(block_, block_);
  if (renderer_ && renderer_->intrinsics() == small) return;
  std::vector<Body> bodies;
  for (const auto& meshes : meshes_) bodies.push_back({"", meshes});
  renderer_ = make_depth_renderer(Backend::cpu, small, bodies);
}

/// The background is the median depth; the noise of stereo cameras grows with the depth's square.
void SmallFrames::find_moved(double depth_factor) {
  if (moved_factor_ == depth_factor) return;
  moved_factor_ = depth_factor;
  const auto factor = static_cast<float>(depth_factor);
  std::vector<float> depths;
  for (std::size_t i = 0; i < frames_.front().depth.size(); ++i) {
    depths.clear();
    for (Small& small : frames_) {
      small.moved.data()[i] = 0;
      if (const float z = small.depth.data()[i]; z > 0.0f) depths.push_back(factor * z);
    }
    if (depths.size() < KeptFrames::least) continue;
    const float middle = detail::median(depths);
    const float limit = middle - before_background - noise_of_square * middle * middle;
    for (Small& small : frames_)
      if (const float z = factor * small.depth.data()[i]; z > 0.0f && z < limit)
        small.moved.data()[i] = 1;
  }
  for (Small& small : frames_) {
    if (small.depth.empty()) continue;
    small.moved_tiles = TileMask(small.moved.width(), small.moved.height());
    for (int v = 0; v < small.moved.height(); ++v)
      for (int u = 0; u < small.moved.width(); ++u)
        if (small.moved(u, v) != 0) small.moved_tiles.mark(u, v, u, v);
  }
}

/// Light and exposure change the brightness of the whole image.
void SmallFrames::compare_colors() {
  constexpr float dark = 15.0f, bright = 240.0f, different = 20.0f;  // grey levels
  constexpr double least_same = 0.5;                                 // of an image
  Image<float> middle(frames_.front().grey.width(), frames_.front().grey.height());
  const std::size_t pixels = middle.size();
  std::vector<float> values;
  for (std::size_t i = 0; i < pixels; ++i) {
    values.clear();
    for (const Small& small : frames_) values.push_back(small.grey.data()[i]);
    middle.data()[i] = detail::median(values);
  }
  std::erase_if(frames_, [&](Small& small) {
    values.assign(1, 1.0f);
    for (std::size_t i = 0; i < pixels; ++i)
      if (const float grey = middle.data()[i]; grey > dark && grey < bright)
        values.push_back(small.grey.data()[i] / grey);
    small.brightness = 1.0f / std::max(0.1f, detail::median(values));
    small.moved = Image<std::uint8_t>(middle.width(), middle.height());
    std::size_t same = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      float& grey = small.grey.data()[i];
      grey *= small.brightness;
      small.moved.data()[i] = std::abs(grey - middle.data()[i]) > different;
      same += small.moved.data()[i] == 0;
    }
    return static_cast<double>(same) < least_same * static_cast<double>(pixels);
  });
}

double SmallFrames::score(double sum, double most, double frames) const {
  const double least = least_robot * camera().width() * camera().height() * frames;
  return (sum - std::max(0.0, least - most)) / std::max(most, least);
}

}  // namespace penumbra::calibration
