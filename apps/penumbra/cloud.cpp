// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/server_options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/inputs/clouds.hpp>
#include <io/inputs/input_session.hpp>
#include <io/outputs/cloud_output.hpp>
#include <io/outputs/output_folder.hpp>
#include <io/web/frame_store.hpp>
#include <io/web/stored_view.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

struct CloudArguments {
  io::CloudRunOptions run;
  std::filesystem::path output;  ///< empty: write nothing
  io::CloudOutput how;
  bool force = false;      ///< also a folder with other files, and clouds without the robot
  bool tune = false;       ///< measure the sensors' rules, without output
  ServerArguments server;  ///< no page is served without a port
};

void add_options(CLI::App& app, CloudArguments& arguments) {
  app.footer(cloud_examples);
  io::CloudRunOptions& cloud = arguments.run;
  io::InputOptions& input = cloud.input;
  auto& changes = cloud.rule_changes;
  input.bag.clouds = true;
  add_text(app, "INPUT", "a recording folder of clouds or its recording.yaml, or a bag of ROS 2",
           "", input.path)
      ->required();
  add_text(app, "-o,--output", "a folder for a recording's clouds; *.mcap for a bag's", "OUT",
           arguments.output);
  app.add_flag(
      "--tune", arguments.tune,
      "write nothing: measure the tolerance and beam that fit each sensor, in 40 clouds of "
      "a robot that stands or moves free");
  add_option(app, "--sensor",
             "lidar_2cm (default), livox_mid360, ouster_os1 or hokuyo: their tolerance and beam; "
             "the options below override",
             "NAME", [&changes](const std::string& text) {
               const CloudRule rule = CloudRule::for_sensor(text);
               changes.insert(changes.begin(), [rule](CloudRule& to) { to = rule; });
             });
  add_settings<CloudRule>(app, [&changes](const auto& setting, const auto& numbers) {
    CloudRule given;
    if (!io::set_numbers(setting.range, numbers, given.*setting.member)) return false;
    changes.push_back(
        [setting, given](CloudRule& to) { to.*setting.member = given.*setting.member; });
    return true;
  });
  app.add_flag("--label", arguments.how.labelled,
               "keep all points of PointCloud2 and files, and add the fields label and link");
  add_choice<bool>(app, "--removed-ranges",
                   "nan (default) or inf, in place of a LaserScan's ranges",
                   arguments.how.infinite_ranges, {{"nan", false}, {"inf", true}});
  app.add_flag_callback(
      "--merged", [&cloud] { cloud.has_rays = false; },
      "the clouds of several sensors in one: no rays, only what lies on or in "
      "the robot is removed");
  app.add_flag_callback(
      "--ignore-times", [&cloud] { cloud.use_times = false; },
      "all points of a scan were measured at its stamp; default: by their times, if they have any");
  add_number(app, "--threads", "default 1; results do not depend on it", "N", cloud.threads, 1,
             RendererOptions::max_threads);
  add_drawn(app, input, "the recording's, else collision");
  add_frames(app, input.frames);
  app.add_flag(
      "--force", arguments.force,
      "write into a folder that holds other files; and exit with 0 although the robot is in "
      "no cloud");
  add_server(app, arguments.server,
             "show the labelled clouds in the browser there; of several topics, each further one "
             "gets the next port; 0: any free port; default: no page");
  const std::size_t first = app.get_options().size();
  add_list(app, "--topic", "clouds; default: all; may be given several times", "TOPIC",
           [&input](const std::string& text) { input.bag.cloud_topics.push_back(text); });
  add_list(app, "--target-topic",
           "Detection3DArray or PoseStamped to judge on the clouds of their stamp; may be given "
           "several times",
           "TOPIC", [&input](const std::string& text) { input.bag.target_topics.push_back(text); });
  add_text(app, "--sensor-frame",
           "where the rays start, in tf, if the clouds are given in another frame", "FRAME",
           cloud.sensor_frame);
  add_bag_robot(app, input.bag, {.sensor = "sensor", .frame = "clouds' frame", .data = "clouds"});
  const auto options = app.get_options();
  for (std::size_t i = first; i < options.size(); ++i) options[i]->group(BagHelp().group);
}

void check_options(const CLI::App& app, CloudArguments& arguments) {
  io::CloudRunOptions& cloud = arguments.run;
  note_bag_option(app, cloud.input);
  check_server(arguments.server);
  const bool has_port = arguments.server.port.has_value();
  if (arguments.tune && (has_port || !arguments.output.empty()))
    throw InputError("--tune writes and shows nothing: leave --output and --port out");
  if (!arguments.tune && !has_port && arguments.output.empty())
    throw InputError("--output is required, or --port, or --tune");
  if (arguments.tune && !cloud.has_rays)
    throw InputError("--tune measures ranges, and --merged clouds have none");
  cloud.input.bag.in_other_frame = !cloud.has_rays || !cloud.sensor_frame.empty();
  if (arguments.output.empty()) return;
  io::check_output_place(cloud.input.path, arguments.output);
  if (io::is_bag(cloud.input.path) && !io::is_output_bag(arguments.output))
    throw InputError("--output: " + arguments.output.string() +
                     " is no bag, and the clouds of a bag are written into one; name it *.mcap");
}

void print_notes_of(const std::string& sensor, std::vector<std::string> notes) {
  for (std::string& note : notes)
    if (!note.starts_with(sensor)) note.insert(0, sensor + ": ");
  print_notes(notes);
}

