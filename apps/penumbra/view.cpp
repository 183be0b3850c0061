// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/server_options.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/camera_views.hpp>
#include <io/files/pose_file.hpp>
#include <io/inputs/input_session.hpp>
#include <io/web/cameras_view.hpp>
#include <io/web/frame_store.hpp>
#include <io/web/run_folder.hpp>
#include <io/web/stored_view.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

struct ViewArguments {
  io::SessionOptions session;
  std::string judging_option;  ///< name of an option that was given; empty: none
  ServerArguments server;
  bool calibrate = false, search = false;
};

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* report_name = "report.json";
constexpr const char* views_name = "views.json";

/// Returns whether a run of several cameras wrote this folder.
bool has_views(const fs::path& input) {
  std::error_code error;
  return fs::exists(input / views_name, error) && !fs::exists(input / "recording.yaml", error);
}

/// Returns whether a run wrote this folder, or it is its report.json.
bool is_run_folder(const fs::path& input) {
  std::error_code error;
  if (!fs::is_directory(input, error)) return input.filename() == report_name;
  return fs::exists(input / report_name, error) && !fs::exists(input / "recording.yaml", error) &&
         !fs::exists(input / "metadata.yaml", error);
}

/// Returns the cameras to show; none for the only one, without a name.
std::vector<std::string> cameras_of(const io::InputOptions& input) {
  if (has_views(input.path)) return io::cameras_of_views(input.path / views_name);
  if (is_run_folder(input.path) || !input.camera.empty()) return {};
  return io::cameras_of(input.path);
}

/// Gives an input's frames to a calibration.
struct CalibrationSink final : io::Sink {
  void take(const Frame& frame, const FrameReport& /*report*/) override {
    calibration.take(frame, input->drift());
  }

  const io::InputSession* input = nullptr;
  RunningCalibration calibration;
};

/// The content of the viewer: an input, which is judged meanwhile, or the results of a run.
class ViewSource {
 public:
  /// `cameras`: all that are shown; `camera`: this one of them. Throws InputError if there is
  /// nothing to show.
  ViewSource(const ViewArguments& arguments, std::vector<std::string> cameras,
             const std::string& camera);
  ~ViewSource();
  ViewSource(const ViewSource&) = delete;
  ViewSource& operator=(const ViewSource&) = delete;

  [[nodiscard]] io::StoredView& view() { return *view_; }

  /// Starts judging in its own thread.
  void start();
  [[nodiscard]] bool is_over() const { return over_; }
  /// Prints the result; to be called when it is over. Throws what judging threw.
  void print();
  /// Returns the targets' views, of an input; to be called when it is over.
  [[nodiscard]] const io::CameraRun* run() const { return recorder_ ? &recorder_->run() : nullptr; }

 private:
  void open_input(const ViewArguments& arguments, const std::string& camera);
  void open_run(const ViewArguments& arguments);
  void judge();

  std::vector<std::string> cameras_;
  std::optional<CalibrationSink> calibration_;
  std::optional<io::InputSession> judging_;
  std::optional<io::PoseOutlines> outlines_;
  std::optional<io::FrameStore> store_;
  std::optional<io::ViewRecorder> recorder_;  // with several cameras
  std::optional<io::RunFolder> folder_;
  std::optional<io::StoredView> view_;
  std::atomic<bool> stop_ = false, over_ = false;
  std::exception_ptr error_;
  io::RunResult result_;
  std::thread thread_;
};

ViewSource::ViewSource(const ViewArguments& arguments, std::vector<std::string> cameras,
                       const std::string& camera)
    : cameras_(std::move(cameras)) {
  ViewArguments own = arguments;
  io::InputOptions& input = own.session.input;
  if (!cameras_.empty()) {
    std::error_code error;
    if (has_views(input.path)) {
      input.path /= camera;
      if (fs::is_symlink(input.path, error))
        throw InputError(input.path.string() + ": is a link, which is not followed");
    } else {
      input.camera = camera;
    }
    own.session.renderer.threads = 1;
  }
  if (is_run_folder(input.path))
    open_run(own);
  else
    open_input(own, camera);
}

ViewSource::~ViewSource() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void ViewSource::open_input(const ViewArguments& arguments, const std::string& camera) {
  const io::SessionOptions& options = arguments.session;
  judging_.emplace(options, print_line);
  const Pipeline& pipeline = judging_->pipeline();
  store_.emplace(pipeline, judging_->head());
  if (arguments.calibrate) {
    RunningCalibration& calibration = calibration_.emplace().calibration;
    calibration_->input = &*judging_;
    judging_->set_up(calibration);
    calibration.begin(arguments.search);
    outlines_.emplace(pipeline.robot(), pipeline.report_camera());
    store_->outline(*outlines_, calibration);
  }
  if (!cameras_.empty()) recorder_.emplace(camera, pipeline);
  const auto links = pipeline.robot().links();
  std::vector<io::Part> parts{io::Part::color, io::Part::labels, io::Part::links, io::Part::vdi};
  if (judging_->has_depth()) parts.insert(parts.end(), {io::Part::depth, io::Part::cloud});
  if (calibration_) parts.push_back(io::Part::outlines);
  view_.emplace(io::SessionInfo{.input = options.input.path.string(),
                                .links = {links.begin(), links.end()},
                                .camera = pipeline.report_camera(),
                                .image = options.image,
                                .parts = std::move(parts),
                                .cameras = cameras_},
                io::make_scene(pipeline.robot()), *store_, judging_->size());
}

