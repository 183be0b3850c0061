// SPDX-License-Identifier: Apache-2.0
#include <io/files/json.hpp>
#include <io/live/live_summary.hpp>

namespace penumbra::io {
namespace {

Json quantiles_json(const LatencyHistogram& times) {
  return {{"count", times.count()},
          {"median", or_null(times.quantile(0.5))},
          {"p99", or_null(times.quantile(0.99))}};
}

/// Of a sensor's frames.
Json counts_json(const LiveInbox& inbox, std::size_t sensor) {
  const ImageCounts counts = inbox.sensor(sensor).counts();
  const LiveTally& tally = inbox.tally(sensor);
  Json dropped = Json::object();
  for (std::size_t i = 0; i < drop_reasons; ++i)
    dropped[std::string(to_string(static_cast<DropReason>(i)))] = counts.dropped[i];
  Json frames = Json::object();
  for (const auto& [status, count] : tally.statuses) frames[status] = count;
  return {{"received", counts.received},
          {"judged", counts.judged},
          {"failed", counts.failed},
          {"waiting", counts.waiting},
          {"in_work", counts.in_work},
          {"dropped", dropped},
          {"frames", frames},
          {"stamp_to_published_ms", quantiles_json(tally.latency)},
          {"arrival_to_published_ms", quantiles_json(tally.processing)},
          {"stamps_of_another_clock", tally.beyond_clock}};
}

Json unjudged_json(const ImageCounts& counts) {
  return {{"replaced", counts.targets_replaced},
          {"discarded", counts.targets_discarded},
          {"messages_before_setup", counts.early_targets}};
}

Json camera_json(const LiveInbox& inbox, std::size_t number, const WrittenResults& results) {
  const CameraInput& camera = inbox.camera(number);
  const LiveTally& tally = inbox.tally(number);
  Json written = Json::object();
  for (const ResultTopic& topic : result_topics)
    written[std::string(topic.name)] = results.written[static_cast<std::size_t>(topic.result)];
  Json result{{"name", camera.options().name},
              {"depth_topic", camera.options().depth_topic},
              {"renderer", tally.renderer ? renderer_json(*tally.renderer) : Json(nullptr)}};
  result.update(counts_json(inbox, number));
  result.update({{"results_written", written},
                 {"camera_info_changes", camera.camera_changes()},
                 {"warnings", inbox.warnings(number)},
                 {"calibration", drift_json(tally.last.drift)},
                 {"targets_not_judged", unjudged_json(camera.counts())}});
  return result;
}

Json cloud_json(const LiveInbox& inbox, std::size_t number) {
  const std::size_t sensor = inbox.camera_count() + number;
  const CloudInput& cloud = inbox.cloud(number);
  const LiveTally& tally = inbox.tally(sensor);
  Json result{{"topic", cloud.options().topic}};
  result.update(counts_json(inbox, sensor));
  result.update({{"points", points_json(tally.points)},
                 {"most_poses_of_a_scan", tally.parts},
                 {"times", or_null(tally.time_note)},
                 {"warnings", inbox.warnings(sensor)},
                 {"targets_not_judged", unjudged_json(cloud.counts())}});
  return result;
}

}  // namespace

std::string live_summary_json(const LiveInbox& inbox, std::span<const LiveLink> links,
                              const LiveRun& run) {
  Json topics = Json::array();
  for (std::size_t i = 0; i < inbox.topics().size(); ++i)
    topics.push_back({{"name", inbox.topics()[i].name},
                      {"type", or_null(inbox.topics()[i].type)},
                      {"received", inbox.received()[i]},
                      {"unreadable", inbox.faults().of(inbox.topics()[i].name)},
                      {"lost", links[i].lost},
                      {"overwritten", links[i].overwritten}});
  Json cameras = Json::array();
  std::size_t not_written = 0, unacknowledged = 0;
  for (std::size_t i = 0; i < inbox.camera_count(); ++i) {
    const WrittenResults& results = run.results.at(i);
    cameras.push_back(camera_json(inbox, i, results));
    not_written += results.not_written;
    unacknowledged += results.unacknowledged;
  }
  Json clouds = Json::array();
  for (std::size_t i = 0; i < inbox.cloud_count(); ++i) {
    clouds.push_back(cloud_json(inbox, i));
    not_written += run.clouds_not_written.at(i);
  }
  const double share = run.seconds > 0.0 ? run.cpu_seconds / run.seconds : 0.0;
  return Json{{"seconds", run.seconds},
              {"cpu_share", share},
              {"results_not_written", not_written},
              {"results_not_acknowledged", unacknowledged},
              {"robots", inbox.robot().robots()},
              {"cameras", cameras},
              {"clouds", clouds},
              {"topics", topics},
              {"fault", or_null(run.fault)}}
      .dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra::io
