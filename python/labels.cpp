// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/renderer.hpp>

#include <penumbra/labels/labels.hpp>

namespace penumbra::python {
namespace {

void bind_rule(py::module_& m) {
  py::class_<Tolerance> tolerance(
      m, "Tolerance",
      "e(z) = a + b z + c z^2, metres: how far a measured depth may lie before the model and still "
      "be the robot.");
  bind_fields(tolerance, Field{"a", &Tolerance::a, "Metres."},
              Field{"b", &Tolerance::b, "Metres per metre."},
              Field{"c", &Tolerance::c, "Metres per square metre."});
  tolerance.def("at", &Tolerance::at, py::arg("z"), "e(z), metres.");

  py::class_<LabelRule> rule(m, "LabelRule", "The rule of labelling: docs/tuning.md.");
  using R = LabelRule;
  bind_fields(rule, Field{"tolerance", &R::tolerance, "How far off the robot may be measured."},
              Field{"beyond_factor", &R::beyond_factor, "k: beyond is past dV + k e(dV)."},
              Field{"front_min_width", &R::front_min_width, "Pixels of the clean-up; 0: none."},
              Field{"edge_margin", &R::edge_margin,
                    "Pixels by which an edge of the robot may look out of place."},
              Field{"fringe_reach", &R::fringe_reach,
                    "Pixels past the outline that the sensor carries depth; 0: no fringe."},
              Field{"fold_beyond", &R::fold_beyond, "Call beyond occluded."},
              Field{"range", &R::range, "Measured depths outside of it are no measurements."});
  rule.def_static(
      "paper", &R::paper,
      "The paper as written: 0.01 m everywhere, no clean-up, no fringe, beyond folded.");
  rule.def_static(
      "for_sensor", &R::for_sensor, py::arg("name"),
      "The rule of a kind of sensor: realsense_d4xx, zed, tof, structured_light, none.");
  rule.def("check", method(&R::check),
           "Raises InputError, with the values, for a rule that is none.");
}

/// A classifier and the rule of its result.
struct Labeller {
  Labeller(int width_, int height_, const LabelRule& rule, const std::string& isa)
      : classifier(width_, height_, rule, isa), width(width_), height(height_) {}
  Classifier classifier;
  int width, height;
  std::uint64_t calls = 0;
  Lease lease;
  OneThread thread;
};

/// What a classifier said of an image.
struct Labels {
  std::shared_ptr<Labeller> labeller;
  std::uint64_t call;
  LabelView view;

  [[nodiscard]] ImageResult<std::uint8_t> labels() const {
    if (labeller->calls != call)
      throw py::value_error(
          "Labels: the classifier has labelled another image since; take a copy "
          "of what is needed longer");
    return array_of(view.labels, labeller->lease.base(labeller));
  }
  [[nodiscard]] std::map<Label, std::size_t> pixels() const {
    std::map<Label, std::size_t> counts;
    for (std::size_t i = 0; i < label_count; ++i) counts[static_cast<Label>(i)] = view.pixels[i];
    return counts;
  }
};

Labels classify(const std::shared_ptr<Labeller>& self, const VirtualDepthView& virtual_depth,
                const DepthArgument<"measured">& measured) {
  const OneThread::Use use(self->thread, "Classifier.classify");
  self->lease.end("Classifier.classify", "the last labels");
  check_size(measured.array, "measured", self->width, self->height);
  Labels labels{self, ++self->calls, {}};
  const py::gil_scoped_release others;
  labels.view = self->classifier.classify(virtual_depth, measured.view);
  return labels;
}

Labels classify_rendered(const std::shared_ptr<Labeller>& self, const VirtualDepth& virtual_depth,
                         const DepthArgument<"measured">& measured) {
  const auto [view, kept] = virtual_depth.view();
  if (view.depth.width != self->width || view.depth.height != self->height)
    throw py::value_error("virtual_depth: expected shape (" + std::to_string(self->height) + ", " +
                          std::to_string(self->width) + "); got (" +
                          std::to_string(view.depth.height) + ", " +
                          std::to_string(view.depth.width) + ")");
  return classify(self, view, measured);
}

Labels classify_array(const std::shared_ptr<Labeller>& self,
                      const ImageArgument<"virtual_depth", float>& virtual_depth,
                      const DepthArgument<"measured">& measured) {
  check_size(virtual_depth.array, "virtual_depth", self->width, self->height);
  return classify(self, {.depth = std::get<0>(virtual_depth.view), .links = {}}, measured);
}

void bind_classifier(py::module_& m) {
  py::class_<Labels>(m, "Labels", "What a classifier said of an image.")
      .def_property_readonly(
          "labels", method(&Labels::labels),
          "Label values. A read-only view: while it is in use the classifier's next call raises "
          "ValueError, and after that call it is not to be had any more.")
      .def_property_readonly("pixels", method(&Labels::pixels), "How many pixels have each Label.");
  py::class_<Labeller, std::shared_ptr<Labeller>>(
      m, "Classifier", "Labels depth images of one size. Serves one thread at a time.")
      .def(py::init<int, int, const LabelRule&, const std::string&>(), py::arg("width"),
           py::arg("height"), py::arg("rule"), py::arg("isa") = std::string(),
           "isa: a SIMD target by name, scalar, or empty: the best there is. Raises InputError for "
           "a "
           "rule or a size that is none.")
      // The first one is taken for what a renderer gave alone; all else gets the array's errors.
      .def("classify", &classify_rendered, py::arg("virtual_depth"), py::arg("measured"),
           "Labels every pixel. virtual_depth: metres, 0 where no robot is; measured: millimetres "
           "(uint16) or metres (float32).")
      .def("classify", &classify_array, py::arg("virtual_depth"), py::arg("measured"),
           "The same of a virtual depth image from elsewhere.")
      .def_property_readonly(
          "rule", [](const Labeller& l) { return l.classifier.rule(); }, "The rule in use.")
      .def_property_readonly(
          "isa", [](const Labeller& l) { return l.classifier.isa(); }, "The SIMD target in use.");
}

}  // namespace

void bind_labels(py::module_& m) {
  bind_rule(m);
  bind_classifier(m);
}

}  // namespace penumbra::python
