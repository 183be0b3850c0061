// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>
#include <penumbra/poses/pose_stage.hpp>

namespace penumbra {
namespace {

using calibration::Cause;
using calibration::Explained;
using calibration::FoundCause;
using calibration::FramePointers;
using calibration::Model;
using calibration::Observer;
using calibration::PoseSearch;
using calibration::Refined;
using calibration::State;
using calibration::Unknowns;
using detail::fixed;

constexpr std::size_t searched = 10;    // frames on which poses are tried
constexpr double least_agreeing = 0.6;  // of the robot's measured pixels
constexpr double color_step = 2.5;      // pixels by which the edges of a link may be off together
/// Of what a pose explains of the images' changes, the share that it does not with the joints of
/// other frames.
constexpr double least_by_joints = 0.4;
constexpr double elsewhere = 0.7;         // of the frames' median share that agrees
constexpr double widest_position = 0.03;  // metres, half axis of the 95 % region
/// The same for masks alone: the robot's distance shows in the size of its picture only.
constexpr double widest_by_masks = 0.06;
constexpr double widest_rotation = 0.03;  // rad
constexpr double untold = 0.02;           // rad, half axis of the 95 % region of the rotation
/// Of the square of how far another pose is: the 95 % region reaches a little farther.
constexpr double covering = 1.0 / 6.0;

Estimate estimate(double value, const Refined& fit, int unknown) {
  return {value, std::sqrt(fit.covariance(unknown, unknown))};
}

void check_input(std::span<const KeptFrame> frames, const Intrinsics& camera, const Robot& robot,
                 const CalibrationOptions& options) {
  check_enough(frames, "calibration");
  if (!(options.joint_accuracy > 0.0) || (options.accept && !(*options.accept > 0.0)))
    throw InputError("joint_accuracy and accept must be above 0");
  const bool has_depth = !frames.front().depth.empty();
  const bool has_colors =
      !has_depth && frames.front().mask.empty() && !frames.front().color.empty();
  if (has_colors &&
      !calibration::stands_still(frames, find_camera_parent(robot, options.camera_parent)))
    throw InputError("colour images show the robot before a camera that stands still, and " +
                     options.camera_parent + " moves: give masks or depth");
  if (!has_depth && (options.joint_offsets || options.time_offset))
    throw InputError(
        "offsets of joints and of the time need depth images; masks or colours alone give the "
        "camera's pose and its focal length");
  for (const KeptFrame& frame : frames) {
    if (has_colors) {
      if (frame.color.width() != camera.width() || frame.color.height() != camera.height())
        throw InputError("frame " + std::to_string(frame.index) +
                         ": its colour image is not of the camera's size");
      continue;
    }
    if (frame.depth.empty() == has_depth || (frame.depth.empty() && frame.mask.empty()))
      throw InputError("frame " + std::to_string(frame.index) + ": has no " +
                       (has_depth ? "depth image" : "mask"));
    if (has_depth &&
        (frame.depth.width() != camera.width() || frame.depth.height() != camera.height()))
      throw InputError("frame " + std::to_string(frame.index) + ": its depth image is " +
                       std::to_string(frame.depth.width()) + "x" +
                       std::to_string(frame.depth.height()) + ", the camera's are " +
                       std::to_string(camera.width()) + "x" + std::to_string(camera.height()));
    if (!frame.mask.empty() &&
        (frame.mask.width() != camera.width() || frame.mask.height() != camera.height()))
      throw InputError("frame " + std::to_string(frame.index) +
                       ": its mask is not of the camera's size");
    if (options.time_offset && !frame.tells_time())
      throw InputError("frame " + std::to_string(frame.index) +
                       ": has no poses before and after it; leave the time offset out");
  }
}

/// The variable that moves most of the robot against the link that carries the camera, and no part
/// of the rest: its zero cannot be distinguished from another pose, and the pose is relative to it.
std::optional<std::size_t> turning_joint(const Robot& robot, std::size_t parent) {
  const std::span<const Joint> joints = robot.joints();
  const std::size_t links = robot.links().size();
  // The links that move with the carrier, and how many hang below each link.
  std::vector<std::size_t> below(links, 1);
  for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint)
    below[joint->parent] += below[joint->child];
  std::vector<bool> is_carrier(links, false);
  is_carrier[parent] = true;
  for (bool grows = true; grows;) {
    grows = false;
    for (const Joint& joint : joints)
      if (!joint.variable && is_carrier[joint.parent] != is_carrier[joint.child])
        is_carrier[joint.parent] = is_carrier[joint.child] = grows = true;
  }
  std::optional<std::size_t> found;
  std::size_t most = 0;
  for (const Joint& joint : joints) {
    if (is_carrier[joint.parent] == is_carrier[joint.child] || joint.mimics) continue;
    const std::size_t moved =
        is_carrier[joint.parent] ? below[joint.child] : links - below[joint.child];
    if (moved <= most) continue;
    most = moved;
    found = joint.variable;
  }
  return found;
}

/// One refinement on the frames that fit.
class Calibrator {
 public:
  Calibrator(std::span<const KeptFrame> frames, const Intrinsics& camera, const Robot& robot,
             const CalibrationOptions& options)
      : frames_(frames),
        camera_(camera),
        robot_(robot),
        options_(options),
        parent_(find_camera_parent(robot, options.camera_parent)),
        turning_(turning_joint(robot, parent_)),
        model_(robot, parent_) {
    unknowns_.holds_depth = !has_depth();
    unknowns_.has_shift = has_depth() && std::ranges::none_of(frames, [](const auto& frame) {
                            return frame.mask.empty();
                          });
    unknowns_.has_time = options.time_offset;
    if (has_colors()) {
      unknowns_.edge_step = color_step;
      masked_.assign(frames.begin(), frames.end());
      frames_ = masked_;
    }
    used_ = calibration::pointers_to(frames_);
  }

