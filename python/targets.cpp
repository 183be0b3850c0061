// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

namespace penumbra::python {
namespace {

LinkFrame frame_of(const FrameName& name) {
  if (!name) return std::nullopt;
  return *name;
}

TargetShape shape_of(const OwnedShape& shape) {
  struct Viewed {
    TargetShape operator()(const std::monostate& none) const { return none; }
    TargetShape operator()(const OwnedRegionTarget& of) const {
      return RegionTarget{region_of(of.region), of.extent, of.expected_depth};
    }
    TargetShape operator()(const KeypointTarget& of) const { return of; }
    TargetShape operator()(const OwnedPointTarget& of) const {
      return PointTarget{of.position, of.radius, frame_of(of.frame)};
    }
    TargetShape operator()(const OwnedBoxTarget& of) const {
      return BoxTarget{of.pose, of.size, frame_of(of.frame)};
    }
    TargetShape operator()(const OwnedMeshTarget& of) const {
      return MeshTarget{of.mesh.triangles, of.pose, frame_of(of.frame)};
    }
  };
  return std::visit(Viewed{}, shape);
}

}  // namespace

Target target_of(const OwnedTarget& target) {
  Target view;
  view.name = target.name;
  view.has_identity = target.has_identity;
  view.shape = shape_of(target.shape);
  view.frame_id = target.frame_id;
  view.stamp = target.stamp;
  view.depth_margin = target.depth_margin;
  view.thresholds = target.thresholds;
  view.handling = target.handling;
  view.fault = target.fault;
  if (const auto& estimate = target.estimate)
    view.estimate = TargetEstimate{.value = estimate->value,
                                   .stamp = estimate->stamp,
                                   .frame = frame_of(estimate->frame),
                                   .covariance = estimate->covariance};
  return view;
}

std::span<const Target> SourceTargets::targets() const {
  if (source_->given != number_)
    throw py::value_error("targets: their file or bag has given those of another frame since");
  return targets_;
}

namespace {

constexpr const char* frame_doc =
    "Frame of the pose or position: None is the camera's optical frame, '' the robot's root link, "
    "else the link of that name.";

void bind_thresholds(py::module_& m) {
  py::class_<TargetThresholds> thresholds(m, "TargetThresholds",
                                          "From which share of its pixels inside the image on a "
                                          "target counts as hidden, and when again "
                                          "as seen.");
  using T = TargetThresholds;
  bind_fields(
      thresholds,
      Field{"partial_enter", &T::partial_enter,
            "Hidden share above which visible becomes partial."},
      Field{"partial_leave", &T::partial_leave, "Up to which it becomes visible again."},
      Field{"hidden_enter", &T::hidden_enter, "Above which it becomes hidden."},
      Field{"hidden_leave", &T::hidden_leave, "Up to which it becomes partial again."},
      Field{"unknown_limit", &T::unknown_limit,
            "Unknown share above which it becomes unknown; None: partial_enter."},
      Field{
          "past_limit", &T::past_limit,
          "Share of what is measured that is past its expected depth from which on it is unknown."},
      Field{"min_measured", &T::min_measured, "Least share of what is seen that must be measured."},
      Field{"min_inside", &T::min_inside,
            "At most this share of the extent in the image: out_of_view."},
      Field{"beyond_hides", &T::beyond_hides, "beyond counts as occluded; else as clear."},
      Field{"others_hide", &T::others_hide, "What others than the robot hide counts, too."},
      Field{"point_min_pixels", &T::point_min_pixels, "Trusted depths that a point needs."},
      Field{"point_min_fraction", &T::point_min_fraction, "And their share of the pixels inside."});
  thresholds.def("check", method(&T::check),
                 "Raises InputError, with the values, for shares that are none.");
}

void bind_image_shapes(py::module_& m) {
  py::class_<OwnedRegionTarget>(m, "RegionTarget", "Pixels of the report's images.")
      .def(py::init([](OwnedRegion region, Extent extent, std::optional<double> expected_depth) {
             return OwnedRegionTarget{std::move(region), extent, expected_depth};
           }),
           py::arg("region"), py::kw_only(), py::arg("extent") = RegionTarget{}.extent,
           py::arg("expected_depth") = RegionTarget{}.expected_depth,
           "expected_depth: metres; hidden then needs no measured depth.")
      .def_property_readonly(
          "extent", [](const OwnedRegionTarget& t) { return t.extent; },
          "What the region covers of the target.")
      .def_property_readonly(
          "expected_depth", [](const OwnedRegionTarget& t) { return t.expected_depth; }, "Metres.");
  py::class_<KeypointTarget> keypoint(m, "KeypointTarget",
                                      "A key point of a network; an ellipse around it is judged.");
  using K = KeypointTarget;
  bind_fields(
      keypoint, Field{"pixel", &K::pixel, "(u, v) of the report's images."},
      Field{"score", &K::score, "The network's."},
      Field{"min_score", &K::min_score, "Below: unknown."},
      Field{"semi_axes", &K::semi_axes, "Pixels, or metres if in_metres; > 0."},
      Field{"angle", &K::angle, "Radians from +u to +v: of the first semi-axis."},
      Field{"in_metres", &K::in_metres, "Lengths are metres at the expected or measured depth."},
      Field{"expected_depth", &K::expected_depth, "Metres, > 0; None: not known."});
}

void bind_space_shapes(py::module_& m) {
  py::class_<OwnedPointTarget> point(m, "PointTarget", "A ball around a point.");
  point.def(py::init([](const Eigen::Vector3d& position, double radius, FrameName frame) {
              return OwnedPointTarget{position, radius, std::move(frame)};
            }),
            py::arg("position"), py::kw_only(), py::arg("radius") = PointTarget{}.radius,
            py::arg("frame") = FrameName(), "Metres.");
  show_fields(point, Field{"position", &OwnedPointTarget::position, "Metres."},
              Field{"radius", &OwnedPointTarget::radius, "Metres."},
              Field{"frame", &OwnedPointTarget::frame, frame_doc});
  py::class_<OwnedBoxTarget> box(m, "BoxTarget", "A box, rendered alone.");
  box.def(py::init([](const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, FrameName frame) {
            return OwnedBoxTarget{pose, size, std::move(frame)};
          }),
          py::arg("pose"), py::arg("size"), py::kw_only(), py::arg("frame") = FrameName(),
          "pose: of its centre, axes along its edges; size: whole edges, metres.");
  show_fields(box, Field{"pose", &OwnedBoxTarget::pose, "Of its centre, metres."},
              Field{"size", &OwnedBoxTarget::size, "Whole edges, metres."},
              Field{"frame", &OwnedBoxTarget::frame, frame_doc});
  py::class_<OwnedMeshTarget> mesh(
      m, "MeshTarget",
      "A mesh, rendered alone. Give the same TriangleMesh again for the "
      "same mesh: what was made ready for rendering is kept by it.");
  mesh.def(py::init([](Mesh of, const Eigen::Isometry3d& pose, FrameName frame) {
             return OwnedMeshTarget{std::move(of), pose, std::move(frame)};
           }),
           py::arg("mesh"), py::arg("pose"), py::kw_only(), py::arg("frame") = FrameName(),
           "mesh: in the object's frame.");
  show_fields(mesh, Field{"mesh", &OwnedMeshTarget::mesh, "In the object's frame."},
              Field{"pose", &OwnedMeshTarget::pose, "Metres."},
              Field{"frame", &OwnedMeshTarget::frame, frame_doc});
}

/// A pose or a position, by its shape.
OwnedEstimate estimate_of(const ValueSource& value, std::optional<std::int64_t> stamp,
                          FrameName frame, const std::optional<Matrix6d>& covariance) {
  OwnedEstimate made{std::monostate(), stamp, std::move(frame), covariance};
  if (value.is_none()) return made;
  const bool is_pose = py::hasattr(value, "__len__") && py::len(value) == 4;
  if (is_pose)
    made.value = pose_of(value);
  else
    made.value = matrix_of<Eigen::Vector3d>(value);
  return made;
}

void bind_estimate(py::module_& m) {
  py::class_<OwnedEstimate>(m, "TargetEstimate",
                            "What the perception system says of a target's whereabouts.")
      .def(py::init(&estimate_of), py::arg("value"), py::kw_only(),
           py::arg("stamp") = TargetEstimate{}.stamp, py::arg("frame") = FrameName(),
           py::arg("covariance") = TargetEstimate{}.covariance,
           "value: a pose (4, 4), a position (3,), metres, or None: it found none in this frame. "
           "stamp: of its image, nanoseconds; None: the target's. covariance: of position and "
           "rotation vector along the axes of frame.");
}

/// Arguments of Target, in the order of its constructor.
void bind_target(py::module_& m) {
  const Target defaults;
  py::class_<OwnedTarget>(
      m, "Target",
      "What is to be judged in a frame. Whatever is wrong with it makes its verdict unknown and is "
      "said in the report's reason.")
      .def(
          py::init([](std::string name, OwnedShape shape, bool has_identity, std::string frame_id,
                      std::optional<std::int64_t> stamp, double depth_margin,
                      const TargetThresholds& thresholds, const TargetHandling& handling,
                      std::optional<OwnedEstimate> estimate, std::string fault) {
            return OwnedTarget{std::move(name),     has_identity, std::move(shape),
                               std::move(frame_id), stamp,        depth_margin,
                               thresholds,          handling,     std::move(estimate),
                               std::move(fault)};
          }),
          py::arg("name"), py::arg("shape"), py::kw_only(),
          py::arg("has_identity") = defaults.has_identity, py::arg("frame_id") = std::string(),
          py::arg("stamp") = defaults.stamp, py::arg("depth_margin") = defaults.depth_margin,
          py::arg("thresholds") = defaults.thresholds, py::arg("handling") = defaults.handling,
          py::arg("estimate") = std::optional<OwnedEstimate>(), py::arg("fault") = std::string(),
          "name: once per frame; by it verdicts and tracks are remembered. shape: None: not found "
          "in "
          "this frame. frame_id: of its image; others than the camera's are refused. stamp: of its "
          "image, nanoseconds; None: the frame's. depth_margin: metres by which its surface may "
          "lie "
          "off its expected depth. handling: how it is carried on while it is hidden.")
      .def_property_readonly(
          "name", [](const OwnedTarget& t) { return t.name; }, "Its name.")
      .def(
          "check", [](const OwnedTarget& t) { check_target(target_of(t)); },
          "Raises InputError for what can be right in no frame.");
  py::class_<SourceTargets>(
      m, "SourceTargets",
      "The targets of a frame as a file or a bag has them. They go into a Frame "
      "of that frame; once the next one is read they raise ValueError.")
      .def("__len__", [](const SourceTargets& s) { return s.targets().size(); })
      .def_property_readonly(
          "names",
          [](const SourceTargets& s) {
            Frozen<std::string> names;
            for (const Target& target : s.targets()) names.values.emplace_back(target.name);
            return names;
          },
          "Their names, in their order.");
}

}  // namespace

void bind_targets(py::module_& m) {
  bind_thresholds(m);
  bind_image_shapes(m);
  bind_space_shapes(m);
  bind_estimate(m);
  bind_target(m);
}

}  // namespace penumbra::python
