// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <span>

#include <python/arrays.hpp>
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/robot.hpp>

#include <penumbra/cloud/scan.hpp>

namespace penumbra::python {
namespace {

using PointArray = Shown<"Annotated[NDArray[float32], '(N, 3)']">;
using LabelArray = Shown<"Annotated[NDArray[uint8], '(N,)']">;
using LinkArray = Shown<"Annotated[NDArray[uint16], '(N,)']">;
using TimeArray = Shown<"Annotated[NDArray[int32], '(N,)']">;

struct PointLabeller {
  PointLabeller(const std::vector<OwnedBody>& bodies, const CloudRule& rule, int threads)
      : labeller(with_bodies(bodies, [&](auto all) { return CloudLabeller(all, rule, threads); })) {
  }

  CloudLabeller labeller;
  OneThread thread;
};

/// The labels of a cloud.
struct PointLabels {
  LabelArray labels;
  LinkArray links;
  std::optional<std::size_t> enclosing;
};

PointsView points_of(const py::object& source) {
  const std::string expected =
      "points: expected numpy.ndarray of float32 with shape (N, 3) or more columns, those of a row "
      "side by side; got " +
      description_of(source);
  if (!py::isinstance<py::array>(source)) throw py::type_error(expected);
  if (is_masked(source)) throw py::type_error(expected + mask_fault);
  const py::array array(source);
  if (!is_native(array.dtype(), py::dtype::of<float>().num())) throw py::type_error(expected);
  constexpr auto size = static_cast<py::ssize_t>(sizeof(float));
  const bool is_cloud = array.ndim() == 2 && array.shape(1) >= 3 && array.strides(1) == size;
  if (!is_cloud) throw py::value_error(expected);
  return {static_cast<const std::byte*>(array.data()), static_cast<std::size_t>(array.shape(0)),
          array.strides(0)};
}

template <typename T>
std::span<const T> row_of(const py::object& source, const std::string& argument) {
  if (!py::isinstance<py::array_t<T>>(source) || is_masked(source) ||
      !(py::array(source).flags() & py::array::c_style))
    throw py::type_error(argument + ": expected numpy.ndarray of " +
                         py::cast<std::string>(py::str(py::dtype::of<T>())) +
                         " with shape (N,); got " + description_of(source));
  const py::array array(source);
  return {static_cast<const T*>(array.data()), static_cast<std::size_t>(array.size())};
}

Scan make_scan(const PointArray& points, const std::optional<TimeArray>& times,
               const std::optional<Eigen::Vector3d>& origin) {
  Scan scan{.points = points_of(points),
            .origin = origin,
            .owner = owner_of(py::make_tuple(points, times))};
  if (times) scan.times = row_of<std::int32_t>(*times, "times");
  return scan;
}

PointArray points_in(const Scan& scan) {
  const PointsView& points = scan.points;
  return PointArray(
      read_only(py::array(py::dtype::of<float>(), {py::ssize_t(points.count), py::ssize_t{3}},
                          {py::ssize_t{points.stride}, py::ssize_t{sizeof(float)}}, points.data,
                          keeper_of(scan.owner))));
}

std::optional<TimeArray> times_in(const Scan& scan) {
  if (scan.times.empty()) return std::nullopt;
  return TimeArray(
      read_only(py::array(py::dtype::of<std::int32_t>(), {py::ssize_t(scan.times.size())}, {},
                          scan.times.data(), keeper_of(scan.owner))));
}

template <typename Array, typename T>
Array copied_array(const std::vector<T>& values) {
  return Array(read_only(py::array(static_cast<py::ssize_t>(values.size()), values.data())));
}

PointLabels label(PointLabeller& self, const PointArray& points, const Poses& T_points_body,
                  const std::optional<Eigen::Vector3d>& origin,
                  const std::optional<LinkArray>& parts) {
  const OneThread::Use use(self.thread, "CloudLabeller.label");
  const PointsView view = points_of(points);
  if (origin && !origin->allFinite()) throw py::value_error("origin: expected finite numbers");
  if (!origin && parts) throw py::value_error("parts: points without an origin are of one instant");
  std::span<const std::uint16_t> part_of;
  if (parts) part_of = row_of<std::uint16_t>(*parts, "parts");
  const CloudLabels* found = nullptr;
  {
    const py::gil_scoped_release others;
    found = origin ? &self.labeller.label(view, *origin, T_points_body, part_of)
                   : &self.labeller.label(view, T_points_body);
  }
  return {copied_array<LabelArray>(found->labels), copied_array<LinkArray>(found->links),
          found->enclosing};
}

std::shared_ptr<PointLabeller> make_labeller(const std::vector<OwnedBody>& bodies,
                                             const CloudRule& rule, int threads) {
  const py::gil_scoped_release others;
  return std::make_shared<PointLabeller>(bodies, rule, threads);
}

void bind_scan(py::module_& m) {
  py::class_<Scan> scan(m, "Scan",
                        "The points of a scan, or of a cloud that is measured at once, in the "
                        "sensor's frame. They are read where they are: do not change them while "
                        "they are judged.");
  scan.def(py::init(&make_scan), py::arg("points"), py::kw_only(), py::arg("times") = py::none(),
           py::arg("origin") = Scan().origin, "points: float32 (N, 3) or more columns, metres.");
  show_properties(scan, Field{"points", &points_in, "The coordinates, metres."},
                  Field{"times", &times_in,
                        "When each point was measured, nanoseconds after the frame's stamp; None: "
                        "all at the stamp."},
                  Field{"origin", &Scan::origin,
                        "Where the rays start; None: points without rays, as of merged clouds."});
  py::class_<CloudConfig> config(m, "CloudConfig", "A sensor that measures points.");
  using C = CloudConfig;
  bind_fields(
      config, Field{"rule", &C::rule, "That points are labelled by."},
      Field{"threads", &C::threads, "Results do not depend on them."},
      Field{"sensor_parent", &C::sensor_parent, "Link that carries the sensor; empty: the root."},
      Field{"T_parent_sensor", &C::T_parent_sensor,
            "Pose of the points' frame in that link's frame, metres."},
      Field{"target_history", &C::target_history,
            "Seconds that scans are kept for targets of an earlier stamp; 0: not at all."});
}

}  // namespace

void bind_cloud(py::module_& m) {
  py::class_<CloudRule> rule(
      m, "CloudRule",
      "The rule of labelling points. On a ray that meets the robot at range s, a point is front if "
      "it is nearer than s - e(s), beyond if it is farther than s + beyond_factor e(s), else "
      "occluded. Clear and front points that a beam may have mixed with robot next to their ray "
      "are fringe.");
  bind_settings(rule);
  rule.def_static("for_sensor", &CloudRule::for_sensor, py::arg("name"),
                  "The rule of a sensor: lidar_2cm (the default), livox_mid360, ouster_os1 or "
                  "hokuyo; estimates from data sheets. Raises InputError for another name.");
  py::class_<PointLabels> labels(m, "CloudLabels",
                                 "The labels of a cloud, in the order of its points.");
  show_fields(
      labels, Field{"labels", &PointLabels::labels, "Values of Label; unknown: no measurement."},
      Field{"links", &PointLabels::links,
            "Body index + 1 of the robot that decided; 0: clear, or no measurement."},
      Field{"enclosing", &PointLabels::enclosing,
            "Index of the body that the sensor lies in, or less than 2 cm from: all labels are "
            "unknown; or None."});
  py::class_<PointLabeller, std::shared_ptr<PointLabeller>>(
      m, "CloudLabeller",
      "Says of each point of a cloud whether it is the robot's. Serves one thread at a time.")
      .def(py::init(&make_labeller), py::arg("bodies"), py::arg("rule") = CloudRule(),
           py::arg("threads") = 1,
           "bodies: Robot.bodies, say. Results do not depend on threads. Raises InputError for "
           "settings out of bounds.")
      .def("label", &label, py::arg("points"), py::arg("T_points_body"),
           py::arg("origin") = py::none(), py::arg("parts") = py::none(),
           "Labels points by the poses of the bodies, both in the same frame, metres. origin: "
           "where the sensor that measured the points stood. None: points without rays, as of "
           "merged clouds: those on or in the robot are occluded, the others clear. Coordinates "
           "that are not finite, and points less than 2 cm from the origin, are no measurement. "
           "parts: for a robot that moves during the scan, the part of the scan that each point is "
           "of; T_points_body then has the poses of all bodies in part 0, in part 1 and so on.");
  bind_scan(m);
}

}  // namespace penumbra::python
