// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/run_summary.hpp>
#include <apps/penumbra/stop_signal.hpp>
#include <apps/penumbra/text.hpp>
#include <io/bag/bag_reader.hpp>
#include <io/run/judging.hpp>
#include <io/web/frame_store.hpp>
#include <io/web/run_folder.hpp>
#include <io/web/stored_view.hpp>
#include <io/web/web_server.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* report_name = "report.json";

void check_is_something(const fs::path& input) {
  std::error_code error;
  if (!fs::is_directory(input, error)) return;
  for (const char* const name : {"recording.yaml", report_name})
    if (fs::exists(input / name, error)) return;
  if (io::is_bag_folder(input)) return;
  throw InputError(
      input.string() +
      ": holds neither a recording (recording.yaml), nor a bag (metadata.yaml, *.mcap, "
      "*.db3), nor the results of a run (report.json)");
}

/// Returns whether a run wrote this folder, or it is its report.json.
bool is_run_folder(const fs::path& input) {
  std::error_code error;
  if (!fs::is_directory(input, error)) return input.filename() == report_name;
  return fs::exists(input / report_name, error) && !fs::exists(input / "recording.yaml", error) &&
         !fs::exists(input / "metadata.yaml", error);
}

/// The content of the viewer: an input, which is judged meanwhile, or the results of a run.
class ViewSource {
 public:
  /// `arguments` must outlive this. Throws InputError if there is nothing to show.
  explicit ViewSource(const ViewArguments& arguments);
  ~ViewSource();
  ViewSource(const ViewSource&) = delete;
  ViewSource& operator=(const ViewSource&) = delete;

  [[nodiscard]] io::StoredView& view() { return *view_; }

  /// Starts judging in its own thread.
  void start();
  [[nodiscard]] bool is_over() const { return over_; }
  /// Prints the result; to be called when it is over. Throws what judging threw.
  void print();

 private:
  void open_input(const io::JudgingOptions& options);
  void open_run(const ViewArguments& arguments);
  void judge();

  std::optional<io::Judging> judging_;
  std::optional<io::FrameStore> store_;
  std::optional<io::RunFolder> folder_;
  std::optional<io::StoredView> view_;
  std::atomic<bool> stop_ = false, over_ = false;
  std::exception_ptr error_;
  io::RunResult result_;
  std::thread thread_;
};

ViewSource::ViewSource(const ViewArguments& arguments) {
  const fs::path& input = arguments.judging.input.path;
  check_is_something(input);
  if (is_run_folder(input))
    open_run(arguments);
  else
    open_input(arguments.judging);
}

ViewSource::~ViewSource() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void ViewSource::open_input(const io::JudgingOptions& options) {
  judging_.emplace(options, print_line);
  const Pipeline& pipeline = judging_->pipeline();
  store_.emplace(pipeline.rectification());
  store_->begin(judging_->head());
  const auto links = pipeline.robot().links();
  view_.emplace(io::SessionInfo{.input = options.input.path.string(),
                                .links = {links.begin(), links.end()},
                                .camera = judging_->camera(),
                                .image = options.image,
                                .parts = {io::Part::color, io::Part::labels, io::Part::links,
                                          io::Part::vdi, io::Part::depth, io::Part::cloud}},
                io::make_scene(pipeline.robot()), *store_, judging_->size());
}

void ViewSource::open_run(const ViewArguments& arguments) {
  const fs::path& named = arguments.judging.input.path;
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
    result_ = judging_->run(*store_, [this] { return !stop_; });
  } catch (...) {
    error_ = std::current_exception();
  }
  over_ = true;
}

void ViewSource::print() {
  if (folder_) {
    for (const std::string& line : folder_->missing()) std::cerr << "penumbra: " << line << '\n';
    return;
  }
  if (error_) std::rethrow_exception(error_);
  print_result(result_, judging_->pipeline().robot(),
               "all frames are judged; Ctrl-C ends the viewer");
}

constexpr auto look_period = 100ms;
constexpr auto long_time = 24h;
constexpr std::uint16_t more_ports = 99;  // that are tried if the default one is in use

/// Waits for Ctrl-C.
void wait_for_end(StopSignal& stop, ViewSource& source) {
  while (!source.is_over())
    if (stop.wait(look_period)) return;
  source.print();
  std::cout.flush();
  while (!stop.wait(long_time)) continue;
}

}  // namespace

int execute(const ViewArguments& arguments) {
  StopSignal stop;
  ViewSource source(arguments);
  io::WebOptions options = web_options(arguments.server);
  if (!arguments.server.port) options.last_port = options.port + more_ports;
  const io::WebServer server(options, source.view());
  std::cout << server.url() << std::endl;
  source.start();
  wait_for_end(stop, source);
  return 0;
}

}  // namespace penumbra::app
