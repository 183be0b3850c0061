// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <penumbra/calibration/problem.hpp>
#include <penumbra/diagnosis/hypothesis-inl.hpp>

namespace penumbra {
namespace diagnosis {
namespace {

constexpr double wide = 0.06;  // metres between measured and virtual depth that agree
// Of the best gain, of what cannot be ruled out; of overlaps where they are the score.
constexpr double may_explain = 0.6, may_overlap = 0.9;
constexpr double great_gain = 0.3;  // of the score
constexpr double good_fit = 0.8;    // Rating::fit of a right setup, about

struct Limits {
  double gain, fit;  // of a mistake that is named
  double explains;   // of the best gain: as good as the best
};
constexpr Limits usual{0.03, 0.6, 0.85};  // right setups gain up to 0.012
/// Their best score is 0.1 to 0.5, and right setups gain up to 0.015. A pose is judged by its
/// masks: what explains a little less is another mistake.
constexpr Limits of_colors{0.02, 0.4, 0.98};

class Comparison {
 public:
  explicit Comparison(const Setup& setup)
      : setup_(setup),
        limits_(setup.has_colors() ? of_colors : usual),
        model_(setup.robot, setup.parent),
        unknowns_{.holds_depth = !setup.has_depth()},
        observer_(model_, setup.camera, unknowns_),
        frames_(calibration::pointers_to(setup.frames)),
        agreement_(setup, frames_),
        given_(agreement_.rate(as_given(setup), wide)) {
    if (!setup.has_colors()) return;
    masked_.assign(setup.frames.begin(), setup.frames.end());
    frames_ = calibration::pointers_to(masked_);
  }

  Diagnosis run(bool is_suspicious) {
    Diagnosis result;
    if (setup_.has_colors() && agreement_.compared() < KeptFrames::least) return result;
    result.poses = agreement_.compared();
    result.frame = setup_.frames[agreement_.worst()].index;
    if (is_suspicious) {
      for (Hypothesis& hypothesis : mistakes(setup_)) add(std::move(hypothesis));
      polish();
    }
    if (setup_.frames.size() < KeptFrames::least)
      std::erase_if(rated_, [](const Hypothesis& rated) { return !!rated.with_amount; });
    else if (setup_.has_colors())
      compare_colors();
    else if (!is_explained())
      add_pose();
    if (!setup_.has_colors())
      std::erase_if(rated_, [](const Hypothesis& rated) { return !(rated.rating.more > 0.0); });
    sort();
    result.score = given_.score;
    choose(result);
    if (result.cause == Cause::none) name_small_error(result);
    return result;
  }

 private:
  /// Whether a mistake without unknowns explains so much that the camera's pose is no matter.
  [[nodiscard]] bool is_explained() const {
    return std::ranges::any_of(rated_, [&](const Hypothesis& rated) {
      return !rated.with_amount && rated.rating.fit > good_fit &&
             rated.rating.score > std::max(0.0, given_.score) + great_gain;
    });
  }

  [[nodiscard]] bool shows_robot() const {
    return shows_robot_.value_or(given_.fit >= limits_.fit);
  }

  void add(Hypothesis hypothesis) {
    hypothesis.rating = agreement_.rate(hypothesis, wide);
    rated_.push_back(std::move(hypothesis));
  }

  /// Brings the best to the front.
  void sort() {
    std::ranges::stable_sort(rated_, std::ranges::greater{},
                             [](const Hypothesis& rated) { return rated.rating.score; });
  }

  /// Finds better amounts near the best of each cause.
  void polish() {
    sort();
    constexpr int most = 3;
    constexpr double least_amount = 0.3;  // of a step; less is no mistake
    std::map<Cause, int> done;
    for (Hypothesis& rated : rated_) {
      const auto make = rated.with_amount;
      if (!make || done[rated.cause]++ >= most) continue;
      const double step = rated.step;
      for (double by = 0.5 * step; by > 0.05 * step; by *= 0.5)
        for (const double sign : {-1.0, 1.0}) {
          const double amount = rated.amount + sign * by;
          if (std::abs(amount) < least_amount * step) continue;
          Hypothesis other = make(amount);
          if (other.cause == Cause::none) continue;
          other.amount = amount;
          other.step = step;
          other.with_amount = make;
          other.rating = agreement_.rate(other, wide);
          if (other.rating.score <= rated.rating.score) continue;
          rated = std::move(other);
          break;
        }
    }
  }