  Calibration run() {
    Observer observer(model_, camera_, unknowns_);
    const Refined fit = freed(observer, best_fit(observer));
    const Explained explained = calibration::explain(observer, unknowns_, used_, fit);
    const Unknowns all = with_joints();
    const Refined known = calibration::refine(observer, all, used_, with_zeros(fit.state));
    Calibration result = result_of(known, all, explained);
    for (const KeptFrame& frame : frames_) {
      result.frames.push_back(observer.fit(frame, known.state));
      result.frames.back().used = std::find(used_.begin(), used_.end(), &frame) != used_.end();
    }
    if (unknowns_.has_shift || !has_depth()) {
      result.mask_overlap = observer.overlap(frames_, known.state);
    }
    judge(result, known);
    if (!result.is_good()) return result;
    const std::string causes = name_causes(result, observer, fit, known, explained);
    observer.set_unknowns(unknowns_);
    result.advice = advice(result, observer, known.state) +
                    carrying_frames(equations_at(observer, all, used_, known.state)) +
                    untold_joints(explained, known);
    check_errors(result, causes);
    return result;
  }

 private:
  [[nodiscard]] bool has_depth() const { return !frames_.front().depth.empty(); }
  [[nodiscard]] bool has_colors() const {
    return !has_depth() && (!masked_.empty() || frames_.front().mask.empty());
  }

  /// Estimates the focal lengths and the joints that the images contradict, if asked for.
  Refined freed(Observer& observer, Refined fit) {
    if (options_.focal) {
      unknowns_.focal_count = has_depth() ? 2 : 1;
      fit = calibration::refine(observer, unknowns_, used_, fit.state);
    }
    if (!options_.joint_offsets) return fit;
    const Explained explained = calibration::explain(observer, unknowns_, used_, fit);
    for (const FoundCause& found : explained.causes)
      if (found.cause.kind == Cause::Kind::joint) unknowns_.variables.push_back(found.cause.index);
    return calibration::refine(observer, unknowns_, used_, with_zeros(fit.state));
  }

