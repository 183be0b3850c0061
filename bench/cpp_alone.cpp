// SPDX-License-Identifier: Apache-2.0
// What a whole frame costs in C++, for python_overhead.py: the same pipeline on the same frames, so
// that all memory lies where it does for calls from Python.
#include <chrono>
#include <vector>

#include <python/bindings.hpp>
#include <python/frame.hpp>
#include <python/report.hpp>

namespace {

using namespace penumbra;
namespace py = pybind11;

double time_frame(Pipeline& pipeline, const python::OwnedFrame& given) {
  Frame frame;
  frame.depth = given.depth->view;
  frame.joints = std::get<python::Numbers>(given.joints).values;
  const auto start = std::chrono::steady_clock::now();
  const FrameReport& report = pipeline.process(frame);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  if (!has_pose(report.status)) throw py::value_error(report.message);
  return time.count();
}

/// Milliseconds of each frame, with no Python in between.
std::vector<double> frame_times(const std::shared_ptr<python::PipelineState>& state,
                                const std::vector<const python::OwnedFrame*>& frames) {
  std::vector<double> times;
  times.reserve(frames.size());
  for (const python::OwnedFrame* frame : frames)
    times.push_back(time_frame(state->pipeline, *frame));
  return times;
}

}  // namespace

PYBIND11_MODULE(cpp_alone, m) {
  py::module_::import("penumbra");  // its classes
  m.def("frame_times", &frame_times, py::arg("pipeline"), py::arg("frames"));
}