  /// Adds the camera's pose that fits best.
  void add_pose() {
    // A camera on a moving link sees less of the robot in each frame.
    const std::size_t count = setup_.parent == 0 && setup_.has_depth()
                                  ? std::min<std::size_t>(4, frames_.size())
                                  : frames_.size();
    calibration::FramePointers some;
    for (std::size_t i = 0; i < count; ++i) some.push_back(frames_[i * frames_.size() / count]);
    std::vector<Eigen::Isometry3d> starts{setup_.T_parent_camera};
    if (given_.fit < good_fit) {
      calibration::PoseSearch search(model_, setup_.camera, some, setup_.parent == 0, 1);
      starts.push_back(search.candidates(starts[0]).front());
      if (setup_.parent != 0 || setup_.has_masks()) starts.push_back(search.near(starts[0]));
    }
    Hypothesis best = as_given(setup_);
    best.rating.score = -10.0;
    for (const Eigen::Isometry3d& start : starts) {
      calibration::Refined refined = calibration::refine(
          observer_, unknowns_, frames_, {.T_parent_camera = start, .joint_offsets = {}});
      Hypothesis hypothesis = with_pose(refined.state.T_parent_camera);
      if (hypothesis.rating.score <= best.rating.score) continue;
      best = std::move(hypothesis);
      refined_ = std::move(refined);
    }
    add_refined(std::move(best));
  }

  void add_refined(Hypothesis hypothesis) {
    // Farther off it is another mistake, which the search happens to undo.
    const double farthest = setup_.has_colors() ? 0.4 : 1.0;  // metres
    if (off().position() > farthest) return;
    hypothesis.message = pose_text();
    rated_.push_back(std::move(hypothesis));
  }

  [[nodiscard]] Hypothesis with_pose(const Eigen::Isometry3d& T_parent_camera) {
    Hypothesis hypothesis = as_given(setup_);
    hypothesis.cause = Cause::camera_pose;
    hypothesis.T_parent_camera = T_parent_camera;
    hypothesis.rating = agreement_.rate(hypothesis, wide);
    return hypothesis;
  }

  /// Keeps what shows the robot as calibrate() wants it. If the given setup does not, the overlap
  /// is the score: a robot with little contrast to its background scores best out of view.
  void compare_colors() {
    constexpr std::size_t most_tested = 8;  // with amounts
    search_.emplace(model_, setup_.camera, frames_, true, 1);
    Hypothesis as_it_is = as_given(setup_);
    as_it_is.rating.fit = limits_.fit;  // the overlap decides alone
    const double overlap = overlap_of(as_it_is);
    shows_robot_ = overlap >= calibration::least_by_color;
    sort();
    std::vector<Hypothesis> shown;
    std::size_t tested = 0;
    bool is_explained = false;  // the camera's pose is written in another way
    for (Hypothesis& rated : rated_) {
      if (*shows_robot_ && rated.rating.score - given_.score < limits_.gain) break;
      if (rated.with_amount && tested++ >= most_tested) continue;
      const double its = overlap_of(rated);
      if (its < std::max(overlap, calibration::least_by_color)) continue;
      if (!*shows_robot_) rated.rating.score = its;
      is_explained |= !rated.T_parent_camera.isApprox(setup_.T_parent_camera);
      shown.push_back(std::move(rated));
    }
    rated_ = std::move(shown);
    if (!*shows_robot_) given_.score = overlap;
    const Eigen::Isometry3d& given = setup_.T_parent_camera;
    if (is_explained) return;
    if (!fits_from(given) && !fits_from(search_->near(given)) &&
        !fits_from(search_->candidates(given).front()) &&
        !fits_from(search_->candidates(given, calibration::low_contrast).front())) {
      refined_.reset();
      return;
    }
    Hypothesis pose = with_pose(refined_->state.T_parent_camera);
    if (!*shows_robot_) pose.rating.score = observer_.overlap(masked_, refined_->state);
    add_refined(std::move(pose));
  }