  /// The unknowns with the zeros of all joints, which are known to
  /// CalibrationOptions::joint_accuracy.
  [[nodiscard]] Unknowns with_joints() const {
    Unknowns all = unknowns_;
    all.accuracy = options_.joint_accuracy;
    for (const Cause& cause : calibration::possible_causes(robot_, used_))
      if (cause.kind == Cause::Kind::joint && cause.index != turning_ &&
          std::ranges::count(unknowns_.variables, cause.index) == 0) {
        all.variables.push_back(cause.index);
        ++all.accurate;
      }
    return all;
  }
  [[nodiscard]] State with_zeros(State state) const {
    state.joint_offsets.resize(robot_.variables().size());
    return state;
  }

  /// Adds a note for each input that the images contradict, and widens the pose's region to what
  /// the pose is then. Returns the notes' text.
  std::string name_causes(Calibration& result, Observer& observer, const Refined& fit,
                          const Refined& known, const Explained& explained) const {
    if (agreement(observer, explained.fit.state) < least_agreeing) return {};
    std::string text;
    const auto add = [&](const std::string& cause) {
      result.notes.push_back("the images contradict the input: " + cause);
      text += (text.empty() ? "" : "; ") + cause;
    };
    for (const FoundCause& found : explained.causes)
      add(calibration::text_of(found, explained, robot_, camera_));
    if (explained.clock_is_untold) {
      result.notes.emplace_back(
          "the arm moves in one way only, so that the images cannot tell a time between images and "
          "joint states from another pose: let it stand still, or move there and back");
      text += (text.empty() ? "" : "; ") + result.notes.back();
    }
    const Eigen::Isometry3d from =
        known.state.T_parent_camera.inverse() * fit.state.T_parent_camera;
    for (const Explained::Pose& pose : explained.poses) {
      const calibration::Twist moved =
          calibration::twist_of(from * calibration::motion(pose.motion));
      result.covariance += pose.covariance + covering * moved * moved.transpose();
    }
    if (const std::string depth = calibration::text_of_depth(explained.fit); !depth.empty()) {
      add(depth);
      const calibration::Twist moved =
          calibration::motion_with_usual_depth(observer, unknowns_, used_, fit.state);
      result.covariance += covering * moved * moved.transpose();
    }
    return text;
  }

  [[nodiscard]] double agreement(Observer& observer, const State& state) const {
    double sum = 0.0;
    for (const KeptFrame* frame : used_) sum += observer.fit(*frame, state).agreeing;
    return sum / static_cast<double>(used_.size());
  }

  /// Finds poses by all colours, and fits each to the borders of masks that the colours give there.
  Refined best_by_color(Observer& observer) {
    PoseSearch search(model_, camera_, used_, true, options_.seed);
    used_.clear();
    for (const auto& small : search.frames()) used_.push_back(small.frame);
    if (used_.size() < KeptFrames::least)
      throw InputError("only " + std::to_string(used_.size()) + " of " +
                       std::to_string(frames_.size()) +
                       " images show the same background: the camera moves");
    std::optional<Refined> best;
    double best_score = 0.0, best_overlap = 0.0;
    const auto try_all = [&](const std::vector<Eigen::Isometry3d>& poses, bool by_score) {
      for (const Eigen::Isometry3d& pose : poses) {
        Refined fit = calibration::refine_by_color(masked_, search, observer, unknowns_, pose);
        const double score = search.score(fit.state),
                     overlap = observer.overlap(masked_, fit.state);
        const bool follows = follows_joints(search, fit.state);
        if (best && (by_score ? score <= best_score : !follows || overlap <= best_overlap))
          continue;
        best = std::move(fit);
        best_score = score, best_overlap = overlap, follows_joints_ = follows;
      }
    };
    if (options_.initial)
      try_all({search.near(*options_.initial)}, true);
    else
      try_all(search.candidates(), true);
    // A robot with little contrast to its background scores best out of view.
    if (!options_.initial && best_overlap < calibration::least_by_color)
      try_all(search.candidates({}, calibration::low_contrast), false);
    calibration::mask_by_color(masked_, search.frames(), observer, best->state);
    return *std::move(best);
  }
  /// Whether the images follow the joints.
  static bool follows_joints(PoseSearch& search, const State& state) {
    const double own = search.score(state), others = search.score_of_others(state);
    return own - others > least_by_joints * std::max(std::abs(own), std::abs(others));
  }

