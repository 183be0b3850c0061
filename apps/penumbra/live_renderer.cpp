// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>
#include <penumbra/robot/primitives.hpp>

#include <apps/penumbra/live_renderer.hpp>
#include <apps/penumbra/text.hpp>
#include <io/printable.hpp>

namespace penumbra::app {

void check_draws(const RendererArguments& renderer) {
  const TriangleMesh mesh = make_box({0.1, 0.1, 0.1});
  const Body box{"box", {&mesh, 1}};
  const Intrinsics small(32, 24, 30.0, 30.0, 15.5, 11.5);
  const Eigen::Isometry3d before(Eigen::Translation3d(0, 0, 1));
  try {
    if (renderer.backend)
      static_cast<void>(make_depth_renderer(*renderer.backend, small, {&box, 1}, renderer.options)
                            ->render({&before, 1}));
    else
      static_cast<void>(choose_backend(small, {&box, 1}, renderer.options));
  } catch (const DeviceError& fault) {
    throw InputError(fault.what());
  }
}

std::vector<std::string> RendererNews::look(const io::LiveInbox& inbox) {
  std::vector<std::string> news;
  const auto add = [&](const std::string& line) {
    if (told_.insert(line).second) news.push_back(io::without_controls(line));
  };
  for (std::size_t i = 0; i < inbox.camera_count(); ++i) {
    const io::LiveTally& tally = inbox.tally(i);
    if (!tally.renderer) continue;
    const io::UsedRenderer& used = tally.renderer->used;
    const std::string& name = inbox.camera(i).options().name;
    if (!used.reason.empty())
      add((name.empty() ? "" : "camera " + name + ": ") +
          words_of_choice(used.info.backend, used.reason));
    for (const std::string& warning : tally.renderer_warnings) add("note: " + warning);
  }
  return news;
}

}  // namespace penumbra::app
