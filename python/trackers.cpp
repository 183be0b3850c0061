// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::python {
namespace {

void bind_tracker_settings(py::module_& m) {
  constexpr const char* doc = "How a target is followed; docs/tracking.md says how to choose.";
  py::class_<PoseTrackerConfig> pose(m, "PoseTrackerConfig", doc);
  bind_settings(pose);
  py::class_<PointTrackerConfig> point(m, "PointTrackerConfig", doc);
  bind_settings(point);
}

void bind_tracks(py::module_& m) {
  py::class_<TrackedPose> pose(m, "TrackedPose", "Where a target is at a stamp; lost: not known.");
  using P = TrackedPose;
  show_fields(pose, Field{"source", &P::source, "Where it comes from."},
              Field{"age", &P::age, "Seconds since the last accepted estimate; inf: none."},
              Field{"pose", &P::pose, "Fixed frame, metres."},
              Field{"twist", &P::twist, "Linear and angular velocity, fixed frame."},
              Field{"covariance", &P::covariance, "Of position and rotation vector."});
  py::class_<TrackedPoint> point(m, "TrackedPoint",
                                 "Where a target is at a stamp; lost: not known.");
  using Q = TrackedPoint;
  show_fields(point, Field{"source", &Q::source, "Where it comes from."},
              Field{"age", &Q::age, "Seconds since the last accepted estimate; inf: none."},
              Field{"position", &Q::position, "Fixed frame, metres."},
              Field{"velocity", &Q::velocity, "m/s; 0 while it is held."},
              Field{"covariance", &Q::covariance, "Of the position."});
}

void bind_pose_tracker(py::module_& m) {
  py::class_<PoseTracker>(m, "PoseTracker",
                          "Follows one target's pose: takes an estimate only where its target was "
                          "visible, and predicts it meanwhile.")
      .def(py::init<const PoseTrackerConfig&>(), py::arg("config") = PoseTrackerConfig(),
           "Raises InputError for settings out of bounds.")
      .def(
          "update",
          [](PoseTracker& self, std::int64_t stamp, const Eigen::Isometry3d& pose, Verdict verdict,
             const std::optional<Matrix6d>& covariance, const std::optional<double>& seen) {
            return self.update(
                {.stamp = stamp, .pose = pose, .covariance = covariance, .seen = seen}, verdict);
          },
          py::arg("stamp"), py::arg("pose"), py::arg("verdict"), py::kw_only(),
          py::arg("covariance") = py::none(), py::arg("seen") = py::none(),
          "stamp: of the image it was found in, nanoseconds; pose: fixed frame, metres; verdict: "
          "of the target at that stamp; covariance: of position and rotation vector; seen: share "
          "of the target that was seen, 0 to 1.")
      .def("at", &PoseTracker::at, py::arg("stamp"), "The target at a stamp, nanoseconds.")
      .def("reset", &PoseTracker::reset, "Forgets all estimates.");
}

void bind_point_tracker(py::module_& m) {
  py::class_<PointTracker>(m, "PointTracker", "Follows one point, as PoseTracker follows a pose.")
      .def(py::init<const PointTrackerConfig&>(), py::arg("config") = PointTrackerConfig(),
           "Raises InputError for settings out of bounds.")
      .def(
          "update",
          [](PointTracker& self, std::int64_t stamp, const Eigen::Vector3d& position,
             Verdict verdict, const std::optional<Eigen::Matrix3d>& covariance) {
            return self.update({.stamp = stamp, .position = position, .covariance = covariance},
                               verdict);
          },
          py::arg("stamp"), py::arg("position"), py::arg("verdict"), py::kw_only(),
          py::arg("covariance") = py::none(),
          "stamp in nanoseconds; position: fixed frame, metres; verdict: of the target at that "
          "stamp.")
      .def("at", &PointTracker::at, py::arg("stamp"), "The target at a stamp, nanoseconds.")
      .def("reset", &PointTracker::reset, "Forgets all estimates.");
}

}  // namespace

void bind_trackers(py::module_& m) {
  bind_tracker_settings(m);
  bind_tracks(m);
  bind_pose_tracker(m);
  bind_point_tracker(m);
}

}  // namespace penumbra::python
