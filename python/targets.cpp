// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

namespace penumbra::python {
namespace {

ReferenceFrame frame_of(const FrameName& name) {
  if (!name) return {};
  return name->empty() ? ReferenceFrame::root() : ReferenceFrame::of_link(*name);
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
  thresholds.def("check", &T::check, "Raises InputError, with the values, for invalid fractions.");
}

void bind_image_shapes(py::module_& m) {
  using R = OwnedRegionTarget;
  py::class_<R> region(m, "RegionTarget", "Pixels of the report's images.");
  bind_fields<1>(region, Field{"region", &R::region, "Its pixels."},
                 Field{"extent", &R::extent, "What the region covers of the target."},
                 Field{"expected_depth", &R::expected_depth,
                       "Metres; hidden then needs no measured depth. None: not known."});
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
  using P = OwnedPointTarget;
  py::class_<P> point(m, "PointTarget", "A ball around a point.");
  bind_fields<1>(point, Field{"position", &P::position, "Metres."},
                 Field{"radius", &P::radius, "Metres."}, Field{"frame", &P::frame, frame_doc});
  using B = OwnedBoxTarget;
  py::class_<B> box(m, "BoxTarget", "A box, rendered alone.");
  bind_fields<2>(box, Field{"pose", &B::pose, "Of its centre, axes along its edges, metres."},
                 Field{"size", &B::size, "Whole edges, metres."},
                 Field{"frame", &B::frame, frame_doc});
  using M = OwnedMeshTarget;
  py::class_<M> mesh(m, "MeshTarget",
                     "A mesh, rendered alone. Give the same TriangleMesh again for the same mesh: "
                     "it keeps what was prepared for rendering.");
  bind_fields<2>(mesh, Field{"mesh", &M::mesh, "In the object's frame."},
                 Field{"pose", &M::pose, "Metres."}, Field{"frame", &M::frame, frame_doc});
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
  using E = OwnedEstimate;
  py::class_<E> estimate(m, "TargetEstimate",
                         "A perception system's estimate of a target's pose or position.");
  estimate.def(py::init(&estimate_of), py::arg("value"), py::kw_only(),
               py::arg("stamp") = TargetEstimate{}.stamp, py::arg("frame") = FrameName(),
               py::arg("covariance") = TargetEstimate{}.covariance);
  show_fields(estimate,
              Field{"value", &E::value,
                    "A pose (4, 4), a position (3,), metres, or None: not found in this frame."},
              Field{"stamp", &E::stamp, "Of its image, nanoseconds; None: the target's."},
              Field{"frame", &E::frame, frame_doc},
              Field{"covariance", &E::covariance,
                    "Of position and rotation vector along the axes of frame."});
}

std::vector<std::string> names_of(const SourceTargets& targets) {
  std::vector<std::string> names;
  for (const Target& target : targets.targets()) names.emplace_back(target.name);
  return names;
}

void bind_target(py::module_& m) {
  using T = OwnedTarget;
  py::class_<T> target(m, "Target",
                       "What is to be judged in a frame. If anything is wrong with it, its verdict "
                       "is unknown and the report's reason says why.");
  bind_members<2>(
      target,
      Field{"name", &T::name, "Unique in a frame; verdicts and tracks are remembered by it."},
      Field{"shape", &T::shape, "None: not found in this frame."},
      Field{"has_identity", &T::has_identity,
            "False: the name may be another object's in the next frame."},
      Field{"frame_id", &T::frame_id, "Of its image; others than the camera's are refused."},
      Field{"stamp", &T::stamp, "Of its image, nanoseconds; None: the frame's."},
      Field{"depth_margin", &T::depth_margin,
            "Metres by which its surface may be off its expected depth."},
      Field{"thresholds", &T::thresholds, "From where on it counts as hidden."},
      Field{"handling", &T::handling, "How it is followed while it is hidden; None: not at all."},
      Field{"estimate", &T::estimate, "The perception system's estimate, or None."},
      Field{"fault", &T::fault, "What its source knows to be wrong with it; empty: nothing."});
  bind_repr(target, {"name", "shape"});
  target.def(
      "check", [](const T& t) { check_target(target_of(t)); },
      "Raises InputError for what can be right in no frame.");
  py::class_<SourceTargets> source(
      m, "SourceTargets",
      "The targets of a frame in a file or a bag. Put them into the Frame of that frame; once the "
      "next frame is read they raise ValueError.");
  source.def("__len__", [](const SourceTargets& s) { return s.targets().size(); });
  show_fields(source, Field{"names", &names_of, "Their names, in their order."});
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
