// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/tuning/tuning.hpp>

#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>
#include <apps/penumbra/progress.hpp>
#include <apps/penumbra/text.hpp>
#include <io/files/image_size.hpp>
#include <io/files/names.hpp>
#include <io/files/result_folder.hpp>
#include <io/files/stl_file.hpp>
#include <io/files/tuning_report.hpp>
#include <io/inputs/input_session.hpp>

namespace penumbra::app {
namespace {

struct TuneArguments {
  io::SessionOptions session;  ///< with the current rule
  std::filesystem::path output;
  bool force = false;  ///< advise although the setup looks wrong
};

namespace fs = std::filesystem;

/// Keeps frames to measure.
class TuneOutput final : public io::Sink {
 public:
  explicit TuneOutput(const Pipeline& pipeline)
      : frames(pipeline.robot(), pipeline.report_camera(),
               {.most = most_tuning_frames, .motion = 0.02}),
        range_{pipeline.rule().range.near, std::min(pipeline.rule().range.far, 1e3)} {}

  void take(const Frame& frame, const FrameReport& report) override {
    std::optional<KeptFrame> kept = frames.pass(report, frame.pose.positions);
    if (!kept || report.nothing_measured) return;
    kept->depth = frames.depth_of(report.depth, range_);
    kept->virtual_depth = io::copy_of(report.virtual_depth.depth);
    kept->links = io::copy_of(report.virtual_depth.links);
    kept->color = io::copy_of(frame.color.view);
    frames.add(*std::move(kept));
  }

  KeptFrames frames;

