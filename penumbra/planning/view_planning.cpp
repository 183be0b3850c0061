// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <functional>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/planning/parallel-inl.hpp>
#include <penumbra/planning/view_planning.hpp>

namespace penumbra {
namespace {

std::size_t link_of(const Robot& robot, const ForecastCamera& candidate) {
  if (candidate.camera.parent.empty()) return 0;
  if (const auto link = robot.find_link(candidate.camera.parent)) return *link;
  throw InputError("candidate '" + candidate.name + "': '" + candidate.camera.parent +
                   "' is not a link of robot '" + robot.name() + "'");
}

bool is_uncertain(const Frame& frame, std::size_t link) {
  const std::vector<std::size_t>& links = frame.pose.uncertain_links;
  return std::ranges::find(links, link) != links.end();
}

/// Frames have the pose of each candidate.
Camera at_root(Camera camera) {
  camera.parent.clear();
  camera.T_parent_camera = Eigen::Isometry3d::Identity();
  return camera;
}

/// Judges frames as candidates with one camera would see them, by the robot's model alone.
class CandidateJudge {
 public:
  CandidateJudge(const Robot& robot, const ForecastCamera& camera)
      : camera_(camera), pipeline_(robot, at_root(camera.camera), config_of(camera)) {}

  /// Returns whether a candidate is this camera in another place.
  [[nodiscard]] bool serves(const ForecastCamera& candidate) const {
    return at_root(candidate.camera) == at_root(camera_.camera) && candidate.rule == camera_.rule;
  }

  /// Writes the verdicts of the frame's targets; returns why the first unknown one is.
  std::string judge(const ForecastCamera& candidate, const Frame& motion,
                    const std::function<void(std::size_t, Verdict)>& write) {
    const std::size_t link = link_of(pipeline_.robot(), candidate);
    if (is_uncertain(motion, link)) return "the pose of its link is not known";
    Frame frame{.pose = motion.pose, .targets = motion.targets};
    frame.pose.T_parent_camera = motion.pose.T_root_link[link] * candidate.camera.pose();
    frame.pose.uncertain_reason = "not known in this frame";
    for (Target& target : frame.targets) {
      target.has_identity = false;  // each frame is judged alone
      target.handling = {};
      target.estimate.reset();
      target.stamp.reset();
    }
    const FrameReport& report = pipeline_.process(frame);
    std::string why;
    for (std::size_t i = 0; i < frame.targets.size(); ++i) {
      const auto [verdict, reason] = verdict_of(report, frame, i);
      write(i, verdict);
      if (verdict == Verdict::unknown && why.empty())
        why = frame.targets[i].name + ": " + std::string(reason);
    }
    return why;
  }

 private:
  static PipelineConfig config_of(const ForecastCamera& camera) {
    PipelineConfig config;
    config.rule = camera.rule;
    config.has_depth = false;
    return config;
  }

  [[nodiscard]] std::pair<Verdict, std::string_view> verdict_of(const FrameReport& report,
                                                                const Frame& frame,
                                                                std::size_t i) const {
    const TargetReport& target = report.targets[i];
    if (is_out_of_range(report, frame, frame.targets[i].shape)) return {Verdict::out_of_view, {}};
    const bool seems_seen =
        target.verdict == Verdict::visible || target.verdict == Verdict::partial;
    if (seems_seen && !report.near_links.empty())
      return {Verdict::unknown, "a part of the robot is too near to the camera to be drawn"};
    return {target.verdict, target.reason};
  }

  [[nodiscard]] bool is_out_of_range(const FrameReport& report, const Frame& frame,
                                     const TargetShape& shape) const {
    const auto placement = placement_of(shape);
    if (!placement || !report.T_root_camera) return false;
    Eigen::Vector3d p = placement->pose.translation();
    if (placement->frame.kind == ReferenceFrame::Kind::link) {
      const auto link = pipeline_.robot().find_link(placement->frame.link);
      if (!link || is_uncertain(frame, *link)) return false;
      p = report.T_root_link[*link] * p;
    }
    const double z = (report.T_root_camera->inverse() * p).z();
    return z < camera_.camera.range.near || z > camera_.camera.range.far;
  }

  const ForecastCamera& camera_;
  Pipeline pipeline_;
};

/// The pairs of target and frame that a candidate sees, a bit each.
using Bits = std::vector<std::uint64_t>;

std::size_t count_of(const Bits& bits) {
  return std::accumulate(bits.begin(), bits.end(), std::size_t{0}, [](std::size_t n, auto word) {
    return n + static_cast<std::size_t>(std::popcount(word));
  });
}

std::size_t count_with(const Bits& a, const Bits& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    count += static_cast<std::size_t>(std::popcount(a[i] | b[i]));
  return count;
}

Bits together(Bits a, const Bits& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] |= b[i];
  return a;
}

/// Compares all sets of one size.
class AllSets {
 public:
  AllSets(const std::vector<Bits>& seen, std::size_t size)
      : seen_(seen), size_(size), own_(seen.size()) {
    std::transform(seen.begin(), seen.end(), own_.begin(), count_of);
    extend(0, Bits(seen.front().size(), 0), 0);
  }
  [[nodiscard]] const std::vector<std::size_t>& best() const { return best_; }
  /// Returns how many pairs the best set sees.
  [[nodiscard]] std::size_t pairs() const { return worth_.first; }

