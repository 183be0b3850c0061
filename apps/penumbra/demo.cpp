// SPDX-License-Identifier: Apache-2.0
// The demo's program: `run`, of images in recordings alone. What handles bags and clouds is
// replaced here, so that it need not be built.
#include <penumbra/base/error.hpp>

#include <apps/penumbra/commands.hpp>
#include <io/inputs/input_session.hpp>
#include <io/outputs/output_bag.hpp>

namespace penumbra::io {
namespace {

[[noreturn]] void refuse(const std::string& input) {
  throw InputError(
      input +
      ": the demo's program handles no bags and no clouds; 'cmake --build build/demo' builds "
      "penumbra with all that it can do");
}

}  // namespace

RunInput open_bag_input(const InputOptions& options, const LineSink& /*print*/) {
  refuse(options.path);
}

std::unique_ptr<RunOutput> open_output_bag(const std::filesystem::path& file,
                                           const Camera& /*camera*/, std::string /*root*/) {
  refuse(file);
}

void check_former_bag(const std::filesystem::path& file) { refuse(file); }

Session make_session(Robot robot, const CloudConfig& /*config*/) { refuse(robot.name()); }

}  // namespace penumbra::io

int main(int argc, char** argv) {
  using namespace penumbra::app;
  constexpr Command commands[] = {{"run", "label every frame of a recording", add_run}};
  return run_program(argc, argv, commands, "");
}