  /// Of the robot by a hypothesis and what hides the background there; 0 if it does not follow the
  /// joints.
  [[nodiscard]] double overlap_of(const Hypothesis& hypothesis) {
    if (hypothesis.rating.fit < limits_.fit) return 0.0;
    for (std::size_t k = 0; k < masked_.size(); ++k)
      if (!hypothesis.T_root_link[k].empty()) masked_[k].T_root_link = hypothesis.T_root_link[k];
    const calibration::State state{.T_parent_camera = hypothesis.T_parent_camera,
                                   .joint_offsets = {}};
    calibration::Observer observer(model_, hypothesis.camera, unknowns_);
    calibration::mask_by_color(masked_, search_->frames(), observer, state);
    const double overlap = observer.overlap(masked_, state);
    for (std::size_t k = 0; k < masked_.size(); ++k)
      masked_[k].T_root_link = setup_.frames[k].T_root_link;
    return overlap;
  }

  bool fits_from(const Eigen::Isometry3d& start) {
    refined_ = calibration::refine_by_color(masked_, *search_, observer_, unknowns_, start);
    return observer_.overlap(masked_, refined_->state) >= calibration::least_by_color;
  }

  /// How far the camera is from where it is said to be.
  [[nodiscard]] Drift off() const {
    Drift off;
    off.T_calibrated_camera = setup_.T_parent_camera.inverse() * refined_->state.T_parent_camera;
    off.covariance = refined_->covariance.topLeftCorner<6, 6>();
    return off;
  }

  [[nodiscard]] std::string pose_text() const {
    constexpr double far = 0.1, turned = 10.0 * std::numbers::pi / 180.0;  // calibrate starts there
    const Drift found = off();
    const std::string by = calibration::amount_of(found, 0);
    if (by.empty())
      return "the camera's pose is off, and these frames do not tell how far: run 'penumbra "
             "calibrate --search' on this input";
    const bool is_far = found.position() > far || found.rotation() > turned;
    return "the camera's pose is about " + by + " off: run 'penumbra calibrate" +
           (is_far ? " --search" : "") + "' on this input";
  }

  /// Names an error of the pose that is small but certain, or what else explains it.
  void name_small_error(Diagnosis& result) {
    constexpr double certain = 1.5;  // error bars: one in a thousand right setups is this far off
    constexpr double position = 0.008, rotation = 0.5 * std::numbers::pi / 180.0;  // metres, rad
    if (!refined_ || !refined_->covariance.allFinite()) return;
    if (!setup_.has_colors() && !shows_robot()) return;
    const Drift found = off();
    if (!(found.position() > position && found.position() > certain * found.position_error()) &&
        !(found.rotation() > rotation && found.rotation() > certain * found.rotation_error()))
      return;
    result.cause = Cause::camera_pose;
    result.message = pose_text();
    calibration::Explained explained =
        calibration::explain(observer_, unknowns_, frames_, *refined_);
    if (setup_.is_scanner)  // its images have the focal length that they were drawn with
      std::erase_if(explained.causes, [](const calibration::FoundCause& one) {
        return one.cause.kind == calibration::Cause::Kind::focal;
      });
    if (explained.causes.empty()) return;
    using Kind = calibration::Cause::Kind;
    const Kind kind = explained.causes.front().cause.kind;
    result.other = Cause::camera_pose;
    result.cause = kind == Kind::joint   ? Cause::joint_zero
                   : kind == Kind::clock ? Cause::joint_time
                                         : Cause::intrinsics;
    result.message =
        calibration::text_of(explained.causes.front(), explained, setup_.robot, setup_.raw_camera) +
        "; or " + result.message;
  }