 private:
  /// `own`: the pairs that each camera of the set sees, summed up.
  void extend(std::size_t first, const Bits& so_far, std::size_t own) {
    const std::size_t missing = size_ - set_.size();
    for (std::size_t i = first; i + missing <= seen_.size(); ++i) {
      set_.push_back(i);
      if (missing > 1) {
        extend(i + 1, together(so_far, seen_[i]), own + own_[i]);
      } else if (const std::pair worth(count_with(so_far, seen_[i]), own + own_[i]);
                 best_.empty() || worth > worth_) {
        best_ = set_;
        worth_ = worth;
      }
      set_.pop_back();
    }
  }

  const std::vector<Bits>& seen_;
  std::size_t size_;
  std::vector<std::size_t> own_, set_, best_;
  std::pair<std::size_t, std::size_t> worth_;
};

std::vector<Bits> seen_by(const CandidateViews& views) {
  const std::size_t pairs = views.frames() * views.targets();
  std::vector<Bits> all(views.candidates(), Bits((pairs + 63) / 64, 0));
  for (std::size_t c = 0; c < views.candidates(); ++c)
    for (std::size_t f = 0; f < views.frames(); ++f)
      for (std::size_t t = 0; t < views.targets(); ++t)
        if (const std::size_t bit = f * views.targets() + t; views.at(c, f, t) == Verdict::visible)
          all[c][bit / 64] |= std::uint64_t{1} << (bit % 64);
  return all;
}

std::vector<double> visible_shares(const CandidateViews& views,
                                   const std::vector<std::size_t>& set) {
  std::vector<double> shares(views.targets());
  for (std::size_t t = 0; t < views.targets(); ++t) {
    std::size_t frames = 0;
    for (std::size_t f = 0; f < views.frames(); ++f)
      frames += std::any_of(set.begin(), set.end(),
                            [&](std::size_t c) { return views.at(c, f, t) == Verdict::visible; });
    shares[t] = static_cast<double>(frames) / static_cast<double>(views.frames());
  }
  return shares;
}

}  // namespace

double CandidateViews::share(std::size_t candidate, std::size_t target, Verdict verdict) const {
  std::size_t count = 0;
  for (std::size_t f = 0; f < frames_; ++f) count += at(candidate, f, target) == verdict;
  return static_cast<double>(count) / static_cast<double>(frames_);
}

CandidateViews judge_candidates(const Robot& robot, std::span<const ForecastCamera> candidates,
                                std::span<const Frame> motion, int threads,
                                const std::function<void()>& step) {
  for (const ForecastCamera& each : candidates) static_cast<void>(link_of(robot, each));
  const std::size_t targets = motion.empty() ? 0 : motion.front().targets.size();
  for (const Frame& frame : motion)
    if (frame.targets.size() != targets || frame.pose.T_root_link.size() != robot.links().size())
      throw std::invalid_argument("frames of a motion have different targets or links");
  CandidateViews views(candidates.size(), motion.size(), targets);
  std::mutex mutex;  // of step
  std::vector<std::optional<CandidateJudge>> judges(static_cast<std::size_t>(threads));
  planning::parallel_for(threads, candidates.size(), [&](std::size_t thread, std::size_t c) {
    std::optional<CandidateJudge>& judge = judges[thread];
    if (!judge || !judge->serves(candidates[c])) judge.emplace(robot, candidates[c]);
    for (std::size_t f = 0; f < motion.size(); ++f) {
      const std::string why =
          judge->judge(candidates[c], motion[f],
                       [&](std::size_t t, Verdict verdict) { views.at(c, f, t) = verdict; });
      if (!why.empty() && views.unknown(c).empty())
        views.unknown(c) = "frame " + std::to_string(motion[f].index.value_or(f)) + ": " + why;
      const std::scoped_lock lock(mutex);
      if (step) step();
    }
  });
  return views;
}

void check_camera_sets(std::size_t candidates, std::size_t most) {
  if (most < 1 || most > candidates)
    throw InputError("a set of " + std::to_string(most) +
                     " cameras; expected 1 to the number of candidates, " +
                     std::to_string(candidates));
  std::size_t of_size = 1, all = 0;
  for (std::size_t size = 1; size <= most; ++size) {
    of_size = of_size * (candidates + 1 - size) / size;  // whole in each step
    if (all += of_size; all > max_compared_sets)
      throw InputError(std::to_string(candidates) + " candidates have more than " +
                       std::to_string(max_compared_sets) + " sets of up to " +
                       std::to_string(most) + " cameras; give fewer candidates or fewer cameras");
  }
}

std::vector<CameraSet> best_cameras(const CandidateViews& views, std::size_t most) {
  check_camera_sets(views.candidates(), most);
  const std::vector<Bits> seen = seen_by(views);
  const auto pairs = static_cast<double>(views.frames() * views.targets());
  std::vector<CameraSet> best;
  for (std::size_t size = 1; size <= most; ++size) {
    const AllSets sets(seen, size);
    best.push_back({sets.best(), visible_shares(views, sets.best()),
                    static_cast<double>(sets.pairs()) / pairs});
  }
  return best;
}

}  // namespace penumbra
