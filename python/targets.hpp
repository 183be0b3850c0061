// SPDX-License-Identifier: Apache-2.0
// Targets of Python's: they keep what C++'s refer to.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <python/arrays.hpp>
#include <python/robot.hpp>

#include <penumbra/pipeline/target.hpp>

namespace penumbra::python {

// Arguments that are checked after the call.
using MaskSource = Shown<"Annotated[Union[NDArray[uint8], NDArray[bool_]], '(H, W)']">;
using CornerSource = Shown<"Annotated[NDArray[float64], '(N, 2)']">;
using ValueSource = Shown<"Annotated[NDArray[float64], '(4, 4) or (3,)']">;

struct Polygon {
  std::vector<Eigen::Vector2d> corners;
};
struct Mask {
  py::array array;
  ImageView<const std::uint8_t> view;
};
struct RunLengths {
  int width = 0, height = 0;
  std::vector<std::uint32_t> counts;
};
struct Rendered {
  py::array array;
  ImageView<const float> view;
};
using OwnedRegion = std::variant<PixelBox, Polygon, Mask, RunLengths, PixelEllipse, Rendered>;

/// Refers to `region`.
[[nodiscard]] Region region_of(const OwnedRegion& region);

/// ReferenceFrame: null is the camera, an empty name the root.
using FrameName = std::optional<std::string>;

struct OwnedRegionTarget {
  OwnedRegion region;
  Extent extent = RegionTarget{}.extent;
  std::optional<double> expected_depth;
};
struct OwnedPointTarget {
  Eigen::Vector3d position;
  double radius = PointTarget{}.radius;
  FrameName frame;
};
struct OwnedBoxTarget {
  Eigen::Isometry3d pose;
  Eigen::Vector3d size;
  FrameName frame;
};
struct OwnedMeshTarget {
  Mesh mesh;
  Eigen::Isometry3d pose;
  FrameName frame;
};
using OwnedShape = std::variant<std::monostate, OwnedRegionTarget, KeypointTarget, OwnedPointTarget,
                                OwnedBoxTarget, OwnedMeshTarget>;

struct OwnedEstimate {
  std::variant<Eigen::Isometry3d, Eigen::Vector3d, std::monostate> value;
  std::optional<std::int64_t> stamp;
  FrameName frame;
  std::optional<Matrix6d> covariance;
};

struct OwnedTarget {
  std::string name;
  OwnedShape shape;
  bool has_identity = Target{}.has_identity;
  std::string frame_id;
  std::optional<std::int64_t> stamp;
  double depth_margin = Target{}.depth_margin;
  TargetThresholds thresholds;
  TargetHandling handling;
  std::optional<OwnedEstimate> estimate;
  std::string fault;
};

/// Refers to `target`.
[[nodiscard]] Target target_of(const OwnedTarget& target);

/// Whose targets are given out: a file's or a bag's.
struct TargetSource {
  std::uint64_t given = 0;  ///< how often
  OneThread thread;
};

/// Targets of a file or a bag, valid until that gives the next ones.
class SourceTargets {
 public:
  /// `source` lives as long as what the targets refer to.
  SourceTargets(std::shared_ptr<TargetSource> source, std::span<const Target> targets)
      : source_(std::move(source)), number_(source_->given), targets_(targets) {}

  /// Throws ValueError once the source has given others.
  [[nodiscard]] std::span<const Target> targets() const;

  /// Keeps the source from giving others meanwhile.
  [[nodiscard]] OneThread::Use hold() const {
    return {source_->thread, "targets of a file or bag"};
  }

 private:
  std::shared_ptr<TargetSource> source_;
  std::uint64_t number_;
  std::span<const Target> targets_;
};

}  // namespace penumbra::python