  Refined best_fit(Observer& observer) {
    if (has_colors()) return best_by_color(observer);
    FramePointers some;  // spread over all frames
    for (std::size_t i = 0; i < std::min(searched, used_.size()); ++i)
      some.push_back(used_[i * used_.size() / std::min(searched, used_.size())]);
    PoseSearch search(model_, camera_, some, calibration::stands_still(frames_, parent_),
                      options_.seed);
    std::vector<Eigen::Isometry3d> candidates;
    if (options_.initial)
      candidates = {*options_.initial, search.near(*options_.initial)};
    else
      candidates = search.candidates();
    std::optional<Refined> best;
    double best_score = 0.0;
    for (const State& candidate : starts_of(candidates, search)) {
      Refined fit = calibration::refine(observer, unknowns_, used_, candidate);
      const double score = search.score(fit.state);
      if (best && score <= best_score) continue;
      best_score = score;
      best = std::move(fit);
    }
    if (leave_out(observer, best->state))
      best = calibration::refine(observer, unknowns_, used_, best->state);
    return *std::move(best);
  }

  /// With the time offset: the poses at the offset that suits each best.
  [[nodiscard]] std::vector<State> starts_of(const std::vector<Eigen::Isometry3d>& poses,
                                             PoseSearch& search) const {
    constexpr std::array offsets{0.0, -0.08, -0.04, 0.04, 0.08};  // seconds
    std::vector<State> starts;
    for (const Eigen::Isometry3d& pose : poses) {
      State best{.T_parent_camera = pose, .joint_offsets = {}};
      double best_score = search.score(best);
      for (const double offset : offsets) {
        State other = best;
        other.time_offset = offset;
        const double score = unknowns_.has_time ? search.score(other) : 0.0;
        if (!unknowns_.has_time || score <= best_score) continue;
        best_score = score;
        best = std::move(other);
      }
      starts.push_back(std::move(best));
    }
    return starts;
  }

  /// Leaves out frames in which the robot is elsewhere than its joints say.
  bool leave_out(Observer& observer, const State& state) {
    std::vector<double> agreeing;
    for (const KeptFrame* frame : used_) agreeing.push_back(observer.fit(*frame, state).agreeing);
    std::vector<double> sorted = agreeing;
    const double least = elsewhere * detail::median(sorted);
    FramePointers good;
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (agreeing[i] >= least) good.push_back(used_[i]);
    if (good.size() == used_.size() || good.size() < KeptFrames::least) return false;
    used_ = good;
    return true;
  }

  [[nodiscard]] Calibration result_of(const Refined& fit, const Unknowns& all,
                                      const Explained& explained) const {
    Calibration result;
    result.T_parent_camera = fit.state.T_parent_camera;
    result.covariance = fit.covariance.topLeftCorner<6, 6>();
    if (has_depth()) {
      result.depth_offset = estimate(fit.state.depth_offset, fit, Unknowns::depth_offset);
      result.depth_scale = estimate(fit.state.depth_scale, fit, Unknowns::depth_scale);
    }
    result.outline = estimate(fit.state.outline, fit, Unknowns::outline);
    if (unknowns_.has_shift) {
      result.shift_right = estimate(fit.state.depth_shift.x(), fit, Unknowns::shift);
      result.shift_down = estimate(fit.state.depth_shift.y(), fit, Unknowns::shift + 1);
    }
    if (options_.focal) {
      result.focal_x = estimate(fit.state.focal.x(), fit, all.focal());
      result.focal_y = estimate(fit.state.focal.y(), fit, all.joints() - 1);
    }
    if (options_.joint_offsets)
      for (const Explained::Joint& joint : explained.joints)
        result.joint_offsets.push_back({.value = 0.0, .sigma = joint.sigma});
    for (std::size_t j = 0; j < unknowns_.variables.size(); ++j)
      result.joint_offsets.at(unknowns_.variables[j]) =
          estimate(fit.state.joint_offsets.at(unknowns_.variables[j]), fit,
                   all.joints() + static_cast<int>(j));
    if (all.has_time) result.time_offset = estimate(fit.state.time_offset, fit, all.time());
    result.link_residuals = fit.link_residuals;
    return result;
  }

