// SPDX-License-Identifier: Apache-2.0
// One verdict over several cameras.
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/report.hpp>

#include <penumbra/fusion/target_fusion.hpp>

namespace penumbra::python {
namespace {

void add_report(TargetFusion& self, std::size_t camera, const Report& of) {
  FrameReport report = of.numbers;
  report.targets = of.targets;
  self.add(camera, report);
}

void bind_views(py::module_& m) {
  py::class_<ViewCamera> camera(m, "ViewCamera", "One of several cameras that judge one scene.");
  camera.def(py::init([](std::string name, const Intrinsics& intrinsics, const Tolerance& noise) {
               return ViewCamera{std::move(name), intrinsics, noise};
             }),
             py::arg("name"), py::arg("intrinsics"), py::arg("tolerance"));
  show_fields(camera, Field{"name", &ViewCamera::name, "Its name, not used twice."},
              Field{"intrinsics", &ViewCamera::intrinsics, "Of the report's images."},
              Field{"tolerance", &ViewCamera::tolerance, "Of its label rule."});
  py::class_<CameraView> view(m, "CameraView", "A target as one camera judged it.");
  using V = CameraView;
  show_fields(view, Field{"camera", &V::camera, "Index into TargetFusion.cameras."},
              Field{"stamp", &V::stamp, "Of the image, nanoseconds; None: none in the window."},
              Field{"verdict", &V::verdict, "Its verdict."},
              Field{"reason", &V::reason, "One line, of verdict unknown; else empty."},
              Field{"visible_fraction", &V::visible_fraction, "Clear and front, of its pixels."},
              Field{"point", &V::point, "Root link's frame, metres; None: not measured."},
              Field{"covariance", &V::covariance, "Of the point, square metres."},
              Field{"distance", &V::distance, "Of the point from the camera, metres."},
              Field{"angle", &V::angle, "Of the point from the optical axis, radians."});
  py::class_<Contradiction> pair(m, "Contradiction",
                                 "Two cameras that measure a target at different places.");
  using C = Contradiction;
  show_fields(pair, Field{"first", &C::first, "Index into TargetFusion.cameras."},
              Field{"second", &C::second, "Index into TargetFusion.cameras."},
              Field{"distance", &C::distance, "Between the points, metres."},
              Field{"chi_square", &C::chi_square, "Squared Mahalanobis distance."});
  py::class_<FusedTarget> target(m, "FusedTarget", "A target over all cameras.");
  using F = FusedTarget;
  show_fields(target, Field{"name", &F::name, "Its name."},
              Field{"stamp", &F::stamp, "Of the newest view, nanoseconds."},
              Field{"verdict", &F::verdict, "The verdict over all cameras."},
              Field{"reason", &F::reason, "One line, of verdict unknown; else empty."},
              Field{"views", &F::views, "CameraView of each camera that judges it."},
              Field{"best", &F::best, "Index of the camera that sees it best; None: none does."},
              Field{"point", &F::point, "Root link's frame, metres; None: not known."},
              Field{"covariance", &F::covariance, "Of the point, square metres."},
              Field{"contradiction", &F::contradiction, "None where the cameras agree."});
}

}  // namespace

void bind_target_fusion(py::module_& m) {
  bind_views(m);
  py::class_<TargetFusionConfig> config(m, "TargetFusionConfig", "When views belong together.");
  using C = TargetFusionConfig;
  bind_fields(config, Field{"window", &C::window, "Seconds: older views count as unknown."});
  py::class_<TargetFusion>(m, "TargetFusion",
                           "Combines what several cameras say of the same targets into one verdict "
                           "for each name: docs/scene.md.")
      .def(py::init<std::vector<ViewCamera>, const TargetFusionConfig&>(), py::arg("cameras"),
           py::arg("config") = TargetFusionConfig(),
           "Raises InputError for no camera, a name used twice and a window that is not positive.")
      .def_property_readonly(
          "cameras", [](const TargetFusion& self) { return shown(self.cameras()); },
          "In the given order.")
      .def("add", &add_report, py::arg("camera"), py::arg("report"),
           "Takes a FrameReport of the camera of this index. Raises InputError for one without a "
           "stamp.")
      .def(
          "fused", [](const TargetFusion& self) { return Frozen<FusedTarget>{self.fused()}; },
          "All targets, by name.");
}

}  // namespace penumbra::python
