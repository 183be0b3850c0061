// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string_view>
#include <utility>

#include <penumbra/base/version.hpp>

#include <io/files/json.hpp>
#include <io/files/view_planning_report.hpp>

namespace penumbra::io {
namespace {

/// The verdicts' letters in view_planning.json, in the order of Verdict; g: held.
constexpr std::string_view verdict_letters = "vph?og";
static_assert(verdict_letters.size() == all_verdicts.size());

Json seen_json(const ViewPlan& plan, std::size_t candidate) {
  Json targets = Json::array();
  for (std::size_t t = 0; t < plan.views.targets(); ++t) {
    Json json = {{"name", plan.target(t)}};
    for (const Verdict verdict : all_verdicts)
      json[std::string(to_string(verdict))] = plan.views.share(candidate, t, verdict);
    std::string by_frame;
    for (std::size_t f = 0; f < plan.views.frames(); ++f)
      by_frame += verdict_letters[static_cast<std::size_t>(plan.views.at(candidate, f, t))];
    json["by_frame"] = std::move(by_frame);
    targets.push_back(std::move(json));
  }
  return targets;
}

Json candidate_json(const ViewPlan& plan, std::size_t i) {
  const ForecastCamera& candidate = plan.candidates[i];
  return {{"name", candidate.name},
          {"link", or_null(candidate.camera.parent)},
          {"pose", pose_json(candidate.camera.pose())},
          {"targets", seen_json(plan, i)},
          {"first_unknown", or_null(plan.views.unknown(i))}};
}

Json set_json(const ViewPlan& plan, const CameraSet& set) {
  Json cameras = Json::array(), visible = Json::object();
  for (const std::size_t c : set.candidates) cameras.push_back(plan.candidates[c].name);
  for (std::size_t t = 0; t < set.visible.size(); ++t) visible[plan.target(t)] = set.visible[t];
  return {
      {"cameras", std::move(cameras)}, {"visible", std::move(visible)}, {"mean_visible", set.mean}};
}

}  // namespace

std::string ViewPlan::names(const CameraSet& set) const {
  std::string text;
  for (const std::size_t c : set.candidates)
    text += (text.empty() ? "" : " + ") + candidates[c].name;
  return text;
}

std::string view_planning_json(const ViewPlan& plan) {
  Json frames = Json::array(), candidates = Json::array(), sets = Json::array();
  for (const Frame& frame : plan.motion) frames.push_back(*frame.index);
  for (std::size_t i = 0; i < plan.candidates.size(); ++i)
    candidates.push_back(candidate_json(plan, i));
  for (const CameraSet& set : plan.best) sets.push_back(set_json(plan, set));
  const Json json = {
      {"penumbra", PENUMBRA_VERSION},        {"input", plan.input},
      {"frames", std::move(frames)},         {"frames_left_out", plan.seen - plan.motion.size()},
      {"candidates", std::move(candidates)}, {"best", std::move(sets)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra::io
