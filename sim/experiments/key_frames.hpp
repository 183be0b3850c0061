// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/png.hpp>
#include <sim/experiments/results.hpp>
#include <sim/experiments/sensed.hpp>
#include <sim/simulation.hpp>

namespace penumbra::sim {

/// How an estimate is drawn.
struct Look {
  const char* name;
  io::Rgb8 color;
  bool dashed;
  bool is_below;  ///< its error stands below the box, else above
};

/// Keeps a run's colour images, large ones at half their size, and draws into them what was
/// believed, with its error: the raw estimate in red, dashed, and ours in green.
class KeyFrames {
 public:
  KeyFrames(std::string experiment, const Cell& cell);

  void see(const SimFrame& frame);

  /// The frames that tell the run's story: seen, hidden, at the goal, and so on.
  [[nodiscard]] std::vector<Picture> choose(const SeedRun& run) const;

  /// Frame i as it is drawn.
  [[nodiscard]] Image<io::Rgb8> draw(const SeedRun& run, std::size_t i) const;

 private:
  using Edge = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  void draw_target(const Sample& sample, const Look& look, Image<io::Rgb8>& image) const;
  [[nodiscard]] std::vector<Edge> edges_of(const Eigen::Isometry3d& pose) const;

  std::string experiment_;
  Cell cell_;
  double scale_ = 1.0;  ///< of the kept images
  std::vector<Image<io::Rgb8>> images_;
};

}  // namespace penumbra::sim
