// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include <io/web/picture_uri.hpp>
#include <io/web/report_page.hpp>
#include <sim/experiments/report.hpp>
#include <sim/experiments/report_words.hpp>
#include <sim/experiments/statistics.hpp>
#include <sim/experiments/units-inl.hpp>

namespace penumbra::sim {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// The measure that methods are compared by; in both experiments'.
constexpr const char* compared = "translation_p95_mm";

/// To three digits: a micrometre, a thousandth of a degree.
double rounded(double value) { return std::round(value * 1e3) / 1e3; }

/// Of each frame, null where no pose is claimed.
OrderedJson errors_json(const MethodRun& method, double Sample::*error, double scale) {
  OrderedJson errors = OrderedJson::array();
  for (const Sample& sample : method.samples) {
    if (sample.known())
      errors.push_back(rounded(scale * sample.*error));
    else
      errors.push_back(nullptr);
  }
  return errors;
}

OrderedJson verdicts_json(const LaneRun& lane) {
  OrderedJson verdicts = OrderedJson::array();
  for (const std::optional<Verdict>& verdict : lane.verdicts) {
    if (verdict)
      verdicts.push_back(to_string(*verdict));
    else
      verdicts.push_back(nullptr);
  }
  return verdicts;
}

/// What our verdict and each method's belief were, frame by frame.
OrderedJson lane_json(const SeedRun& run, const LaneRun& lane, bool has_rotations) {
  OrderedJson sources = OrderedJson::array(), errors;
  for (const Sample& sample : lane.methods.back().samples)  // ours
    sources.push_back(to_string(sample.source));
  for (std::size_t i = 0; i < lane.methods.size(); ++i) {
    OrderedJson& of_method = errors[run.methods[i].key];
    of_method["translation_mm"] =
        errors_json(lane.methods[i], &Sample::translation_error, millimetres);
    if (has_rotations)
      of_method["rotation_deg"] = errors_json(lane.methods[i], &Sample::rotation_error, degrees);
  }
  return {{"verdicts", verdicts_json(lane)},
          {"sources", std::move(sources)},
          {"errors", std::move(errors)}};
}

OrderedJson run_json(const SeedRun& run, bool has_rotations) {
  OrderedJson json{{"seed", run.seed},
                   {"frame_s", run.frame_seconds},
                   {"goal", run.goal ? OrderedJson(*run.goal) : OrderedJson(nullptr)}};
  for (const FrameTruth& truth : run.frames) {
    json["time_s"].push_back(rounded(truth.time));
    json["hidden"].push_back(truth.hidden);
    json["counted"].push_back(truth.counted);
    json["before_robot"].push_back(truth.before_robot);
  }
  for (const LaneRun& lane : run.lanes)
    json["lanes"][lane.key] = lane_json(run, lane, has_rotations);
  return json;
}

/// What the page shows beside metrics.json.
OrderedJson experiment_json(const ExperimentResult& result) {
  const SeedRun& first = result.seeds.front();
  const ReportWords& words = report_words(result.experiment);
  OrderedJson json{{"title", words.title},
                   {"story", words.story},
                   {"goal", words.goal},
                   {"limits", words.limits},
                   {"occluded_share", occluded_share},
                   {"compared", compared}};
  for (const Measure& measure : measures_of(result.experiment))
    json["measures"].push_back({{"key", measure.key},
                                {"name", measure.name},
                                {"unit", measure.unit},
                                {"digits", measure.digits}});
  for (const MethodInfo& method : first.methods)
    json["methods"].push_back({{"key", method.key}, {"name", method.name}, {"idea", method.idea}});
  json["run"] = run_json(first, result.experiment == "conveyor");
  return json;
}

OrderedJson pictures_json(const std::vector<Picture>& pictures) {
  OrderedJson json = OrderedJson::array();
  for (const Picture& picture : pictures)
    json.push_back({{"index", picture.frame},
                    {"title", picture.title},
                    {"image", io::picture_uri(picture.image.view())}});
  return json;
}

}  // namespace

std::string report_page(const ExperimentResult& result) {
  return io::experiment_page(metrics_json(result), experiment_json(result).dump(),
                             pictures_json(result.pictures).dump());
}

}  // namespace penumbra::sim