  /// Names the direction that is known least, and the joints that tell most about it when they
  /// turn: by what a frame would then add to the information in that direction.
  [[nodiscard]] std::string advice(const Calibration& result, Observer& observer,
                                   const State& state) const {
    constexpr std::array axes{"to its right", "down", "along its view"};
    const calibration::Twist weakest = dense::principal_axes(result.covariance).vectors.col(5);
    const dense::PrincipalAxes position =
        dense::principal_axes(result.covariance.bottomRightCorner<3, 3>());
    Eigen::Index axis = 0;
    position.vectors.col(2).cwiseAbs().maxCoeff(&axis);
    std::string text = std::string("the camera's position is known least ") +
                       axes.at(static_cast<std::size_t>(axis));
    if (!has_depth() && !options_.focal)
      text += "; the focal length is taken as exact: 1 % of it is 1 % of the distance";
    const std::vector<std::string> joints = telling_joints(observer, state, weakest);
    if (joints.size() < 2) return text;
    return text + "; more poses in which " + joints[0] + " and " + joints[1] +
           " turn would add most";
  }

  /// Names a frame without which the position is known much worse.
  [[nodiscard]] std::string carrying_frames(const calibration::Equations& equations) const {
    constexpr double much = 3.0;
    const std::vector<double> wider = equations.wider_without();
    const auto most = std::ranges::max_element(wider);
    if (wider.size() != used_.size() || !(*most > much)) return {};
    const auto& frame = *used_[static_cast<std::size_t>(most - wider.begin())];
    return "; frame " + std::to_string(frame.index) +
           " alone tells much of it: record more like it";
  }

  /// Names joints, as the first of an arm before a fixed camera, whose offset is to the images the
  /// same as another pose.
  [[nodiscard]] std::string untold_joints(const Explained& explained, const Refined& known) const {
    constexpr double much = 1.5;  // of the rotation's own error
    const double least =
        std::max(untold, much * calibration::longest_axis(known.covariance.topLeftCorner<3, 3>()));
    std::string names;
    for (std::size_t j = 0; j < explained.joints.size(); ++j)
      if (explained.joints[j].rotation_error > least)
        names += (names.empty() ? "" : ", ") + robot_.variables()[j];
    return names.empty() ? names
                         : "; the images cannot tell an offset of " + names + " from another pose";
  }

  [[nodiscard]] std::vector<std::string> telling_joints(Observer& observer, const State& state,
                                                        const calibration::Twist& weakest) const {
    constexpr double turn = 0.6;  // rad
    std::vector<std::pair<double, std::string>> gains;
    for (const Joint& joint : robot_.joints()) {
      if (joint.mimics || used_[0]->joints.empty() ||
          (joint.type != JointType::revolute && joint.type != JointType::continuous))
        continue;
      double gain = 0.0;
      for (const double by : {-turn, turn}) {
        KeptFrame frame;
        frame.joints = used_[used_.size() / 2]->joints;
        double& position = frame.joints[*joint.variable];
        position = std::clamp(position + by, joint.lower.value_or(position + by),
                              joint.upper.value_or(position + by));
        frame.T_root_link.resize(robot_.links().size());
        robot_.forward_kinematics(frame.joints, frame.T_root_link);
        gain = std::max(gain, observer.information(frame, state, weakest));
      }
      gains.emplace_back(-gain, joint.name);
    }
    std::sort(gains.begin(), gains.end());
    std::vector<std::string> names;
    names.reserve(gains.size());
    for (const auto& [gain, name] : gains) names.push_back(name);
    return names;
  }

