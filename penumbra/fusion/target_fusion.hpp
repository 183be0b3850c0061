// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// One of several cameras that judge the same targets.
struct ViewCamera {
  std::string name;
  Intrinsics intrinsics;  ///< of the report's images: Pipeline::intrinsics()
  Tolerance tolerance;    ///< of Pipeline::rule(); the noise of its depths
};

/// A target as one camera judged it.
struct CameraView {
  std::size_t camera = 0;             ///< index into TargetFusion::cameras()
  std::optional<std::int64_t> stamp;  ///< of the image, nanoseconds; null: no view in the window
  Verdict verdict = Verdict::unknown;
  std::string reason;           ///< one line if the verdict is unknown, else empty
  double visible_fraction = 0;  ///< clear and front, of the target's pixels inside the image

  /// The target's centre in the root link's frame, metres: half its radius behind the measured
  /// surface. Its radius is that of a disc with as many pixels. Null if the camera does not measure
  /// it, or if the image's border may cut the target, whose middle is elsewhere then. The rest is
  /// valid only with a point.
  std::optional<Eigen::Vector3d> point;
  /// Of the point, square metres. Along the ray: the noise of the depth, and the centre anywhere
  /// between the surface and a radius behind it. Across: a pixel, a twentieth of the radius, and
  /// the radius times the part that is not seen. In all directions 5 mm, of the camera's pose.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double distance = 0;  ///< from the camera's centre to the surface, metres
  double angle = 0;     ///< from the optical axis, radians
};

/// Two cameras that measure a target at different places.
struct Contradiction {
  std::size_t first = 0, second = 0;  ///< indices into TargetFusion::cameras()
  double distance = 0;                ///< between the points, metres
  double chi_square = 0;              ///< squared Mahalanobis distance, 3 degrees of freedom
};

/// The result for one target over all cameras.
struct FusedTarget {
  std::string name;
  std::int64_t stamp = 0;  ///< of the newest view, nanoseconds
  Verdict verdict = Verdict::unknown;
  std::string reason;               ///< one line if the verdict is unknown, else empty
  std::vector<CameraView> views;    ///< of the cameras that judge it, in the order of cameras()
  std::optional<std::size_t> best;  ///< camera that sees it best, index into cameras(); null: none

  /// In the root link's frame, metres; null if no camera measures it, or if two contradict.
  std::optional<Eigen::Vector3d> point;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the point, square metres
  std::optional<Contradiction> contradiction;            ///< of the pair that differs most
};

struct TargetFusionConfig {
  /// Seconds. A camera whose newest view of a target is older than the target's newest view by
  /// more than this is unknown.
  double window = 0.1;
};

/// The targets of one camera's frame, independent of its report.
struct CameraFrame {
  std::int64_t stamp = 0;                   ///< nanoseconds
  std::map<std::string, CameraView> views;  ///< by target
};

/// Returns the views of a report. Throws InputError for a report without a stamp.
[[nodiscard]] CameraFrame views_of(const ViewCamera& camera, const FrameReport& report);

/// Combines what several cameras say of the same targets into one verdict for each name. Each image
/// is judged alone, at its own stamp. All cameras have one root frame.
///
/// The verdict, by the first rule that applies:
/// - unknown: two cameras measure the target at different places.
/// - held, else visible, else partial, if a camera says so.
/// - unknown: a camera that judges it is unknown, or has no view of it in the window. A camera
///   without any frame in the window is unknown, too.
/// - hidden: hidden in each camera that has it in view.
/// - out_of_view: in all of them.
///
/// The best camera is one that says visible before one that says partial; then by visible fraction,
/// in steps of 0.05; then by distance, then by angle. The point is the cameras' points weighted by
/// their inverse covariances.
class TargetFusion {
 public:
  /// Throws InputError for no camera, a name that is empty or used twice, and a window that is not
  /// finite and positive.
  explicit TargetFusion(std::vector<ViewCamera> cameras, const TargetFusionConfig& config = {});

  [[nodiscard]] std::span<const ViewCamera> cameras() const { return cameras_; }

  /// Takes a frame of camera `camera`. Views older than earlier ones are ignored, so frames may
  /// come in any order. A target that was in no frame for ten windows is forgotten. A stamp that
  /// jumps back by more than a second forgets all of them. Throws InputError for a camera that does
  /// not exist, and as views_of does.
  void add(std::size_t camera, const CameraFrame& frame);
  void add(std::size_t camera, const FrameReport& report);

  /// Returns a target's result. Throws InputError for a target that no camera has judged, or that
  /// is forgotten.
  [[nodiscard]] FusedTarget fused(std::string_view name) const;
  /// Returns the results of all targets, by name.
  [[nodiscard]] std::vector<FusedTarget> fused() const;

 private:
  using Views = std::vector<std::optional<CameraView>>;  // by camera
  struct Record {
    Views views;
    std::int64_t judged;  // stamp of the newest frame with it
  };
  [[nodiscard]] FusedTarget fuse(const std::string& name, const Views& views) const;

  std::vector<ViewCamera> cameras_;
  TargetFusionConfig config_;
  std::vector<std::optional<std::int64_t>> newest_;  // frame of each camera
  std::map<std::string, Record, std::less<>> targets_;
};

}  // namespace penumbra
