// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <system_error>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <apps/penumbra/options.hpp>
#include <apps/penumbra/view_source.hpp>
#include <io/bag/bag_file.hpp>

namespace penumbra::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* report_name = "report.json";

/// A run's results are shown as they were judged.
void refuse_choices(const RunArguments& run, const fs::path& folder) {
  const auto refuse = [&](const std::string& option) {
    throw InputError(option + ": " + folder.string() +
                     " holds the results of a run, which are shown as they were judged; leave it "
                     "out, or view the run's input");
  };
  if (run.renderer.is_named) refuse("--renderer");
  if (run.geometry) refuse("--geometry");
  if (run.tolerance) refuse("--tolerance");
  if (run.front_min_width) refuse("--front-min-width");
  if (run.fringe_reach) refuse("--fringe-reach");
  if (run.sensor) refuse("--sensor");
  if (run.paper_labels) refuse("--labels");
  if (run.image == ImageSpace::rectified) refuse("--image");
  if (run.frames.first || run.frames.end) refuse("--frames");
  if (run.fps) refuse("--fps");
  if (run.targets || run.no_targets) refuse("--targets");
  if (run.allow_missing_meshes) refuse("--allow-missing-meshes");
  if (run.geometry_fallback) refuse("--geometry-fallback");
  if (!run.extra.empty()) refuse("--extra");
  if (!run.bag.given.empty()) refuse(run.bag.given);
}

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

/// Keeps frames for the page.
class StoreOutput final : public RunOutput {
 public:
  explicit StoreOutput(io::FrameStore& store) : store_(store) {}

  void begin(const io::ReportHead& head) override { store_.begin(head); }
  void save(const FrameReport& report, const io::FrameData& frame,
            const io::ShownTargets& targets) override {
    store_.add(report, frame, targets);
  }
  void finish(const Statistics& statistics, std::span<const std::string> notes) override {
    store_.finish(statistics, notes);
  }
  [[nodiscard]] std::string where() const override { return {}; }

 private:
  io::FrameStore& store_;
};

/// Returns whether a run wrote this folder, or it is its report.json.
bool is_run_folder(const fs::path& input) {
  std::error_code error;
  if (!fs::is_directory(input, error)) return input.filename() == report_name;
  return fs::exists(input / report_name, error) && !fs::exists(input / "recording.yaml", error) &&
         !fs::exists(input / "metadata.yaml", error);
}

}  // namespace

ViewSource::ViewSource(const ViewArguments& arguments) {
  check_is_something(arguments.judging.input);
  if (is_run_folder(arguments.judging.input))
    open_run(arguments.judging);
  else
    open_input(arguments.judging);
}

ViewSource::~ViewSource() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void ViewSource::open_input(const RunArguments& arguments) {
  judged_ = arguments;
  check_renderer(judged_.renderer);
  judging_.emplace(judged_);
  const Pipeline& pipeline = judging_->pipeline();
  store_.emplace(pipeline.rectification());
  store_->begin(judging_->head());
  const auto links = pipeline.robot().links();
  view_.emplace(io::SessionInfo{.input = judged_.input.string(),
                                .links = {links.begin(), links.end()},
                                .camera = judging_->camera(),
                                .image = judged_.image,
                                .parts = {io::Part::color, io::Part::labels, io::Part::links,
                                          io::Part::vdi, io::Part::depth, io::Part::cloud}},
                io::make_scene(pipeline.robot()), *store_, judging_->size());
}

void ViewSource::open_run(const RunArguments& arguments) {
  const fs::path& named = arguments.input;
  const fs::path folder = named.filename() == report_name ? named.parent_path() : named;
  refuse_choices(arguments, folder);
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
    StoreOutput output(*store_);
    judging_->run(output, [this] { return !stop_; });
  } catch (...) {
    error_ = std::current_exception();
  }
  over_ = true;
}

void ViewSource::tell() {
  if (folder_) {
    for (const std::string& line : folder_->missing()) std::cerr << "penumbra: " << line << '\n';
    return;
  }
  if (error_) std::rethrow_exception(error_);
  judging_->tell("all frames are judged; Ctrl-C ends the viewer");
}

}  // namespace penumbra::app
