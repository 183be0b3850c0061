// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <system_error>
#include <utility>

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
  if (run.targets || run.no_targets) refuse("--targets");
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

/// Where the report names its input by a path that begins where the run was called.
fs::path find_input(const std::string& named, const fs::path& folder) {
  std::error_code error;
  if (fs::exists(named, error)) return named;
  const fs::path beside = folder / ".." / named;
  return fs::exists(beside, error) ? beside : fs::path(named);
}

/// The frames' range where one frame follows the other.
FrameRange range_of(const std::vector<std::int64_t>& indices) {
  for (std::size_t i = 1; i < indices.size(); ++i)
    if (indices[i] != indices[i - 1] + 1) return {};
  if (indices.empty()) return {};
  return {indices.front(), indices.back() + 1};
}

/// What the run was asked for, as far as its report tells; the rest is the command line's.
RunArguments asked_of(const io::RunReport& report, RunArguments run, const fs::path& folder) {
  const bool is_named = !run.input.empty();
  if (!is_named) run.input = find_input(report.input, folder);
  run.renderer.backend = report.backend;
  run.tolerance = report.tolerance;
  run.front_min_width = report.front_min_width;
  run.fringe_reach = report.fringe_reach;
  run.paper_labels = report.paper_labels;
  run.image = report.image;
  run.geometry = report.geometry;
  run.geometry_fallback |= report.geometry_fallback;
  run.allow_missing_meshes |= report.has_missing_links;
  run.frames = range_of(report.indices);
  if (!report.targets.empty()) run.targets = find_input(report.targets, folder);
  run.no_targets = report.targets.empty() && !report.has_target_topics;
  return run;
}

std::vector<io::Part> all_parts() {
  std::vector<io::Part> parts;
  for (std::size_t i = 0; i < io::part_count; ++i) parts.push_back(static_cast<io::Part>(i));
  return parts;
}

/// Keeps frames, and tells the results of a run that one more was judged again.
class ComparedStore final : public RunOutput {
 public:
  ComparedStore(io::FrameStore& store, io::RunFolder* folder) : store_(store), folder_(folder) {}

  void begin(const io::ReportHead& head) override { store_.begin(head); }
  void save(const FrameReport& report, const io::FrameData& frame,
            const io::ShownTargets& targets) override {
    store_.add(report, frame, targets);
    if (folder_ != nullptr) folder_->compare_next();
  }
  void finish(const Statistics& statistics, std::span<const std::string> notes) override {
    store_.finish(statistics, notes);
  }
  [[nodiscard]] std::string where() const override { return {}; }

 private:
  io::FrameStore& store_;
  io::RunFolder* folder_;
};

}  // namespace

bool is_run_folder(const fs::path& input) {
  std::error_code error;
  if (!fs::is_directory(input, error)) return input.filename() == report_name;
  return fs::exists(input / report_name, error) && !fs::exists(input / "recording.yaml", error) &&
         !fs::exists(input / "metadata.yaml", error);
}

ViewSource::ViewSource(const ViewArguments& arguments) {
  check_is_something(arguments.judging.input);
  const bool is_run = is_run_folder(arguments.judging.input);
  if (!is_run && !arguments.input.empty())
    throw InputError("--input: names the input of a run whose results are shown, and " +
                     arguments.judging.input.string() + " is an input itself; leave it out");
  if (is_run)
    open_run(arguments);
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
                                .parts = all_parts()},
                io::make_scene(pipeline.robot()), *store_, judging_->size());
}

void ViewSource::open_run(const ViewArguments& arguments) {
  const fs::path& named = arguments.judging.input;
  const fs::path folder = named.filename() == report_name ? named.parent_path() : named;
  refuse_choices(arguments.judging, folder);
  io::RunReport report = io::RunReport::read(folder / report_name);
  RunArguments run = arguments.judging;
  run.input = arguments.input;
  judged_ = asked_of(report, run, folder);
  check_renderer(judged_.renderer);
  std::string why;
  try {
    judging_.emplace(judged_);
    store_.emplace(judging_->pipeline().rectification());
    store_->begin(judging_->head());
  } catch (const InputError& error) {
    judging_.reset();
    why = std::string(error.what()) + " (penumbra view " + folder.string() +
          " --input PATH names the run's input, and takes --package and the options of bags)";
  }
  io::SessionInfo info{.input = report.input, .links = report.links, .image = report.image};
  if (judging_) info.camera = judging_->camera();
  io::Scene scene =
      judging_ ? io::make_scene(judging_->pipeline().robot()) : io::make_scene(report.links);
  const std::size_t frames = report.frames.size();
  folder_.emplace(folder, std::move(report), judging_ ? &*store_ : nullptr, std::move(why));
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
    ComparedStore output(*store_, folder_ ? &*folder_ : nullptr);
    judging_->run(output, [this] { return !stop_; });
  } catch (...) {
    error_ = std::current_exception();
  }
  if (folder_) folder_->finish(what_went_wrong());
  over_ = true;
}

std::string ViewSource::what_went_wrong() const {
  try {
    if (error_) std::rethrow_exception(error_);
  } catch (const std::exception& error) {
    return error.what();
  }
  return judging_->lost();
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
