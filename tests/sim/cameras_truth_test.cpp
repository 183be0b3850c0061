// SPDX-License-Identifier: Apache-2.0
// Three cameras around MuJoCo's random arms and targets: each camera's verdicts alone and the fused
// ones against what MuJoCo draws in the three images.
#include "simulated.hpp"

#include <penumbra/fusion/target_fusion.hpp>

namespace penumbra::test {
namespace {

constexpr std::size_t cameras = 3;
constexpr double clearly_hidden = 0.99;  // fraction: above the threshold by more than edges' pixels

/// What is true of a target in one image.
struct ImageTruth {
  bool in_view = false;
  double hidden = 1.0;  ///< fraction of its pixels
};

/// The verdict on the image in which most is seen.
Verdict verdict_in(const std::array<ImageTruth, cameras>& images) {
  double least = 1.0;
  bool in_view = false;
  for (const ImageTruth& image : images) {
    in_view = in_view || image.in_view;
    if (image.in_view) least = std::min(least, image.hidden);
  }
  return in_view ? verdict_of(least) : Verdict::out_of_view;
}

/// Verdicts over all targets and frames, against the truth of the three images.
struct Tally {
  std::size_t targets = 0, same = 0;
  std::size_t visible_and_hidden = 0;  ///< said visible or partial, and hidden in all images
  std::vector<double> errors;          ///< of the points, from the centre, metres

  void add(Verdict said, Verdict is, bool is_hidden) {
    ++targets;
    same += said == is ? 1 : 0;
    const bool is_seen = said == Verdict::visible || said == Verdict::partial;
    visible_and_hidden += is_seen && is_hidden ? 1 : 0;
  }
};

struct Tallies {
  std::array<Tally, cameras> alone;
  Tally fused;
  std::size_t rescued = 0, rescued_right = 0;  ///< hidden in image 0, visible in another
  std::size_t contradictions = 0;
  std::vector<double> squared;  ///< Mahalanobis distances of fused points from the centre
};

class Rig {
 public:
  Rig(std::uint64_t seed, bool noisy) {
    for (std::size_t i = 0; i < cameras; ++i) {
      sim::SimulationOptions options = without_color(seed, noisy);
      options.camera = static_cast<int>(i);
      simulations_.emplace_back("random", options);
      const sim::Simulation& simulation = simulations_.back();
      pipelines_.emplace_back(simulation.robot(), simulation.camera());
      views_.push_back(
          {std::to_string(i), pipelines_.back().intrinsics(), pipelines_.back().rule().tolerance});
    }
  }

  bool next(Tallies& tallies) {
    TargetFusion fusion(views_);  // frames have nothing to do with each other
    std::map<std::string, std::array<ImageTruth, cameras>> truth;
    std::map<std::string, std::array<TargetReport, cameras>> said;
    for (std::size_t i = 0; i < cameras; ++i) {
      if (!simulations_[i].next(frames_[i])) return false;
      std::vector<Target> targets;
      for (const sim::ObjectTruth& object : frames_[i].objects) {
        targets.push_back(target_of(object));
        if (object.pixels_alone == 0) continue;
        truth[object.name][i] = {true,
                                 1.0 - 0.01 * percent(object.pixels_seen, object.pixels_alone)};
      }
      pipelines_[i].forget_targets();
      const FrameReport& report =
          pipelines_[i].process({.stamp = frames_[i].stamp,
                                 .depth = std::as_const(frames_[i].depth).view(),
                                 .pose = {.positions = frames_[i].joints},
                                 .targets = targets});
      fusion.add(i, report);
      for (const TargetReport& target : report.targets) said[std::string(target.name)][i] = target;
    }
    for (const sim::ObjectTruth& object : frames_[0].objects)
      add(object, truth[object.name], said[object.name], fusion.fused(object.name), tallies);
    return true;
  }

 private:
  static void add(const sim::ObjectTruth& object, const std::array<ImageTruth, cameras>& truth,
                  const std::array<TargetReport, cameras>& said, const FusedTarget& fused,
                  Tallies& tallies) {
    const Eigen::Vector3d centre = object.T_base_object.translation();
    const Verdict is = verdict_in(truth);
    const bool is_hidden = std::all_of(truth.begin(), truth.end(), [](const ImageTruth& image) {
      return image.hidden > clearly_hidden;
    });
    for (std::size_t i = 0; i < cameras; ++i) {
      tallies.alone[i].add(said[i].verdict, is, is_hidden);
      if (said[i].point) tallies.alone[i].errors.push_back((*said[i].point - centre).norm());
    }
    tallies.fused.add(fused.verdict, is, is_hidden);
    tallies.contradictions += fused.contradiction ? 1 : 0;
    if (fused.point) {
      const Eigen::Vector3d off = *fused.point - centre;
      tallies.fused.errors.push_back(off.norm());
      tallies.squared.push_back(off.dot(fused.covariance.inverse() * off));
    }
    if (truth[0].in_view && truth[0].hidden > clearly_hidden && is == Verdict::visible) {
      ++tallies.rescued;
      tallies.rescued_right += fused.verdict == Verdict::visible ? 1 : 0;
    }
  }

  std::vector<sim::Simulation> simulations_;
  std::vector<Pipeline> pipelines_;
  std::vector<ViewCamera> views_;
  std::array<sim::SimFrame, cameras> frames_;
};

using CamerasTruth = BothDepths;
INSTANTIATE_TEST_SUITE_P(Depth, CamerasTruth, testing::Bool(), depth_name);

TEST_P(CamerasTruth, TheFusedVerdictIsTheTruthOfAllImages) {
  const int frames = measures_in_full() ? 1000 : samples(40);
  Rig rig(5, GetParam());
  Tallies tallies;
  for (int i = 0; i < frames && rig.next(tallies); ++i) {
  }

  constexpr double least_right = 95.0;    // percent: targets at a threshold may fall to either side
  constexpr double least_rescued = 95.0;  // percent
  constexpr double chi_square = 16.27;    // 99.9 % of three degrees of freedom
  EXPECT_EQ(tallies.fused.visible_and_hidden, 0U);
  EXPECT_GT(percent(tallies.fused.same, tallies.fused.targets), least_right);
  for (const Tally& alone : tallies.alone) {
    EXPECT_GT(tallies.fused.same, alone.same);
    EXPECT_LT(quantile(tallies.fused.errors, 0.5), quantile(alone.errors, 0.5));
  }
  EXPECT_GT(tallies.rescued, 0U);
  EXPECT_GE(percent(tallies.rescued_right, tallies.rescued), least_rescued);
  EXPECT_LE(quantile(tallies.squared, 0.999), chi_square)
      << "the covariance holds the distance from the centre";
  EXPECT_LE(percent(tallies.contradictions, tallies.fused.targets), 0.1);
}

}  // namespace
}  // namespace penumbra::test