  void judge(Calibration& result, const Refined& fit) const {
    const double least = has_colors() ? calibration::least_by_color : least_agreeing;
    double agreeing = 0.0;
    for (const FrameFit& frame : result.frames) {
      if (frame.used)
        agreeing += frame.agreeing / static_cast<double>(used_.size());
      else
        result.notes.push_back("frame " + std::to_string(frame.index) + " is left out: " +
                               (has_colors()
                                    ? "more than half of its image differs from most others"
                                    : "only " + fixed(100.0 * frame.agreeing, 0) +
                                          (has_depth() ? " % of the robot's pixels show it "
                                                         "where its joints say"
                                                       : " % of mask and robot overlap")));
    }
    if (agreeing >= least && !fit.covariance.allFinite()) {
      result.faults.push_back(
          "the images do not tell the pose: all frames repeat one view of one link; record poses "
          "in "
          "which links move in the camera's view");
    } else if (!follows_joints_) {
      result.faults.push_back(
          "the images do not show the robot move as its joints say: it is not in view, the joints "
          "are of other times, or " +
          std::string(options_.initial ? "the first guess is too far off (--search does without)"
                                       : "the search found no better pose"));
    } else if (!(agreeing >= least)) {
      result.faults.push_back(
          "only " + fixed(100.0 * agreeing, 0) +
          (has_depth()    ? " % of the robot's pixels show it at its depth"
           : has_colors() ? " % of the robot and of what hides the background overlap"
                          : " % of masks and robot overlap") +
          ": the robot is not in view, the URDF is not this robot's, the "
          "joints are of other times, "
          "or " +
          (options_.initial ? "the first guess is too far off (--search does without)"
                            : "the search found no better pose"));
    }
  }

  /// Marks a pose that is not known well enough, with what helps most.
  void check_errors(Calibration& result, const std::string& causes) const {
    const double widest = options_.accept.value_or(has_depth() ? widest_position : widest_by_masks);
    const double turned = options_.accept.value_or(widest_rotation);
    if (result.position_error() <= widest && result.rotation_error() <= turned) return;
    result.is_wide = true;
    std::string remedy = causes.empty() ? "" : causes + "; ";
    if (has_depth() && !unknowns_.has_shift)
      remedy += "give masks of the robot in the colour images (--masks), or ";
    remedy += "record more poses of the robot; " + result.advice;
    result.faults.push_back(
        "the pose is known to " + fixed(1e3 * result.position_error(), 0) + " mm and " +
        fixed(result.rotation_error() * 180.0 / 3.14159265358979, 1) + " degrees only: " + remedy);
  }

  std::span<const KeptFrame> frames_;
  std::vector<KeptFrame> masked_;  // those of colour images, with masks
  const Intrinsics& camera_;
  const Robot& robot_;
  const CalibrationOptions& options_;
  std::size_t parent_;
  std::optional<std::size_t> turning_;  // the joint whose zero is by definition right
  Model model_;
  Unknowns unknowns_;
  FramePointers used_;
  bool follows_joints_ = true;  // what the images show
};

}  // namespace

double Calibration::position_error() const {
  return calibration::longest_axis(covariance.bottomRightCorner<3, 3>());
}

double Calibration::rotation_error() const {
  return calibration::longest_axis(covariance.topLeftCorner<3, 3>());
}

Calibration calibrate(std::span<const KeptFrame> frames, const Intrinsics& camera,
                      const Robot& robot, const CalibrationOptions& options) {
  check_input(frames, camera, robot, options);
  return Calibrator(frames, camera, robot, options).run();
}

}  // namespace penumbra
