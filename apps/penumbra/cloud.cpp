// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/run_cameras.hpp>
#include <apps/penumbra/server_options.hpp>
#include <apps/penumbra/text.hpp>
#include <io/run/cloud_run.hpp>
#include <io/web/frame_store.hpp>
#include <io/web/stored_view.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

struct CloudArguments {
  io::CloudRunOptions run;
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
           cloud.output);
  app.add_flag(
      "--tune", cloud.tune,
      "write nothing: measure the tolerance and beam that fit each sensor, in 40 clouds of "
      "a robot that stands or moves free");
  add_option(app, "--sensor",
             "lidar_2cm (default), livox_mid360, ouster_os1 or hokuyo: their tolerance and beam; "
             "the options below override",
             "NAME", [&changes](const std::string& text) {
               const CloudRule rule = CloudRule::for_sensor(text);
               changes.insert(changes.begin(), [rule](CloudRule& to) { to = rule; });
             });
  add_settings<CloudRule>(app, "N", [&changes](const auto& setting, const auto& numbers) {
    CloudRule given;
    if (!io::set_numbers(setting.range, numbers, given.*setting.member)) return false;
    changes.push_back(
        [setting, given](CloudRule& to) { to.*setting.member = given.*setting.member; });
    return true;
  });
  app.add_flag("--label", cloud.how.labelled,
               "keep all points of PointCloud2 and files, and add the fields label and link");
  add_choice<bool>(app, "--removed-ranges",
                   "nan (default) or inf, in place of a LaserScan's ranges",
                   cloud.how.infinite_ranges, {{"nan", false}, {"inf", true}});
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
  app.add_flag("--force", cloud.force, "write into a folder that holds other files");
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
  if (cloud.tune && (has_port || !cloud.output.empty()))
    throw InputError("--tune writes and shows nothing: leave --output and --port out");
  if (!cloud.tune && !has_port && cloud.output.empty())
    throw InputError("--output is required, or --port, or --tune");
  if (cloud.tune && !cloud.has_rays)
    throw InputError("--tune measures ranges, and --merged clouds have none");
  cloud.input.bag.in_other_frame = !cloud.has_rays || !cloud.sensor_frame.empty();
}

/// Prints the rule that fits each sensor. Returns the exit status.
int print_tunings(const io::CloudRunResult& result) {
  std::vector<std::vector<std::string>> rows{
      {"", "clouds", "points on the robot", "bias", "deviation", "tolerance", "beam"}};
  bool is_sound = !result.tunings.empty();
  for (std::size_t i = 0; i < result.tunings.size(); ++i) {
    const CloudTuning& tuning = result.tunings[i];
    const std::string& name = result.sensors[i].name;
    rows.push_back({name, std::to_string(tuning.scans), std::to_string(tuning.points),
                    fixed(1e3 * tuning.bias, 1) + " mm", fixed(1e3 * tuning.deviation, 1) + " mm",
                    tuning.has_tolerance ? fixed(tuning.rule.tolerance.a, 3) + ",0,0" : "-",
                    tuning.has_beam ? fixed(tuning.rule.beam, 3) : "-"});
    std::vector<std::string> notes = tuning.problems;
    for (std::string& note : notes) note.insert(0, name + ": ");
    print_notes(notes);
    is_sound = is_sound && tuning.problems.empty();
  }
  print_table(std::move(rows));
  return result.is_stopped ? interrupt_status() : is_sound ? 0 : nothing_judged;
}

/// The viewer's pages of the clouds, one for each sensor.
class CloudPages {
 public:
  explicit CloudPages(const CloudArguments& arguments)
      : options_(web_options(arguments.server)), input_(arguments.run.input.path.string()) {}

