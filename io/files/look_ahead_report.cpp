// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/version.hpp>

#include <io/files/json.hpp>
#include <io/files/look_ahead_report.hpp>

namespace penumbra::io {

namespace {

Json forecast_json(const CameraForecast& forecast) {
  return {{"hidden_at_s", or_null(forecast.hidden_at())},
          {"seen_again_at_s", or_null(forecast.seen_again_at())},
          {"seen_for_s", forecast.seen_for()},
          {"intervals", intervals_json(forecast.intervals)}};
}

Json camera_json(const CameraForecast& forecast, const std::string& name) {
  Json all = {{"camera", or_null(name)}};
  all.update(forecast_json(forecast));
  Json hidden = Json::array(), clearance = Json::array();
  for (const Prediction& prediction : forecast.predictions) {
    const bool is_known =
        prediction.verdict != Verdict::unknown && prediction.verdict != Verdict::out_of_view;
    hidden.push_back(is_known ? Json(prediction.hidden) : Json(nullptr));
    clearance.push_back(prediction.clearance);
  }
  all["samples"] = {{"time_s", forecast.times},
                    {"hidden", std::move(hidden)},
                    {"clearance_px", std::move(clearance)}};
  return all;
}

Json forecast_json(const TargetForecast& forecast, std::span<const ForecastCamera> cameras) {
  Json of_cameras = Json::array();
  for (std::size_t c = 0; c < cameras.size(); ++c)
    of_cameras.push_back(camera_json(forecast.cameras[c], cameras[c].name));
  return {{"name", forecast.name},
          {"any_camera", forecast_json(forecast.any)},
          {"cameras", std::move(of_cameras)}};
}

Json now_json(const TargetReport& report) {
  Json blame = Json::array();
  if (report.judgement)
    for (const Blame& each : report.judgement->blame) blame.push_back(each.name);
  return {{"name", report.name},
          {"verdict", to_string(report.verdict)},
          {"by", std::move(blame)},
          {"hidden_by_other",
           report.judgement ? or_null(report.judgement->hidden_by_other) : Json(nullptr)},
          {"reason", or_null(report.reason)}};
}

}  // namespace

std::string look_ahead_json(const LookAheadResult& result) {
  Json now = Json::array(), motions = Json::array(), ranking = Json::array(), notes = Json::array();
  for (const TargetReport& report : result.now) now.push_back(now_json(report));
  for (std::size_t i = 0; i < result.motions.size(); ++i) {
    Json targets = Json::array();
    for (const TargetForecast& forecast : result.forecasts[i])
      targets.push_back(forecast_json(forecast, result.cameras));
    motions.push_back({{"name", result.motions[i].name},
                       {"duration_s", result.motions[i].trajectory.duration()},
                       {"targets", std::move(targets)}});
  }
  for (const RankedMotion& each : result.ranking)
    ranking.push_back({{"motion", result.motions[each.trajectory].name},
                       {"seen", each.seen},
                       {"reason", or_null(each.reason)}});
  for (const std::string& note : result.notes) notes.push_back(note);
  const Json all = {{"penumbra", PENUMBRA_VERSION},  {"input", result.input},
                    {"frame", result.frame},         {"now", std::move(now)},
                    {"ranking", std::move(ranking)}, {"motions", std::move(motions)},
                    {"notes", std::move(notes)}};
  return all.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra::io
