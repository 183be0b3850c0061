// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include <nlohmann/json.hpp>

#include <penumbra/base/version.hpp>

#include <research/metrics_json.hpp>
#include <research/statistics.hpp>

namespace penumbra::research {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson number_or_null(const std::optional<double>& value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson settings_json(const RunSettings& settings) {
  return {{"latency_s", {settings.least_latency, settings.most_latency}},
          {"perception_every_frames", settings.perception_every},
          {"keypoint_sigma_px", settings.keypoint_sigma},
          {"joint_sigma_rad", settings.joint_sigma},
          {"joint_latency_s", settings.joint_latency},
          {"belt_jitter", settings.belt_jitter},
          {"counted_after_s", settings.counted_after}};
}

OrderedJson method_json(const std::vector<Measure>& measures, std::span<const MethodOfSeed> runs) {
  OrderedJson summary, seeds;
  for (const Measure& measure : measures) {
    const auto [value, confidence] = interval_of(measure, runs);
    summary[measure.key] = {{"value", number_or_null(value)},
                            {"ci95", confidence ? OrderedJson{confidence->low, confidence->high}
                                                : OrderedJson(nullptr)}};
  }
  for (const MethodOfSeed& run : runs) {
    OrderedJson one{{"seed", run.seed->seed}};
    for (const Measure& measure : measures)
      one[measure.key] = number_or_null(measure.value(std::span(&run, 1)));
    seeds.push_back(std::move(one));
  }
  return {{"summary", std::move(summary)}, {"seeds", std::move(seeds)}};
}

}  // namespace

std::string metrics_json(const ExperimentResult& result) {
  const std::vector<Measure> measures = measures_of(result.experiment);
  const SeedRun& first = result.seeds.front();
  OrderedJson root{{"penumbra", PENUMBRA_VERSION},
                   {"experiment", result.experiment},
                   {"settings", settings_json(result.settings)},
                   {"seeds", {first.seed, result.seeds.back().seed + 1}}};
  for (std::size_t lane = 0; lane < first.lanes.size(); ++lane) {
    const LaneRun& run = first.lanes[lane];
    OrderedJson methods;
    for (std::size_t method = 0; method < run.methods.size(); ++method) {
      OrderedJson one = method_json(measures, method_of(result, lane, method));
      one["name"] = run.methods[method].name;
      methods[run.methods[method].key] = std::move(one);
    }
    root["detections"][run.key] = {{"name", run.name}, {"methods", std::move(methods)}};
  }
  return root.dump(1) + '\n';
}

}  // namespace penumbra::research