  /// Of those that explain as much as the best, the simplest; and what else cannot be ruled out.
  void choose(Diagnosis& result) const {
    if (rated_.empty() || rated_.front().rating.fit < limits_.fit) {
      if (shows_robot()) return;
      result.cause = Cause::unexplained;
      result.message =
          std::string("the ") +
          (setup_.has_depth()   ? "depth images"
           : setup_.has_masks() ? "masks"
                                : "colour images") +
          " do not show the robot where the setup says, and no single known mistake explains it: "
          "compare the overlay of frame " +
          std::to_string(result.frame) +
          " with the URDF, the joint positions, camera_info and the camera's pose (of the optical "
          "frame, in metres)";
      if (setup_.has_depth() && largest_depth(setup_) <= normalised)
        result.message += "; no depth is above 1 m: is it normalised to 0 to 1? give metres";
      if (setup_.frames.size() < KeptFrames::least)
        result.message += "; three different poses of the robot would tell more";
      return;
    }
    result.best = rated_.front().rating.score;
    const double gain = std::max(1e-9, result.best - given_.score);
    // Few frames fit some wrong setup by chance.
    const bool is_certain = setup_.has_colors() && !shows_robot();
    if (!is_certain &&
        gain < (setup_.frames.size() < KeptFrames::least ? great_gain : limits_.gain))
      return;
    const auto explained = [&](const Hypothesis& rated) {
      return (rated.rating.score - given_.score) / gain;
    };
    const auto unknowns = [](const Hypothesis& rated) {
      return rated.cause == Cause::camera_pose ? 6 : rated.with_amount ? 1 : 0;
    };
    const Hypothesis* best = &rated_.front();
    for (const Hypothesis& rated : rated_)
      if (explained(rated) >= limits_.explains && rated.rating.fit >= limits_.fit &&
          unknowns(rated) < unknowns(*best))
        best = &rated;
    result.cause = best->cause;
    result.message = best->message;
    const auto is_other = [&](Cause cause) {  // a unit is a scale
      return cause != result.cause &&
             !(result.cause == Cause::depth_unit && cause == Cause::depth_scale);
    };
    for (const Hypothesis& rated : rated_)
      if (explained(rated) >= (is_certain ? may_overlap : may_explain) &&
          rated.rating.fit >= limits_.fit && is_other(rated.cause)) {
        result.other = rated.cause;
        result.message += "; or " + rated.message;
        break;
      }
  }

  const Setup& setup_;
  const Limits& limits_;
  calibration::Model model_;
  calibration::Unknowns unknowns_;
  calibration::Observer observer_;
  std::vector<KeptFrame> masked_;  // those of colour images, with masks
  calibration::FramePointers frames_;
  Agreement agreement_;
  Rating given_;
  std::optional<calibration::Refined> refined_;    // the camera's pose that fits best
  std::optional<calibration::PoseSearch> search_;  // by colours
  std::optional<bool> shows_robot_;  // by colours: the background is hidden where the robot is
  std::vector<Hypothesis> rated_;
};

}  // namespace
}  // namespace diagnosis

std::string_view to_string(Diagnosis::Cause cause) {
  constexpr std::array<std::string_view, 16> names{
      "none",        "depth_unit",      "depth_scale",       "depth_ray",
      "camera_unit", "camera_inverted", "camera_transposed", "camera_axes",
      "camera_pose", "intrinsics",      "joint_unit",        "joint_sign",
      "joint_zero",  "joint_order",     "joint_time",        "unexplained"};
  return names.at(static_cast<std::size_t>(cause));
}

Diagnosis diagnose(std::span<const KeptFrame> frames, const Intrinsics& camera,
                   const Intrinsics& raw_camera, const Robot& robot, std::size_t camera_parent,
                   const Eigen::Isometry3d& T_parent_camera, bool is_suspicious, bool is_scanner) {
  if (frames.empty()) return {};
  const diagnosis::Setup setup{frames,        camera,          raw_camera, robot,
                               camera_parent, T_parent_camera, is_scanner};
  Diagnosis found = diagnosis::Comparison(setup).run(is_suspicious);
  if (is_scanner) found.message = calibration::of_scans(std::move(found.message));
  return found;
}

}  // namespace penumbra