/// Prints the rule that fits each sensor. Returns the exit status.
int tune(const std::vector<io::RunInput>& inputs) {
  std::vector<std::vector<std::string>> rows{
      {"", "clouds", "points on the robot", "bias", "deviation", "tolerance", "beam"}};
  bool is_sound = true;
  for (const io::RunInput& input : inputs) {
    const CloudTuning tuning = [&] {
      Progress progress(0);
      return io::tune_clouds(input, [&] {
        progress.step();
        return !was_interrupted();
      });
    }();
    rows.push_back({input.sensor, std::to_string(tuning.scans), std::to_string(tuning.points),
                    fixed(1e3 * tuning.bias, 1) + " mm", fixed(1e3 * tuning.deviation, 1) + " mm",
                    tuning.has_tolerance ? fixed(tuning.rule.tolerance.a, 3) + ",0,0" : "-",
                    tuning.has_beam ? fixed(tuning.rule.beam, 3) : "-"});
    print_notes_of(input.sensor, tuning.problems);
    is_sound = is_sound && tuning.problems.empty();
  }
  print_table(std::move(rows));
  return was_interrupted() ? interrupt_status() : is_sound ? 0 : nothing_judged;
}

/// The viewer's page of a sensor.
class CloudPage {
 public:
  CloudPage(const io::InputSession& session, const std::string& input,
            const io::WebOptions& options)
      : store(session.pipeline(), session.head()),
        view_({.input = input,
               .links = {session.head().links.begin(), session.head().links.end()},
               .parts = {io::Part::cloud}},
              io::make_scene(session.pipeline().robot()), store, std::nullopt),
        server_(options, view_) {}

  [[nodiscard]] std::string url() const { return server_.url(); }

  io::FrameStore store;

 private:
  io::StoredView view_;
  io::WebServer server_;
};

std::vector<std::string> table_row(const std::string& sensor, const io::Statistics& of) {
  const PixelCounts& points = of.pixels();
  std::size_t all = 0;
  for (const auto& [label, count] : io::point_counts) all += points.*count;
  const auto share = [&](std::size_t some) {
    return all == 0 ? std::string("-")
                    : fixed(100.0 * static_cast<double>(some) / static_cast<double>(all), 2) + " %";
  };
  double time = 0.0;
  for (std::size_t i = 0; i < io::stages.size(); ++i)
    if (const auto stage = of.timing(i)) time += stage->median;
  return {sensor,
          std::to_string(of.frames()),
          std::to_string(of.usable_frames()),
          std::to_string(all),
          share(points.occluded + points.beyond),
          share(points.front),
          share(points.fringe),
          share(points.unknown),
          of.frames() == 0 ? "-" : fixed(time, 2)};
}

int execute(const CloudArguments& arguments) {
  catch_interrupts();
  std::vector<io::RunInput> inputs = io::open_clouds(arguments.run, print_line);
  if (arguments.tune) return tune(inputs);
  std::optional<io::ResultFolder> folder;
  std::optional<io::CloudBag> bag;
  if (io::is_output_bag(arguments.output))
    bag.emplace(arguments.output);
  else if (!arguments.output.empty())
    folder.emplace(io::cloud_results(inputs.front(), arguments.output, arguments.force));
  io::SessionOptions options;
  options.input = arguments.run.input;
  io::WebOptions web = web_options(arguments.server);
  std::vector<std::unique_ptr<CloudPage>> pages;
  std::vector<std::string> sensors;
  std::vector<std::unique_ptr<io::InputSession>> sessions;
  for (io::RunInput& input : inputs) {
    sensors.push_back(input.sensor);
    sessions.push_back(std::make_unique<io::InputSession>(options, std::move(input)));
  }
  for (std::size_t i = 0; i < sensors.size() && arguments.server.port; ++i) {
    pages.push_back(std::make_unique<CloudPage>(
        *sessions[i], options.input.path.string() + ", " + sensors[i], web));
    print_line(sensors[i] + ": " + pages.back()->url());
    std::cout.flush();
    if (web.port > 0) ++web.port;
  }
  std::vector<std::vector<std::string>> rows{
      {"", "clouds", "labelled", "points", "robot", "front", "fringe", "unknown", "ms a cloud"}};
  bool is_good = false;        // of any sensor: others may not see the robot
  std::set<std::string> said;  // notes of the whole bag, once
  for (std::size_t i = 0; i < sessions.size() && !was_interrupted(); ++i) {
    io::InputSession& session = *sessions[i];
    std::unique_ptr<io::Sink> files;
    if (folder) files = io::open_cloud_folder(*folder, arguments.how);
    if (bag) files = bag->sensor(sensors[i], session.pipeline().robot(), arguments.how);
    io::Sinks sinks;
    if (files) sinks.push_back(files.get());
    if (!pages.empty()) sinks.push_back(&pages[i]->store);
    const io::RunResult result = judge_all(session, sinks);
    rows.push_back(table_row(sensors[i], result.statistics));
    is_good = is_good || (result.statistics.usable_frames() > 0 &&
                          (arguments.force || result.statistics.shows_robot()));
    if (result.statistics.parts() > 1)
      print_line(sensors[i] + ": the robot moved: up to " +
                 std::to_string(result.statistics.parts()) + " poses a scan");
    print_faults(result, sensors[i] + ": ");
    for (const std::string& note : result.notes)
      if (said.insert(note).second) print_notes_of(sensors[i], {note});
  }
  if (bag) bag->finish();
  print_table(std::move(rows));
  if (!arguments.output.empty()) std::cout << "results: " << arguments.output.string() << '\n';
  if (!pages.empty() && !was_interrupted()) {
    std::cout << "all clouds are labelled; Ctrl-C ends the viewer" << std::endl;
    while (!was_interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  } else if (was_interrupted()) {
    return interrupt_status();
  }
  return is_good ? 0 : nothing_judged;
}

}  // namespace

Execute add_cloud(CLI::App& app) {
  return make_command<CloudArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
