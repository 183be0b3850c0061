// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/judgement.hpp>

namespace penumbra::python {

OwnedJudgement::OwnedJudgement(const Judgement& of, std::span<const std::string> links)
    : judgement(of) {
  for (const Blame& link : of.blame) blame.push_back({links[link.link], link.fraction});
  judgement.blame = {};
}

OwnedTargetReport::OwnedTargetReport(const TargetReport& of, std::span<const std::string> links)
    : name(of.name),
      stamp(of.stamp),
      verdict(of.verdict),
      reason(of.reason),
      point(of.point),
      handled(of.handled),
      estimate(of.estimate) {
  if (of.judgement) judgement.emplace(*of.judgement, links);
}

namespace {

/// A number of a judgement.
template <auto Member>
auto of_judgement(const OwnedJudgement& judgement) {
  return judgement.judgement.*Member;
}

void bind_judgements(py::module_& m) {
  py::class_<OwnedBlame> blame(m, "Blame", "A link that hides a target.");
  show_fields(blame, Field{"link", &OwnedBlame::link, "Its name."},
              Field{"fraction", &OwnedBlame::fraction, "Of the pixels inside the image."});
  using J = Judgement;
  py::class_<OwnedJudgement>(m, "Judgement",
                             "What is said of a target's pixels. Fractions are of those inside the "
                             "image and add up to 1, together with hidden_by_other.")
      .def_property_readonly("covered", &of_judgement<&J::covered>,
                             "Pixels of the extent, those outside the image too.")
      .def_property_readonly("inside", &of_judgement<&J::inside>, "Pixels inside the image.")
      .def_property_readonly("occluded", &of_judgement<&J::occluded>,
                             "Fraction hidden by the robot.")
      .def_property_readonly("front", &of_judgement<&J::front>, "Fraction before the robot.")
      .def_property_readonly("unknown", &of_judgement<&J::unknown>, "Fraction not known.")
      .def_property_readonly("clear", &of_judgement<&J::clear>, "Fraction beside the robot.")
      .def_property_readonly("hidden_by_other", &of_judgement<&J::hidden_by_other>,
                             "Fraction hidden by something else; None: not known.")
      .def_property_readonly("measured", &of_judgement<&J::measured>,
                             "Fraction that is seen and measured; None: not known.")
      .def_property_readonly("seen_past", &of_judgement<&J::seen_past>,
                             "Fraction measured past the expected depth; None: not known.")
      .def_property_readonly(
          "blame", [](const OwnedJudgement& j) { return Frozen<OwnedBlame>{j.blame}; },
          "Links that hide it, largest first.")
      .def_property_readonly("point_pixels", &of_judgement<&J::point_pixels>,
                             "Trusted pixels, as far as they were asked.")
      .def_property_readonly("point_spread", &of_judgement<&J::point_spread>,
                             "Metres: 1.4826 * median absolute deviation.")
      .def("__repr__", [](const Self<OwnedJudgement>& self) {
        return repr_of(
            self, {"covered", "inside", "occluded", "front", "unknown", "clear", "hidden_by_other",
                   "measured", "seen_past", "blame", "point_pixels", "point_spread"});
      });
}

void bind_reports(py::module_& m) {
  py::class_<HandledTarget> handled(m, "HandledTarget",
                                    "Where a handled target is at the frame's stamp, in the root "
                                    "link's frame.");
  using H = HandledTarget;
  show_fields(handled, Field{"source", &H::source, "Where it comes from."},
              Field{"age", &H::age, "Seconds since the last accepted estimate; inf: none."},
              Field{"position", &H::position, "Metres; None if lost."},
              Field{"orientation", &H::orientation,
                    "Quaternion x, y, z, w; None if lost, or handled as a point."},
              Field{"sigma", &H::sigma, "Metres: along the most uncertain direction."});
  py::class_<OwnedTargetReport> report(m, "TargetReport", "What is said of a target.");
  using R = OwnedTargetReport;
  show_fields(
      report, Field{"name", &R::name, "Its name."},
      Field{"stamp", &R::stamp, "Of the frame that it was judged on, nanoseconds."},
      Field{"verdict", &R::verdict, "The verdict."},
      Field{"reason", &R::reason, "One line, of verdict unknown; else empty."},
      Field{"judgement", &R::judgement, "Of its pixels; None where none were judged."},
      Field{"point", &R::point, "Of trusted depths only; root link's frame, metres."},
      Field{"handled", &R::handled, "None without handling, or without stamps."},
      Field{"estimate", &R::estimate, "What became of its estimate; None: there was none."});
}

}  // namespace

void bind_judgement(py::module_& m) {
  bind_judgements(m);
  bind_reports(m);
}

}  // namespace penumbra::python
