// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include <penumbra/base/text.hpp>
#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>

namespace penumbra::calibration {
namespace {

using detail::fixed;

// In 60 simulated runs without a fault (bench/calibration_study) nothing was named.
constexpr double named = 4.0;     // sigmas from 0
constexpr double possible = 2.5;  // the same: the pose's region covers it
constexpr double bar = 2.0;       // sigmas that notes state: a value below is not named
/// A cause must also lower the weighted squares: a sigma of few frames can be small by chance.
constexpr double least_drop = 16.0;
/// Causes whose drops are nearer to each other's than first-order steps are to the truth.
constexpr double told_apart = 0.8;
constexpr std::size_t most_causes = 3;
constexpr double shortest_link = 0.05;  // metres between a link's origin and a joint of it
constexpr double usual_offset = 0.005, usual_scale = 0.005;  // metres; Unknowns::prior_sigmas()

/// What freeing one cause does, to first order.
struct Test {
  Cause cause;
  double sigmas = 0.0;  // from 0
  double drop = 0.0;    // of the weighted squares
  double sigma = 0.0;   // of its first value
  Explained::Pose pose = {};
};

Unknowns with(Unknowns unknowns, const Cause& cause) {
  switch (cause.kind) {
    case Cause::Kind::focal:
      unknowns.focal_count = 2;
      break;
    case Cause::Kind::joint:
      unknowns.variables.push_back(cause.index);
      break;
    case Cause::Kind::link:
      unknowns.links.push_back(cause.index);
      break;
    case Cause::Kind::clock:
      unknowns.has_time = true;
      break;
    case Cause::Kind::lens:
      unknowns.has_lens = true;
      break;
  }
  return unknowns;
}

/// The indices of a cause in the unknowns; empty: they do not have it.
std::vector<int> indices(const Unknowns& unknowns, const Cause& cause) {
  const bool is_link = cause.kind == Cause::Kind::link;
  const auto& some = is_link ? unknowns.links : unknowns.variables;
  const auto at = std::ranges::find(some, cause.index);
  int first =
      (is_link ? unknowns.lengths() : unknowns.joints()) + static_cast<int>(at - some.begin());
  int count = at == some.end() ? 0 : 1;
  if (cause.kind == Cause::Kind::focal) first = unknowns.focal(), count = unknowns.focal_count;
  if (cause.kind == Cause::Kind::clock) first = unknowns.time(), count = unknowns.has_time;
  if (cause.kind == Cause::Kind::lens) first = unknowns.lens(), count = unknowns.has_lens;
  std::vector<int> found(static_cast<std::size_t>(count));
  std::iota(found.begin(), found.end(), first);
  return found;
}

/// How many standard deviations values are from 0.
double sigmas_of(const Eigen::VectorXd& value, const Eigen::MatrixXd& covariance) {
  return std::sqrt(dense::squared_sigmas(value, covariance));
}

/// The indices of `some` in `all`, which has them in any order.
std::vector<int> indices(const Unknowns& all, const Unknowns& some) {
  std::vector<int> found(static_cast<std::size_t>(some.joints()));
  std::iota(found.begin(), found.end(), 0);
  for (const std::size_t variable : some.variables)
    found.push_back(indices(all, {.kind = Cause::Kind::joint, .index = variable})[0]);
  for (const std::size_t joint : some.links)
    found.push_back(indices(all, {.kind = Cause::Kind::link, .index = joint})[0]);
  if (some.has_time) found.push_back(all.time());
  if (some.has_lens) found.push_back(all.lens());
  return found;
}

/// Tests what each cause explains beyond the unknowns of a fit.
Test test(const Equations& equations, const Unknowns& all, const Unknowns& own,
          const Cause& cause) {
  const Unknowns freed = with(own, cause);
  const std::vector<int> own_indices = indices(all, own), chosen = indices(all, freed);
  const Equations free = equations.of(chosen);
  const Eigen::VectorXd step = free.step();
  const Eigen::MatrixXd covariance = free.after(step).covariance();
  const std::vector<int> added = indices(freed, cause);
  const Eigen::MatrixXd its = covariance(added, added);
  Test result{.cause = cause};
  result.sigmas = sigmas_of(step(added), its);
  // What the fit's own unknowns would still gain is not this cause's.
  const Equations without = equations.of(own_indices);
  result.drop = without.step().dot(without.gradient) - step.dot(free.gradient);
  result.sigma = std::sqrt(its(0, 0));
  result.pose = {step.head<6>(), covariance.topLeftCorner<6, 6>()};
  return result;
}

/// The size of a value and twice its standard deviation.
std::string amount(double value, double variance, double scale, int digits) {
  return fixed(scale * std::abs(value), digits) + " +- " +
         fixed(bar * scale * std::sqrt(variance), digits);
}

std::string name_of(const Cause& cause, const Robot& robot) {
  switch (cause.kind) {
    case Cause::Kind::focal:
      return "the focal length";
    case Cause::Kind::joint:
      return "the zero of " + robot.variables()[cause.index];
    case Cause::Kind::link:
      return "the length of " + robot.links()[robot.joints()[cause.index].parent];
    case Cause::Kind::lens:
      return "the lens's distortion";
    case Cause::Kind::clock:
      break;
  }
  return "the time between images and joint states";
}

std::string focal_text(const Explained& explained, const Intrinsics& camera) {
  const int at = explained.unknowns.focal();
  const Eigen::Vector2d& focal = explained.fit.state.focal;
  const Eigen::Vector2d variances = explained.fit.covariance.diagonal().segment<2>(at);
  const Eigen::Array2d sigmas = focal.array().abs() / variances.array().sqrt();
  std::string text;
  for (const auto& [i, name, given] :
       {std::tuple{0, "fx", camera.fx()}, std::tuple{1, "fy", camera.fy()}}) {
    if (sigmas[i] < bar || (sigmas[i] < named && sigmas[1 - i] >= named)) continue;
    const double longer = 1.0 / (1.0 + focal[i]) - 1.0;
    text += (text.empty() ? "" : ", ") + std::string(name) + " is " +
            amount(longer, variances[i], 100.0, 1) + " % too " + (longer > 0.0 ? "long" : "short") +
            " (" + fixed(given * (1.0 + focal[i]), 1) +
            " px would fit; penumbra calibrate --focal)";
  }
  return text;
}

/// Whether a pose is known much worse than a fit's.
bool is_wider(const Explained::Pose& pose, const Refined& fit) {
  constexpr double much = 1.5;
  return longest_axis(pose.covariance.topLeftCorner<3, 3>()) >
             much * longest_axis(fit.covariance.topLeftCorner<3, 3>()) ||
         longest_axis(pose.covariance.bottomRightCorner<3, 3>()) >
             much * longest_axis(fit.covariance.block<3, 3>(3, 3));
}

}  // namespace

std::vector<Cause> possible_causes(const Robot& robot, std::span<const KeptFrame* const> frames) {
  std::vector<Cause> causes{{.kind = Cause::Kind::focal}, {.kind = Cause::Kind::lens}};
  for (const Joint& joint : robot.joints())
    if (!joint.mimics &&
        (joint.type == JointType::revolute || joint.type == JointType::continuous ||
         joint.type == JointType::prismatic))
      causes.push_back({.kind = Cause::Kind::joint, .index = *joint.variable});
  if (!frames.front()->depth.empty())
    for (std::size_t j = 0; j < robot.joints().size(); ++j)
      if (robot.joints()[j].origin.translation().norm() > shortest_link)
        causes.push_back({.kind = Cause::Kind::link, .index = j});
  if (std::ranges::any_of(frames, [](const auto* frame) { return frame->tells_time(); }))
    causes.push_back({.kind = Cause::Kind::clock});
  return causes;
}

std::string text_of(const FoundCause& found, const Explained& explained, const Robot& robot,
                    const Intrinsics& camera) {
  const State& state = explained.fit.state;
  const bool has_depth = !explained.unknowns.holds_depth;
  std::string text;
  if (found.cause.kind == Cause::Kind::focal) {
    text = focal_text(explained, camera);
  } else if (found.cause.kind == Cause::Kind::joint) {
    const std::size_t variable = found.cause.index;
    const int at = indices(explained.unknowns, found.cause)[0];
    const auto joint = std::ranges::find_if(
        robot.joints(), [&](const Joint& one) { return one.variable == variable && !one.mimics; });
    const bool slides = joint->type == JointType::prismatic;
    text = name_of(found.cause, robot) + " is " +
           amount(state.joint_offsets[variable], explained.fit.covariance(at, at),
                  slides ? 1e3 : 180.0 / std::numbers::pi, slides ? 1 : 2) +
           (slides ? " mm" : " degrees") + " off" +
           (has_depth ? " (penumbra calibrate --joint-offsets)" : "");
  } else if (found.cause.kind == Cause::Kind::link) {
    const int at = indices(explained.unknowns, found.cause)[0];
    const double length = state.link_lengths[found.cause.index];
    text = name_of(found.cause, robot) + " to " + robot.joints()[found.cause.index].name + " is " +
           amount(length, explained.fit.covariance(at, at), 1e3, 1) + " mm too " +
           (length > 0.0 ? "short" : "long") + " in the URDF";
  } else if (found.cause.kind == Cause::Kind::lens) {
    const int at = explained.unknowns.lens();
    text = "the lens distorts the images otherwise than camera_info says: k1 is " +
           amount(state.lens, explained.fit.covariance(at, at), 1.0, 3) +
           (state.lens > 0.0 ? " larger" : " smaller") + " (calibrate the lens)";
  } else {
    const int at = explained.unknowns.time();
    text = "the images' stamps are " +
           amount(state.time_offset, explained.fit.covariance(at, at), 1e3, 1) + " ms too " +
           (state.time_offset > 0.0 ? "early" : "late") + " for the joint states" +
           (has_depth ? " (penumbra calibrate --time-offset)" : "");
  }
  for (const Cause& other : found.or_else) text += ", or " + name_of(other, robot) + " is off";
  if (!found.or_else.empty()) text += ": the images cannot tell which";
  return text;
}

std::string text_of_depth(const Refined& fit) {
  constexpr int offset = Unknowns::depth_offset, scale = Unknowns::depth_scale;
  // An offset is rarer than a scale: fewer sigmas beyond the usual are enough.
  const auto is_beyond = [&](double value, int at, double usual) {
    const double sigmas = at == offset ? bar : named;
    return std::abs(value) > usual + sigmas * std::sqrt(fit.covariance(at, at));
  };
  std::string text;
  if (is_beyond(fit.state.depth_offset, offset, usual_offset))
    text = "the measured depth is " +
           amount(fit.state.depth_offset, fit.covariance(offset, offset), 1e3, 1) + " mm too " +
           (fit.state.depth_offset > 0.0 ? "large" : "small");
  if (is_beyond(fit.state.depth_scale, scale, usual_scale))
    text += (text.empty() ? "the measured depth is " : " and ") +
            amount(fit.state.depth_scale, fit.covariance(scale, scale), 100.0, 1) + " % too " +
            (fit.state.depth_scale > 0.0 ? "large" : "small");
  if (text.empty()) return text;
  text += ", more than depth cameras are";
  if (is_beyond(fit.state.depth_scale, scale, usual_scale))
    text += ": multiply depth_scale by " + fixed(1.0 / (1.0 + fit.state.depth_scale), 3);
  return text;
}

Twist motion_with_usual_depth(Observer& observer, const Unknowns& own,
                              std::span<const KeptFrame* const> frames, const State& state) {
  const Equations equations = equations_at(observer, own, frames, state);
  std::vector<int> others(static_cast<std::size_t>(own.size()));
  std::iota(others.begin(), others.end(), 0);
  std::erase_if(others,
                [](int i) { return i == Unknowns::depth_offset || i == Unknowns::depth_scale; });
  Eigen::VectorXd step = Eigen::VectorXd::Zero(own.size());
  step[Unknowns::depth_offset] =
      std::clamp(state.depth_offset, -usual_offset, usual_offset) - state.depth_offset;
  step[Unknowns::depth_scale] =
      std::clamp(state.depth_scale, -usual_scale, usual_scale) - state.depth_scale;
  return equations.after(step).of(others).step().head<6>();
}

Explained explain(Observer& observer, const Unknowns& own, std::span<const KeptFrame* const> frames,
                  const Refined& fit) {
  const Robot& robot = observer.model().robot();
  std::vector<Cause> candidates = possible_causes(robot, frames);
  std::erase_if(candidates, [&](const Cause& cause) { return !indices(own, cause).empty(); });
  Unknowns all = own;
  for (const Cause& cause : candidates) all = with(all, cause);

  Explained result{.unknowns = own, .fit = fit};
  result.fit.state.joint_offsets.resize(robot.variables().size());
  result.fit.state.link_lengths.resize(robot.joints().size());
  result.joints.resize(robot.variables().size());
  const Eigen::Isometry3d from = fit.state.T_parent_camera.inverse();
  std::optional<Explained::Pose> untold_clock;
  for (;;) {
    const State state = result.fit.state;
    const Equations equations = equations_at(observer, all, frames, state);
    std::vector<Test> tests;
    for (const Cause& cause : candidates)
      if (indices(result.unknowns, cause).empty())
        tests.push_back(test(equations, all, result.unknowns, cause));
    const auto pose_after = [&](const Test& test) {
      return Explained::Pose{twist_of(from * state.T_parent_camera * motion(test.pose.motion)),
                             test.pose.covariance};
    };
    for (const Test& test : tests)
      if (test.cause.kind == Cause::Kind::joint)
        result.joints[test.cause.index] = {
            test.sigma, longest_axis(test.pose.covariance.topLeftCorner<3, 3>())};
      else if (test.cause.kind == Cause::Kind::clock && is_wider(test.pose, result.fit))
        untold_clock = pose_after(test);  // a slow motion: the images cannot tell
    std::erase_if(tests, [](const Test& test) {
      return !(test.sigmas > possible || test.drop > least_drop);
    });
    const auto best = std::ranges::max_element(tests, {}, &Test::drop);
    if (best == tests.end()) break;
    if (best->drop < least_drop || result.causes.size() == most_causes) {
      if (best->cause.kind != Cause::Kind::joint)  // whose zeros the pose's region covers
        result.poses.push_back({pose_after(*best).motion, PoseCovariance::Zero()});
      break;
    }
    // A first-order step falls short where residuals are large: the whole way tells.
    const Unknowns freed = with(result.unknowns, best->cause);
    const Refined fitted = refine(observer, freed, frames, state);
    const std::vector<int> its = indices(freed, best->cause);
    const Eigen::VectorXd values = freed.values(fitted.state)(its);
    const Eigen::MatrixXd covariance = fitted.covariance(its, its);
    const double clearest = (values.array().square() / covariance.diagonal().array()).maxCoeff();
    if (!(sigmas_of(values, covariance) > named && clearest > bar * bar)) {
      if (best->cause.kind != Cause::Kind::joint)  // see above
        result.poses.push_back({twist_of(from * fitted.state.T_parent_camera),
                                fitted.covariance.topLeftCorner<6, 6>()});
      break;
    }
    FoundCause& found = result.causes.emplace_back();
    found.cause = best->cause;
    for (const Test& test : tests)
      if (test.cause != best->cause && test.drop > told_apart * best->drop) {
        found.or_else.push_back(test.cause);
        result.poses.push_back(pose_after(test));
      }
    result.unknowns = freed;
    result.fit = fitted;
  }
  if (!result.causes.empty())
    result.poses.push_back({twist_of(from * result.fit.state.T_parent_camera),
                            result.fit.covariance.topLeftCorner<6, 6>()});
  if (untold_clock && !result.unknowns.has_time) {
    result.poses.push_back(*untold_clock);
    result.clock_is_untold = true;
  }
  observer.set_unknowns(own);
  return result;
}

}  // namespace penumbra::calibration
