// SPDX-License-Identifier: Apache-2.0
// The demo's program: `run`, of one camera's images in a recording. What handles more is replaced
// here, so that it need not be built.
#include <penumbra/base/error.hpp>
#include <penumbra/planning/plan_forecast.hpp>

#include <apps/penumbra/commands.hpp>
#include <apps/penumbra/run_cameras.hpp>
#include <io/inputs/input_session.hpp>
#include <io/outputs/output_bag.hpp>

namespace penumbra {
namespace {

[[noreturn]] void refuse(const std::string& input) {
  throw InputError(input +
                   ": the demo's program runs one camera's images in a folder; 'cmake --build "
                   "build/demo' builds penumbra with all that it can do");
}

}  // namespace

struct PlanForecast::State {};
PlanForecast::PlanForecast(const Robot& /*robot*/, const Camera& /*camera*/,
                           const PipelineConfig& /*config*/) {}
PlanForecast::~PlanForecast() = default;
PlanForecast::PlanForecast(PlanForecast&&) noexcept = default;
PlanForecast& PlanForecast::operator=(PlanForecast&&) noexcept = default;
std::span<const Forecast> PlanForecast::of(const Frame& /*frame*/) { refuse("a plan"); }

namespace io {

RunInput open_bag_input(const InputOptions& options, const LineSink& /*print*/) {
  refuse(options.path);
}

std::unique_ptr<Sink> open_output_bag(const std::filesystem::path& file,
                                      const Pipeline& /*pipeline*/) {
  refuse(file);
}

void check_former_bag(const std::filesystem::path& file) { refuse(file); }

Session make_session(Robot robot, const CloudConfig& /*config*/) { refuse(robot.name()); }

}  // namespace io

int app::run_cameras(const RunArguments& arguments, const std::vector<NamedCamera>& /*cameras*/) {
  refuse(arguments.session.input.path);
}

}  // namespace penumbra

int main(int argc, char** argv) {
  using namespace penumbra::app;
  constexpr Command commands[] = {{"run", "label every frame of a recording", add_run}};
  return run_program(argc, argv, commands, "");
}
