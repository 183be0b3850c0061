// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/graph_options.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/live_arguments.hpp>
#include <apps/penumbra/text.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/cloud_text.hpp>
#include <io/live/live_fusion.hpp>

namespace penumbra::app {
namespace {

constexpr double longest_duration = 1e9;  // s
constexpr int most_waiting = 1000;        // images

/// "overlay" of "overlay/compressed".
std::string_view short_name(std::string_view topic) { return topic.substr(0, topic.find('/')); }

void check_results(const std::string& list) {
  for (const std::string& name : split(list, ',')) {
    const bool known =
        std::any_of(io::result_topics.begin(), io::result_topics.end(),
                    [&](const io::ResultTopic& topic) { return short_name(topic.name) == name; }) ||
        name == io::target_views_topic;
    if (!known)
      refuse_option("--publish", name,
                    "one of vdi, labels, mask, filtered_depth, points, targets, target_views, "
                    "overlay, robot_mask");
  }
}

void add_graph(CLI::App& app, LiveArguments& live) {
  add_domain(app, live.graph);
  add_option(app, "--namespace", "put before names that do not begin with /", "NS",
             [&](const std::string& text) { live.name_space = text; });
  add_list(app, "--remap", "another name for a topic; may be given several times", "FROM:=TO",
           [&](const std::string& text) { live.remaps.push_back(text); });
  app.add_flag("--reliable", live.reliable,
               "ask for QoS reliable of images, joint states and tf: nothing is lost, but "
               "publishers with best effort are not received");
  add_number(app, "--queue", "images that wait for their pose at a time; default 8", "N",
             live.queue, 1, most_waiting);
}

void add_cameras(CLI::App& app, LiveArguments& live) {
  add_list(app, "--camera",
           "depth images of a camera, whose results come below /penumbra/NAME; may be given "
           "several times. Default: the only one, found by type and name",
           "NAME=TOPIC", [&](const std::string& text) {
             const auto [name, topic] = to_pair("--camera", text, "NAME=TOPIC of depth images");
             add_camera(live.cameras, name, topic);
           });
}

void add_clouds(CLI::App& app, std::vector<io::CloudInputOptions>& clouds) {
  add_list(
      app, "--cloud",
      "clouds or laser scans, which come without the robot on /penumbra/TOPIC; words after the "
      "topic describe the sensor, as \"/points sensor=ouster_os1\" (docs/point_clouds.md); may be "
      "given several times. Cameras are then judged only if named",
      "TOPIC", [&](const std::string& text) {
        try {
          clouds.push_back(io::parse_cloud(text));
        } catch (const InputError& error) {
          throw InputError(std::string("--cloud: ") + error.what());
        }
      });
}

void add_options(CLI::App& app, LiveArguments& live) {
  app.footer(live_examples);
  add_cameras(app, live);
  add_clouds(app, live.clouds);
  add_option(
      app, "--publish",
      "results to publish: of vdi,labels,mask,filtered_depth,points,targets,target_views,overlay,"
      "robot_mask; "
      "default: all that somebody subscribes to",
      "LIST", [&](const std::string& text) {
        check_results(text);
        live.publish = text;
      });
  add_settings<PointsRule>(app, [&live](const auto& setting, const auto& numbers) {
    return io::set_numbers(setting.range, numbers, live.points.*setting.member);
  });
  add_number(app, "--points-rate",
             "point clouds a second of each camera, at most; default 0: one for each image", "HZ",
             live.points_rate, 0.0, 1000.0);
  add_number(app, "--duration", "end after so many seconds; default: never", "S", live.duration,
             0.0, longest_duration);
  app.add_flag(
      "--calibrate", live.calibrate,
      "find each camera's pose from the robot that it sees, while somebody moves the robot; "
      "nothing is changed (docs/calibration.md)");
  app.add_flag("--search", live.search, "with --calibrate: without the pose in use as first guess");
  add_text(app, "--summary", "write at the end what became of all images", "JSON", live.summary);
  add_server(
      app, live.server,
      "serve the viewer's page there; of several cameras and clouds, each further one gets the "
      "next port; 0: any free port; default: no page");
  add_graph(app, live);
  add_session(app, live.session, "collision");
  add_bag(app, live.session.input.bag,
          {.group = "Of topics", .joints = "joint_states", .poses = "joints, never tf by itself"});
}

void check_options(const CLI::App& /*app*/, LiveArguments& live) {
  check_renderer(live.session.backend, live.session.renderer);
  check_server(live.server);
  if (live.search && !live.calibrate)
    throw InputError("--search: is of --calibrate; give that, too");
  if (live.calibrate && live.cameras.empty() && !live.clouds.empty())
    throw InputError("--calibrate: is of cameras, and only clouds are named; name one by --camera");
  live.points.check();
  const io::BagOptions& topics = live.session.input.bag;
  if (live.cameras.empty() && live.clouds.empty()) return;
  if (!live.cameras.empty() && topics.depth_topic)
    throw InputError("--depth-topic: --camera is given too; leave one of them out");
  if (!live.clouds.empty() && topics.time_offset != 0.0)
    throw InputError(
        "--time-offset: is for cameras; give clouds theirs as \"TOPIC time_offset=S\"");
  if (live.cameras.size() + (topics.depth_topic ? 1 : 0) + live.clouds.size() == 1) return;
  const auto refuse = [](const char* option) {
    throw InputError(
        std::string(option) +
        ": belongs to one camera or sensor, and several are named; start one penumbra live for "
        "each, or leave it out");
  };
  if (topics.camera_info_topic && live.cameras.size() > 1) refuse("--camera-info-topic");
  if (topics.color_topic && live.cameras.size() > 1) refuse("--color-topic");
  if (topics.camera_frame) refuse("--camera-frame");
  if (topics.parent) refuse("--parent");
  if (topics.pose) refuse("--pose");
}

}  // namespace

Execute add_live(CLI::App& app) {
  return make_command<LiveArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
