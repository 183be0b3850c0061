// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <penumbra/targets/target.hpp>

namespace penumbra::python {

namespace {

void bind_judgements(py::module_& m) {
  py::class_<Blame> blame(m, "Blame", "A link that hides a target.");
  show_fields(blame, Field{"link", &Blame::name, "Its name."},
              Field{"fraction", &Blame::fraction, "Of the pixels inside the image."});
  using J = Judgement;
  py::class_<J> judgement(m, "Judgement",
                          "The judgement of a target's pixels. Fractions are of those inside the "
                          "image and add up to 1, together with hidden_by_other.");
  show_fields(
      judgement,
      Field{"covered", &J::covered, "Pixels of the extent, those outside the image too."},
      Field{"inside", &J::inside, "Pixels inside the image."},
      Field{"occluded", &J::occluded, "Fraction hidden by the robot."},
      Field{"front", &J::front, "Fraction before the robot."},
      Field{"unknown", &J::unknown, "Fraction not known."},
      Field{"clear", &J::clear, "Fraction without robot."},
      Field{"hidden_by_other", &J::hidden_by_other,
            "Fraction hidden by something else; None: not known."},
      Field{"measured", &J::measured, "Fraction that is seen and measured; None: not known."},
      Field{"seen_past", &J::seen_past,
            "Fraction measured past the expected depth; None: not known."},
      Field{"blame", &J::blame, "Links that hide it, largest first."},
      Field{"point_pixels", &J::point_pixels, "Trusted pixels, as far as they were asked."},
      Field{"point_spread", &J::point_spread, "Metres: 1.4826 * median absolute deviation."});
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
              Field{"sigma", &H::sigma, "Metres: along the most uncertain direction."},
              Field{"lost_in", &H::lost_in,
                    "Seconds until it is lost, because the robot's plan hides it for longer than "
                    "its timeout; None: it will not be, or there is no forecast."});
  py::class_<TargetReport> report(m, "TargetReport",
                                  "The verdict on a target, and what it is based on.");
  using R = TargetReport;
  show_fields(
      report, Field{"name", &R::name, "Its name."},
      Field{"stamp", &R::stamp, "Of the frame that it was judged on, nanoseconds."},
      Field{"verdict", &R::verdict, "The verdict."},
      Field{"reason", &R::reason, "One line, of verdict unknown; else empty."},
      Field{"judgement", &R::judgement, "Of its pixels; None where none were judged."},
      Field{"point", &R::point, "Of trusted depths only; root link's frame, metres."},
      Field{"handled", &R::handled, "None without handling, or without stamps."},
      Field{"estimate", &R::estimate, "What became of its estimate; None: there was none."},
      Field{"forecast", &R::forecast,
            "VerdictIntervals of what the rest of Frame.plan will hide, in seconds from the frame "
            "on; empty: there is no plan, or it has ended."});
}

void bind_intervals(py::module_& m) {
  using V = VerdictInterval;
  py::class_<V> interval(m, "VerdictInterval", "Neighbouring times of one verdict.");
  show_fields(interval, Field{"begin", &V::begin, "Seconds from the start of the motion."},
              Field{"end", &V::end, "Seconds."}, Field{"verdict", &V::verdict, "In all of it."},
              Field{"hidden", &V::hidden, "Largest hidden share."},
              Field{"seen", &V::seen, "Seconds, by the share that is not hidden."},
              Field{"by", &V::by, "The link that hides most of it then; empty: none."},
              Field{"reason", &V::reason, "One line, of verdict unknown; else empty."});
}

}  // namespace

void bind_judgement(py::module_& m) {
  bind_intervals(m);
  bind_judgements(m);
  bind_reports(m);
}

}  // namespace penumbra::python
