// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::python {
namespace {

constexpr const char* settings_doc =
    "How a target is followed; docs/tracking.md says how to choose.";
constexpr const char* worst_doc =
    "The worst verdict with which estimates are accepted, of visible, partial, hidden.";

void bind_pose_settings(py::module_& m) {
  py::class_<PoseTrackerConfig> config(m, "PoseTrackerConfig", settings_doc);
  using C = PoseTrackerConfig;
  bind_fields(
      config, Field{"motion", &C::motion, "How it moves while nobody sees it."},
      Field{"direction", &C::direction, "Of along_direction, fixed frame."},
      Field{"speed", &C::speed, "m/s along it; None: estimated."},
      Field{"position_sigma", &C::position_sigma, "Metres per axis, without a covariance."},
      Field{"orientation_sigma", &C::orientation_sigma, "Radians, likewise."},
      Field{"acceleration", &C::acceleration, "m/s^2/sqrt(Hz)."},
      Field{"angular_acceleration", &C::angular_acceleration, "rad/s^2/sqrt(Hz)."},
      Field{"drift", &C::drift, "m/sqrt(s)."},
      Field{"angular_drift", &C::angular_drift, "rad/sqrt(s)."},
      Field{"speed_sigma", &C::speed_sigma, "m/s per axis, of a new track."},
      Field{"angular_speed_sigma", &C::angular_speed_sigma, "rad/s, likewise."},
      Field{"timeout", &C::timeout, "Seconds since the last accepted estimate; then lost."},
      Field{"gate", &C::gate,
            "Squared Mahalanobis distance above which an estimate is an outlier."},
      Field{"gate_patience", &C::gate_patience,
            "Consistent outliers in a row that make a new track."},
      Field{"memory", &C::memory, "Seconds back to which late estimates are taken in order."},
      Field{"max_estimates", &C::max_estimates, "That are remembered."},
      Field{
          "worst", &C::worst,
          "The worst verdict with which estimates are accepted, of visible, partial, hidden; None: "
          "visible, and partial where at least 0.4 was seen."});
  config.def("check", &C::check, "Raises InputError, with the values, for settings out of bounds.");
}

void bind_point_settings(py::module_& m) {
  py::class_<PointTrackerConfig> config(m, "PointTrackerConfig", settings_doc);
  using C = PointTrackerConfig;
  bind_fields(
      config, Field{"motion", &C::motion, "How it moves while nobody sees it."},
      Field{"sigma", &C::sigma, "Metres per axis, without a covariance."},
      Field{"acceleration", &C::acceleration, "m/s^2/sqrt(Hz), of constant_velocity."},
      Field{"speed_sigma", &C::speed_sigma, "m/s per axis, of a new track."},
      Field{"held_speed", &C::held_speed, "m/s per axis by which a held point's sigma grows."},
      Field{"timeout", &C::timeout, "Seconds since the last accepted estimate; then lost."},
      Field{"gate", &C::gate,
            "Squared Mahalanobis distance above which an estimate is an outlier."},
      Field{"gate_patience", &C::gate_patience,
            "Consistent outliers in a row that make a new track."},
      Field{"memory", &C::memory, "Seconds back to which late estimates are taken in order."},
      Field{"max_estimates", &C::max_estimates, "That are remembered."},
      Field{"worst", &C::worst, worst_doc});
  config.def("check", &C::check, "Raises InputError, with the values, for settings out of bounds.");
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
  bind_pose_settings(m);
  bind_point_settings(m);
  bind_tracks(m);
  bind_pose_tracker(m);
  bind_point_tracker(m);
}

}  // namespace penumbra::python
