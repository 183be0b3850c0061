// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/renderer.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/without_robot.hpp>

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
  bind_settings(rule, Field{"fold_beyond", &R::fold_beyond, "Call beyond occluded."},
                Field{"range", &R::range, "Measured depths outside of it are no measurements."});
  rule.def_static(
      "paper", &R::paper,
      "The paper as written: 0.01 m everywhere, no clean-up, no fringe, beyond folded.");
  rule.def_static(
      "for_sensor", &R::for_sensor, py::arg("name"),
      "The rule of a kind of sensor: realsense_d4xx, zed, tof, structured_light, none.");
}

struct Labeller {
  Labeller(int width_, int height_, const LabelRule& rule, const std::string& isa)
      : classifier(width_, height_, rule, isa), width(width_), height(height_) {}
  Classifier classifier;
  int width, height;
  std::uint64_t calls = 0;
  OneThread thread;
};

/// The labels of an image.
struct Labels {
  std::shared_ptr<Labeller> labeller;
  std::uint64_t call;
  LabelView view{};
  ReadImage<std::uint8_t> image{};

  [[nodiscard]] ImageResult<std::uint8_t> labels() const {
    return image.read([&] {
      if (labeller->calls != call)
        throw py::value_error(
            "Labels: the classifier has labelled another image since: read "
            "labels before that");
      return view.labels;
    });
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
  check_size(measured.array, "measured", self->width, self->height);
  Labels labels{self, ++self->calls};
  const py::gil_scoped_release others;
  labels.view = self->classifier.classify(virtual_depth, measured.view);
  return labels;
}

Labels classify_array(const std::shared_ptr<Labeller>& self,
                      const ImageArgument<"virtual_depth", float>& virtual_depth,
                      const DepthArgument<"measured">& measured) {
  check_size(virtual_depth.array, "virtual_depth", self->width, self->height);
  const auto& depth = std::get<0>(virtual_depth.view);
  const auto is_depth = [](float z) { return z >= 0.0F && std::isfinite(z); };
  for (int v = 0; v < depth.height; ++v)
    if (!std::all_of(depth.row(v), depth.row(v) + depth.width, is_depth))
      throw InputError("virtual_depth: row " + std::to_string(v) +
                       " has negative values, or some that are not finite; expected metres, 0 "
                       "without the robot");
  return classify(self, {.depth = std::get<0>(virtual_depth.view), .links = {}}, measured);
}

Labels classify_rendered(const std::shared_ptr<Labeller>& self, const VirtualDepth& virtual_depth,
                         const DepthArgument<"measured">& measured) {
  const OneThread::Use held = virtual_depth.renderer->hold();
  const VirtualDepthView& view = virtual_depth.view();
  check_size("virtual_depth", view.depth.width, view.depth.height, self->width, self->height);
  return classify(self, view, measured);
}

void bind_classifier(py::module_& m) {
  py::class_<Labels> labels(m, "Labels", "The labels of an image.");
  show_properties(
      labels,
      Field{"labels", &Labels::labels,
            "Label values, (H, W): a read-only copy, made when it is first read. Raises ValueError "
            "if it was not read before the classifier's next call."},
      Field{"pixels", &Labels::pixels, "How many pixels have each Label."});
  bind_repr(labels, {"pixels"});
  py::class_<Labeller, std::shared_ptr<Labeller>> classifier(
      m, "Classifier", "Labels depth images of one size. Serves one thread at a time.");
  classifier
      .def(py::init<int, int, const LabelRule&, const std::string&>(), py::arg("width"),
           py::arg("height"), py::arg("rule"), py::arg("isa") = std::string(),
           "isa: a SIMD target by name, or empty: the best one. Raises InputError for "
           "a rule or a size out of bounds.")
      // The first overload takes results of a renderer only; everything else gets the array's
      // errors.
      .def("classify", &classify_rendered, py::arg("virtual_depth"), py::arg("measured"),
           "Labels every pixel. virtual_depth: metres, 0 where no robot is; measured: millimetres "
           "(uint16) or metres (float32).")
      .def("classify", &classify_array, py::arg("virtual_depth"), py::arg("measured"),
           "The same of a virtual depth image from elsewhere.");
  show_fields(classifier,
              Field{"rule", [](const Labeller& l) { return l.classifier.rule(); }, "In use."},
              Field{"isa", [](const Labeller& l) { return l.classifier.isa(); },
                    "The SIMD target in use."});
}

ImageResult<std::uint8_t> front_of_array(const ImageArgument<"virtual_depth", float>& virtual_depth,
                                         const DepthArgument<"measured">& measured,
                                         const Tolerance& tolerance) {
  const Image<std::uint8_t> front =
      front_of(std::get<0>(virtual_depth.view), measured.view, tolerance);
  return array_of(front.view(), nullptr);
}

}  // namespace

void bind_labels(py::module_& m) {
  bind_rule(m);
  bind_classifier(m);
  m.def("front_of", &front_of_array, py::arg("virtual_depth"), py::arg("measured"),
        py::arg("tolerance") = Tolerance(),
        "Returns 255 where the rendered robot stands before what a depth image shows, else 0, "
        "(H, W): what to paint of another robot over that scene. virtual_depth: metres, 0 where no "
        "robot is; measured: millimetres (uint16) or metres (float32). The robot is in front up to "
        "the tolerance behind the measured depth, and where nothing is measured. Raises InputError "
        "for images of different sizes.");
}

}  // namespace penumbra::python