 private:
  MeasuredRange range_;
};

std::string percent(double share) { return fixed(100.0 * share, 2) + " %"; }

/// Without zeros at the end.
std::string short_number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string size_of(const Eigen::AlignedBox3d& box) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += (i == 0 ? "" : " x ") + fixed(100.0 * box.sizes()[i], 0);
  return text + " cm";
}

void print_measured(const Tuning& tuning, std::size_t frames, const Robot& robot) {
  const ToleranceFit& tolerance = tuning.tolerance;
  const FringeFit& fringe = tuning.fringe;
  std::cout << frames << " frames with different poses of the robot\n"
            << "tolerance: " << tolerance.pixels << " pixels well inside the robot's outline, "
            << "median measured - virtual depth " << fixed(1e3 * tolerance.bias, 1)
            << " mm\n  false front: " << percent(tolerance.false_front_now)
            << " of the robot's pixels now, " << percent(tolerance.false_front_then)
            << " with the tolerance below\n"
            << "fringe: " << fringe.found << " of " << fringe.checked
            << " pixels next to the arm show its depth; distance from it: median "
            << fixed(fringe.median, 0) << " px, 90 % " << fixed(fringe.percent_90, 0)
            << " px, 99 % " << fixed(fringe.percent_99, 0)
            << " px\n  points of the arm that stay, by fringe_reach:";
  for (std::size_t i = 0; i < fringe.left_over.size(); i += 2)
    std::cout << (i == 0 ? " " : ", ") << i * FringeFit::step << ": "
              << percent(fringe.left_over[i]);
  std::cout << '\n';
  for (const ExtraPart& part : tuning.extras)
    for (const Eigen::AlignedBox3d& box : part.boxes)
      std::cout << robot.links()[part.link] << ": " << size_of(box) << " that the URDF lacks\n";
}

/// Paths of meshes are relative to the recording.yaml.
void print_settings(const Tuning& tuning, const std::vector<io::WrittenExtra>& extras,
                    const TuneArguments& arguments) {
  const fs::path& folder = arguments.output;
  const fs::path& input = arguments.session.input.path;
  const fs::path recording = fs::is_directory(input) ? input : input.parent_path();
  const Tolerance& e = tuning.rule.tolerance;
  const std::string a = short_number(e.a), c = short_number(e.c);
  const int reach = tuning.rule.fringe_reach;
  std::cout << "\nin the recording.yaml, below 'camera:':\n  tolerance: [" << a << ", 0, " << c
            << "]\n  fringe_reach: " << reach << '\n';
  std::string list, options;
  for (const io::WrittenExtra& extra : extras) {
    list += (list.empty() ? "" : ", ") + std::string("{link: ") + extra.link +
            ", mesh: " + fs::proximate(folder / extra.file, recording).string() + "}";
    options += " --extra " + io::for_shell(extra.link + "=" + (folder / extra.file).string());
  }
  if (!extras.empty()) std::cout << "robot:\n  extra: [" << list << "]\n";
  std::cout << "\nor the options: --tolerance " << a << ",0," << c << " --fringe-reach " << reach
            << options << '\n';
}

void add_options(CLI::App& app, TuneArguments& tune) {
  app.footer(tune_examples);
  add_input(app, tune.session.input);
  add_text(app, "-o,--output", "folder for the results, made if need be", "OUT", tune.output)
      ->required();
  app.add_flag("--force", tune.force, "advise although the setup looks wrong");
  add_session(app, tune.session);
  add_frames(app, tune.session.input.frames);
  add_bag(app, tune.session.input.bag);
}

void check_options(const CLI::App& app, TuneArguments& tune) {
  check_session(app, tune.session);
  tune.session.input.needs_depth = true;
  tune.session.input.with_color = true;  // for the picture
  tune.session.no_targets = true;
  tune.session.image = ImageSpace::rectified;  // tuning takes a pinhole camera's images
}

int execute(const TuneArguments& arguments) {
  io::ResultFolder folder({.path = arguments.output,
                           .report = {"tune.json", io::json_begin},
                           .others = {{"tune.png"}, {"extra_*.stl", io::stl_begin}}});
  io::InputSession session(arguments.session, print_line);
  const Pipeline& pipeline = session.pipeline();
  TuneOutput kept(pipeline);
  {
    Progress progress(session.size().value_or(0));
    const io::RunResult result = session.run({&kept}, [&] {
      progress.step();
      return true;
    });
    if (!result.device_fault.empty()) {
      print_notes(std::vector{result.device_fault});
      return device_failed;
    }
    const Diagnosis& wrong = result.statistics.diagnosis();
    if (!wrong.message.empty() && !arguments.force)
      throw InputError(
          arguments.session.input.path.string() + ": not tuned: " + wrong.message +
          "; tolerances and parts measured before that is mended would hide it (--force "
          "measures them)");
  }
  folder.begin(session.made_files());
  print_notes(kept.frames.notes());
  const auto frames = kept.frames.frames();
  const Tuning tuning = tune(frames, pipeline.intrinsics(), pipeline.robot(), pipeline.rule());
  std::vector<io::WrittenExtra> extras;
  for (const ExtraPart& part : tuning.extras) {
    const std::string& link = pipeline.robot().links()[part.link];
    std::string name = link;
    std::replace(name.begin(), name.end(), '/', '_');
    extras.push_back({link, "extra_" + name + ".stl"});
    folder.add(extras.back().file, [&](const fs::path& file) { io::write_stl(file, part.mesh); });
  }
  const KeptFrame& shown = frames[tuning.fringe.shown_frame];
  Image<Rgb8> color;
  const auto seen = io::rectified(pipeline.rectification(), shown.color.view(), color);
  const Image<Rgb8> picture = io::draw_tuning(tuning, shown, seen);
  folder.add("tune.png", [&](const fs::path& file) { io::write_png(file, picture.view()); });
  folder.add_text("tune.json", io::tuning_json(tuning, frames, extras) + "\n");
  folder.finish();
  print_measured(tuning, frames.size(), pipeline.robot());
  print_settings(tuning, extras, arguments);
  return 0;
}

}  // namespace

Execute add_tune(CLI::App& app) {
  return make_command<TuneArguments>(app, add_options, check_options, execute);
}

}  // namespace penumbra::app