void ViewSource::open_run(const ViewArguments& arguments) {
  const fs::path& named = arguments.session.input.path;
  const fs::path folder = named.filename() == report_name ? named.parent_path() : named;
  if (!arguments.judging_option.empty())
    throw InputError(arguments.judging_option + ": " + folder.string() +
                     " holds the results of a run, which are shown as they were judged; leave it "
                     "out, or view the run's input");
  io::RunReport report = io::RunReport::read(folder / report_name);
  io::SessionInfo info{.input = report.input, .links = report.links, .image = report.image};
  io::Scene scene = io::make_scene(report.links);
  const std::size_t frames = report.frames.size();
  folder_.emplace(folder, std::move(report));
  info.parts = folder_->parts();
  info.cameras = cameras_;
  view_.emplace(std::move(info), std::move(scene), *folder_, frames);
}

void ViewSource::start() {
  if (judging_)
    thread_ = std::thread([this] { judge(); });
  else
    over_ = true;
}

void ViewSource::judge() {
  try {
    io::Sinks sinks{&*store_};
    if (recorder_) sinks.insert(sinks.begin(), &*recorder_);
    if (calibration_) sinks.insert(sinks.begin(), &*calibration_);
    result_ = judging_->run(sinks, [this] { return !stop_; });
    if (calibration_) calibration_->calibration.finish();
  } catch (...) {
    error_ = std::current_exception();
  }
  over_ = true;
}

void ViewSource::print() {
  if (folder_) {
    for (const std::string& line : folder_->missing()) print_error(line);
    return;
  }
  if (error_) std::rethrow_exception(error_);
  print_result(result_, judging_->pipeline().robot(),
               "all frames are judged; Ctrl-C ends the viewer");
  if (!calibration_) return;
  const CalibrationProgress of = calibration_->calibration.progress();
  std::cout << "calibration: " << of.message << '\n';
  if (!of.is_ready()) return;
  const std::string& frame = judging_->pipeline().report_camera().frame_id;
  std::cout << "ROS 2: "
            << io::static_transform_command(of.found->T_parent_camera, of.camera_parent,
                                            frame.empty() ? "camera_optical_frame" : frame)
            << "\n  (in place of the transforms that lead to this frame now)\n";
}

constexpr auto look_period = 100ms;
constexpr auto long_time = 24h;
constexpr std::uint16_t more_ports = 99;  // that are tried if the default one is in use

using ViewSources = std::vector<std::unique_ptr<ViewSource>>;

bool are_over(const ViewSources& sources) {
  return std::all_of(sources.begin(), sources.end(),
                     [](const auto& source) { return source->is_over(); });
}

/// Waits for Ctrl-C.
void wait_for_end(StopSignal& stop, const ViewSources& sources) {
  while (!are_over(sources))
    if (stop.wait(look_period)) return;
  for (const auto& source : sources) source->print();
  std::cout.flush();
  while (!stop.wait(long_time)) continue;
}

/// Returns the views.json of several cameras; null until all are judged.
io::SharedBytes views_of(const io::InputOptions& input, const ViewSources& sources) {
  if (has_views(input.path))
    return io::shared_bytes(read_whole_file(input.path / views_name, FileLimit::data));
  if (!are_over(sources)) return nullptr;
  std::vector<io::CameraRun> runs;
  for (const auto& source : sources) runs.push_back(*source->run());
  return io::shared_bytes(io::views_json(io::fuse_views(input.path.string(), runs)));
}

void add_options(CLI::App& app, ViewArguments& view) {
  app.footer(view_examples);
  add_text(app, "INPUT",
           "a recording folder or its recording.yaml, a bag of ROS 2, or a folder that run wrote",
           "", view.session.input.path)
      ->required();
  add_server(app, view.server,
             "where the page is served; 0: any that is free; default 8470, or the next free one");
  add_session(app, view.session);
  add_sequence(app, view.session);
  app.add_flag(
      "--calibrate", view.calibrate,
      "find the camera's pose from the robot in these frames, and show the robot's outline "
      "by the pose in use, red, and by the found one, green");
  app.add_flag("--search", view.search, "with --calibrate: without the pose in use as first guess");
  add_bag(app, view.session.input.bag);
}

void check_options(const CLI::App& app, ViewArguments& view) {
  check_session(app, view.session);
  if (view.search && !view.calibrate)
    throw InputError("--search: is of --calibrate; give that, too");
  view.session.input.with_color = true;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() > 0 && name != "INPUT" && name != "--port" && name != "--address")
      view.judging_option = name;
  }
}

int execute(const ViewArguments& arguments) {
  StopSignal stop;
  const io::InputOptions& input = arguments.session.input;
  const std::vector<std::string> cameras = cameras_of(input);
  ViewSources sources;
  std::vector<io::CameraPage> pages;
  for (const std::string& camera : cameras.empty() ? std::vector<std::string>(1) : cameras) {
    sources.push_back(std::make_unique<ViewSource>(arguments, cameras, camera));
    pages.push_back({camera, &sources.back()->view()});
  }
  io::WebOptions options = web_options(arguments.server);
  if (!arguments.server.port) options.last_port = options.port + more_ports;
  io::CamerasView views(pages, [&] { return views_of(input, sources); });
  const io::WebServer server(
      options, cameras.empty() ? sources.front()->view() : static_cast<io::WebHandler&>(views));
  std::cout << server.url() << std::endl;
  for (const auto& source : sources) source->start();
  wait_for_end(stop, sources);
  return 0;
}

}  // namespace

Execute add_view(CLI::App& app) {
  return make_command<ViewArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
