// SPDX-License-Identifier: Apache-2.0
#include <apps/penumbra/help.hpp>
#include <apps/penumbra/options.hpp>

namespace penumbra::app {

void add_view(CLI::App& app, ViewArguments& view) {
  app.footer(view_examples);
  RunArguments& run = view.judging;
  add_path(app, "INPUT",
           "a recording folder or its recording.yaml, a bag of ROS 2, or a folder that run wrote",
           "", run.input)
      ->required();
  add_server(
      app, view.server,
      "where the page is served; 0: any that is free; default 8470, or the next that is free");
  add_judging(app, run);
  add_sequence(app, run);
  add_bag(app, run.bag);
}

void check_view(ViewArguments& view) {
  check_targets(view.judging);
  view.judging.is_shown = true;
}

}  // namespace penumbra::app
