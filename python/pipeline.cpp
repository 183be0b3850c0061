// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/frame.hpp>
#include <python/report.hpp>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::python {
namespace {

using State = PipelineState;

void bind_pipeline_settings(py::module_& m) {
  py::class_<PipelineConfig> config(m, "PipelineConfig", "How frames are judged.");
  using C = PipelineConfig;
  bind_fields(
      config, Field{"backend", &C::backend, "What draws."},
      Field{"renderer", &C::renderer, "How the backend draws."},
      Field{"rule", &C::rule, "Its range and the camera's both apply."},
      Field{"image", &C::image, "Which image results are given in."},
      Field{"camera_parent", &C::camera_parent, "Link that the camera sits on; empty: the root."},
      Field{"T_parent_camera", &C::T_parent_camera,
            "Pose of the optical frame in that link's frame, metres."},
      Field{"target_history", &C::target_history,
            "Seconds that frames are kept for targets of an earlier stamp; 0: not at all."});
}

std::shared_ptr<State> make_pipeline(const Robot& robot, const Camera& camera,
                                     const PipelineConfig& config) {
  const py::gil_scoped_release others;
  return std::make_shared<State>(robot, camera, config);
}

Report process(const std::shared_ptr<State>& self, const OwnedFrame& frame) {
  const OneThread::Use use(self->thread, "Pipeline.process");
  self->lease.end("Pipeline.process", "the last report's labels, virtual_depth or link_image");
  std::optional<OneThread::Use> held;
  if (const auto* given = std::get_if<SourceTargets>(&frame.targets)) held.emplace(given->hold());
  OwnedFrame::Parts parts;
  const Frame view = frame.view(self->pipeline.robot(), parts);
  ++self->calls;
  const FrameReport* report = nullptr;
  {
    const py::gil_scoped_release others;
    report = &self->pipeline.process(view);
  }
  return {self, *report, frame.depth ? py::object(frame.depth->array) : py::none()};
}

void forget(State& self, const std::string& name) {
  const OneThread::Use use(self.thread, "Pipeline.forget_target");
  self.pipeline.forget_target(name);
}

void forget_all(State& self) {
  const OneThread::Use use(self.thread, "Pipeline.forget_targets");
  self.pipeline.forget_targets();
}

/// What holds for all frames.
void bind_pipeline_facts(py::class_<State, std::shared_ptr<State>>& pipeline) {
  pipeline
      .def_property_readonly(
          "robot", [](const State& s) { return s.pipeline.robot(); }, "The robot.")
      .def_property_readonly(
          "renderer", [](const State& s) { return s.pipeline.renderer(); }, "What draws.")
      .def_property_readonly(
          "triangle_count", [](const State& s) { return s.pipeline.triangle_count(); },
          "Of all links.")
      .def_property_readonly(
          "rule", [](const State& s) { return s.pipeline.rule(); },
          "The rule that labels are made by.")
      .def_property_readonly(
          "intrinsics", [](const State& s) { return s.pipeline.intrinsics(); },
          "Size and projection of the report's images.")
      .def_property_readonly(
          "missing_links",
          [](const State& s) {
            const auto links = s.pipeline.missing_links();
            return Frozen<std::string>{{links.begin(), links.end()}};
          },
          "Links whose geometry could not be read.");
}

}  // namespace

void bind_pipeline(py::module_& m) {
  bind_pipeline_settings(m);
  py::class_<State, std::shared_ptr<State>> pipeline(
      m, "Pipeline",
      "The whole method, one call per frame: poses, virtual depth, labels, targets. Serves one "
      "thread at a time; other threads run meanwhile.");
  pipeline
      .def(py::init(&make_pipeline), py::arg("robot"), py::arg("camera"),
           py::arg("config") = PipelineConfig(),
           "Raises InputError for a robot of which nothing is drawn, a camera parent that is no "
           "link, "
           "a pose that is not rigid, and what the parts refuse.")
      .def("process", &process, py::arg("frame"),
           "Judges one frame. Whatever is wrong with it is the report's status. Raises ValueError "
           "while an array upon the last report's images is in use, DeviceError if a graphics "
           "device fails.")
      .def("forget_target", &forget, py::arg("name"),
           "Forgets a target's verdict, extent and track: the name stands for something new.")
      .def("forget_targets", &forget_all, "Forgets all of them, and the kept frames.");
  bind_pipeline_facts(pipeline);
}

}  // namespace penumbra::python
