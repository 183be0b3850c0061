// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>
#include <research/seed_run.hpp>
#include <sim/simulation.hpp>

namespace penumbra::research {

/// How an estimate is drawn.
struct LineStyle {
  const char* name;
  Rgb8 color;
  bool dashed;
  bool is_below;  ///< its error is written below the box, else above
};

/// Keeps a run's color images, large ones at half their size, and draws two beliefs into them with
/// their errors: without handling in red, dashed, and Penumbra's in green.
class DrawnFrames {
 public:
  explicit DrawnFrames(const sim::Simulation& simulation);

  void add(const sim::SimFrame& frame);

  /// Writes FOLDER/000000.png and so on. Throws InputError if a file cannot be written.
  void write(const std::filesystem::path& folder, const SeedRun& run) const;

 private:
  using Edge = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  [[nodiscard]] Image<Rgb8> draw(const LaneRun& lane, std::size_t i) const;
  void draw_target(const Sample& sample, const LineStyle& style, Image<Rgb8>& image) const;
  [[nodiscard]] std::vector<Edge> edges_of(const Eigen::Isometry3d& T_camera_target) const;

  Camera camera_;
  Eigen::Isometry3d T_base_camera_;
  Eigen::Vector3d object_size_;  // 0: a wrist
  std::vector<Image<Rgb8>> images_;
};

}  // namespace penumbra::research
