// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <io/files/target_json-inl.hpp>

namespace penumbra::io {
namespace {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Vector>
Json vector_json(const Vector& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(value);
  return array;
}

Json blame_json(const Judgement& judgement, std::span<const std::string> links) {
  Json blame = Json::array();
  for (const Blame& one : judgement.blame)
    blame.push_back({{"link", links[one.link]}, {"fraction", one.fraction}});
  return blame;
}

Json handled_json(const std::optional<HandledTarget>& handled) {
  if (!handled) return nullptr;
  Json json = {{"source", to_string(handled->source)},
               {"age_s", finite_or_null(handled->age)},
               {"position", nullptr},
               {"orientation", nullptr},
               {"sigma_m", finite_or_null(handled->sigma)}};
  if (handled->position) json["position"] = vector_json(*handled->position);
  if (handled->orientation) json["orientation"] = vector_json(handled->orientation->coeffs());
  return json;
}

/// How often each value of an enumeration came, by its name; null if none did.
template <typename Enum, std::size_t count>
Json counts_json(const std::array<std::size_t, count>& counts) {
  Json json = Json::object();
  std::size_t all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    json[std::string(to_string(static_cast<Enum>(i)))] = counts[i];
    all += counts[i];
  }
  return all == 0 ? Json(nullptr) : json;
}

}  // namespace

Json target_json(const TargetReport& target, std::span<const std::string> links) {
  const Judgement none;
  const Judgement& judged = target.judgement ? *target.judgement : none;
  const auto of_judged = [&](auto value) { return target.judgement ? Json(value) : Json(nullptr); };
  const auto share = [&](double value) { return judged.inside > 0 ? Json(value) : Json(nullptr); };
  return {{"name", target.name},
          {"covered", of_judged(judged.covered)},
          {"inside", of_judged(judged.inside)},
          {"occluded_fraction", share(judged.occluded)},
          {"front_fraction", share(judged.front)},
          {"clear_fraction", share(judged.clear)},
          {"unknown_fraction", share(judged.unknown)},
          {"hidden_by_other_fraction",
           judged.hidden_by_other ? share(*judged.hidden_by_other) : Json(nullptr)},
          {"measured_fraction", judged.measured ? share(*judged.measured) : Json(nullptr)},
          {"seen_past_fraction", judged.seen_past ? share(*judged.seen_past) : Json(nullptr)},
          {"verdict", to_string(target.verdict)},
          {"blame", target.judgement ? blame_json(judged, links) : Json(nullptr)},
          {"point", target.point ? vector_json(*target.point) : Json(nullptr)},
          {"point_pixels", target.point ? Json(judged.point_pixels) : Json(nullptr)},
          {"point_spread_m", target.point ? Json(judged.point_spread) : Json(nullptr)},
          {"handled", handled_json(target.handled)},
          {"estimate", target.estimate ? Json(to_string(*target.estimate)) : Json(nullptr)},
          {"stamp_ns", or_null(target.stamp)},
          {"reason", or_null(std::string(target.reason))}};
}

Json target_summary_json(const TargetStatistics& target) {
  return {{"name", target.name},
          {"verdicts", counts_json<Verdict>(target.verdicts)},
          {"handled", counts_json<Source>(target.handled)},
          {"estimates", counts_json<Outcome>(target.outcomes)},
          {"first_unknown", target.frames(Verdict::unknown) > 0
                                ? Json{{"index", target.first_unknown}, {"reason", target.reason}}
                                : Json(nullptr)}};
}

}  // namespace penumbra::io