  void begin(const Robot& robot, std::span<const std::string> sensors) {
    for (const std::string& sensor : sensors) {
      const auto& page =
          pages_.emplace_back(std::make_unique<Page>(robot, input_ + ", " + sensor, options_));
      print_line(sensor + ": " + page->server->url());
      std::cout.flush();
      if (options_.port > 0) ++options_.port;
    }
  }
  void take(std::size_t sensor, std::uint64_t index, const PointsView& points,
            const CloudReport& report, const std::string& fault) {
    pages_[sensor]->store.save_scan(points, report, index, fault);
  }
  void finish(const io::CloudRunResult& result) {
    for (std::size_t i = 0; i < pages_.size(); ++i) {
      std::vector<std::string> notes = result.sensors[i].notes();
      notes.insert(notes.end(), result.notes.begin(), result.notes.end());
      pages_[i]->store.finish({}, notes);
    }
  }

 private:
  struct Page {
    Page(const Robot& robot, const std::string& input, const io::WebOptions& options)
        : view({.input = input,
                .links = {robot.links().begin(), robot.links().end()},
                .parts = {io::Part::cloud}},
               io::make_scene(robot), store, std::nullopt) {
      io::ReportHead head;
      head.input = input;
      head.links = robot.links();
      store.begin(head);
      server.emplace(options, view);
    }
    io::FrameStore store{nullptr};
    io::StoredView view;
    std::optional<io::WebServer> server;
  };

  io::WebOptions options_;
  std::string input_;
  std::vector<std::unique_ptr<Page>> pages_;
};

int execute(const CloudArguments& arguments) {
  catch_interrupts();
  io::CloudRunOptions options = arguments.run;
  std::optional<CloudPages> pages;
  if (arguments.server.port) {
    pages.emplace(arguments);
    options.on_begin = [&](const auto&... of) { pages->begin(of...); };
    options.on_cloud = [&](const auto&... of) { pages->take(of...); };
  }
  const io::CloudRunResult result = [&] {
    Progress progress(0);
    return io::run_clouds(options, print_line, [&] {
      progress.step();
      return !was_interrupted();
    });
  }();
  print_notes(result.notes);
  if (options.tune) return print_tunings(result);
  std::vector<std::vector<std::string>> rows{
      {"", "clouds", "labelled", "points", "robot", "front", "fringe", "unknown", "ms a cloud"}};
  std::size_t labelled = 0;
  for (const io::CloudSummary& sensor : result.sensors) {
    const auto count = [&](Label label) { return sensor.points[static_cast<std::size_t>(label)]; };
    std::size_t points = 0;
    for (const std::size_t of_label : sensor.points) points += of_label;
    const auto share = [&](std::size_t some) {
      return points == 0
                 ? std::string("-")
                 : fixed(100.0 * static_cast<double>(some) / static_cast<double>(points), 2) + " %";
    };
    rows.push_back(
        {sensor.name, std::to_string(sensor.clouds), std::to_string(sensor.labelled()),
         std::to_string(points), share(count(Label::occluded) + count(Label::beyond)),
         share(count(Label::front)), share(count(Label::fringe)), share(count(Label::unknown)),
         sensor.clouds == 0 ? "-"
                            : fixed(sensor.milliseconds / static_cast<double>(sensor.clouds), 2)});
    labelled += sensor.labelled();
    if (!sensor.time_note.empty()) print_line(sensor.name + ": " + sensor.time_note);
    if (sensor.parts > 1)
      print_line(sensor.name + ": the robot moved: up to " + std::to_string(sensor.parts) +
                 " poses a scan");
    print_notes(sensor.notes());
  }
  print_table(std::move(rows));
  if (!options.output.empty()) std::cout << "results: " << options.output.string() << '\n';
  if (pages && !result.is_stopped) {
    pages->finish(result);
    std::cout << "all clouds are labelled; Ctrl-C ends the viewer" << std::endl;
    while (!was_interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return result.is_stopped ? interrupt_status() : labelled > 0 ? 0 : nothing_judged;
}

}  // namespace

Execute add_cloud(CLI::App& app) {
  return make_command<CloudArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
