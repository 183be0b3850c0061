// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>

#include <sim/experiments/experiment.hpp>

namespace penumbra::python {
namespace {

void run(const std::string& experiment, const std::filesystem::path& output,
         std::uint64_t first_seed, std::uint64_t end_seed, double duration, int threads,
         bool frames) {
  const sim::ExperimentOptions options{.experiment = experiment,
                                       .first_seed = first_seed,
                                       .end_seed = end_seed,
                                       .duration = duration,
                                       .threads = threads,
                                       .frames = frames,
                                       .output = output};
  sim::run_experiment(
      options, [](std::size_t) {}, [] {});
}

}  // namespace

void bind_experiments(py::module_& m) {
  const sim::ExperimentOptions defaults;
  m.def("experiments", &sim::experiments, "Names of the experiments: conveyor, handover.");
  m.def(
      "run_experiment", &run, py::arg("experiment"), py::arg("output"), py::kw_only(),
      py::arg("first_seed") = defaults.first_seed, py::arg("end_seed") = defaults.end_seed,
      py::arg("duration") = defaults.duration, py::arg("threads") = defaults.threads,
      py::arg("frames") = defaults.frames, WithoutGil(),
      "Runs an experiment over the seeds first_seed <= seed < end_seed and writes metrics.json and "
      "report.html into the folder output. duration: seconds of each run, 0: the scene's own; "
      "threads: 0: all cores; frames: also the first seed's annotated frames. Raises InputError "
      "where this build or machine lacks what it needs.");
}

}  // namespace penumbra::python
