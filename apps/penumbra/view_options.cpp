// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <apps/penumbra/graph_options.hpp>
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {
namespace {

constexpr int most_port = 65535;

void add_server(CLI::App& app, io::WebOptions& server) {
  add_option(app, "--port", "where the page is served; 0: any that is free; default 8470", "N",
             [&](const std::string& text) {
               server.port = static_cast<std::uint16_t>(to_count("--port", text, 0, most_port));
             });
  add_option(app, "--address",
             "IP address to serve on; default 127.0.0.1, this machine alone; another wants the "
             "token that is printed",
             "IP", [&](const std::string& text) {
               if (text.empty()) refuse_option("--address", text, "an IP address");
               server.address = text;
             });
}

void add_live_options(CLI::App& app, LiveArguments& live) {
  const std::size_t before = app.get_options().size();
  add_cameras(app, live);
  add_graph(app, live);
  const auto all = app.get_options();
  for (std::size_t i = before; i < all.size(); ++i) all[i]->group("Of live");
}

/// `penumbra live` judges: the viewer shows what it publishes.
void check_view_live(ViewArguments& view) {
  const RunArguments& run = view.judging;
  const auto refuse = [](const std::string& option) {
    throw InputError(option +
                     ": penumbra live judges, and view live shows what it publishes; give "
                     "it to penumbra live, and leave it out here");
  };
  if (run.tolerance) refuse("--tolerance");
  if (run.front_min_width) refuse("--front-min-width");
  if (run.fringe_reach) refuse("--fringe-reach");
  if (run.sensor) refuse("--sensor");
  if (run.paper_labels) refuse("--labels");
  if (run.image == ImageSpace::rectified) refuse("--image");
  if (run.frames.first || run.frames.end) refuse("--frames");
  if (run.targets || run.no_targets) refuse("--targets");
  if (!run.bag.target_topics.empty()) refuse("--target-topic");
  if (!view.input.empty())
    throw InputError("--input: is of a run's results; view live has none, leave it out");
  if (view.live.cameras.size() > 1)
    throw InputError("--camera: one camera is shown at a time; start a penumbra view for each");
  view.live.judging = run;
  check_live(view.live);
}

void check_view_of_files(const ViewArguments& view) {
  const auto refuse = [](const std::string& option) {
    throw InputError(option + ": is of penumbra view live; leave it out");
  };
  if (!view.live.cameras.empty()) refuse("--camera");
  if (!view.live.name_space.empty()) refuse("--namespace");
  if (!view.live.remaps.empty()) refuse("--remap");
  if (view.live.graph.domain) refuse("--domain");
  if (view.live.reliable) refuse("--reliable");
}

}  // namespace

void add_view(CLI::App& app, ViewArguments& view) {
  app.footer(view_examples);
  RunArguments& run = view.judging;
  add_path(
      app, "INPUT",
      "a recording folder or its recording.yaml, a bag of ROS 2, a folder that run wrote, or live: "
      "what penumbra live publishes",
      "", run.input)
      ->required();
  add_path(app, "--input", "the input of a run, in place of the one that its report names", "PATH",
           view.input);
  add_server(app, view.server);
  add_judging(app, run);
  add_sequence(app, run);
  add_bag(app, run.bag);
  add_live_options(app, view.live);
}

void check_view(ViewArguments& view) {
  check_targets(view.judging);
  view.judging.is_shown = true;
  view.is_live = view.judging.input == "live";
  if (view.is_live)
    check_view_live(view);
  else
    check_view_of_files(view);
}

}  // namespace penumbra::app
