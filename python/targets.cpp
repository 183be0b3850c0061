// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/targets.hpp>

namespace penumbra::python {
namespace {

constexpr const char* frame_doc =
    "Frame of the pose or position: None is the camera's optical frame or the scan's, '' the "
    "robot's "
    "root link, else the link of that name.";

void bind_thresholds(py::module_& m) {
  py::class_<TargetThresholds> thresholds(m, "TargetThresholds",
                                          "From which share of its pixels inside the image on a "
                                          "target counts as hidden, and when again "
                                          "as seen.");
  bind_settings(thresholds);
}

void bind_image_shapes(py::module_& m) {
  using R = RegionTarget;
  py::class_<R> region(m, "RegionTarget", "Pixels of the report's images.");
  bind_fields<1>(region, Field{"region", &R::region, "Its pixels."},
                 Field{"extent", &R::extent, "What the region covers of the target."},
                 Field{"expected_depth", &R::expected_depth,
                       "Metres; hidden then needs no measured depth. None: not known."},
                 Field{"height", &R::height,
                       "Metres, of an object that stands upright: the expected depth follows from "
                       "the region's height. None: not known."});
  py::class_<KeypointTarget> keypoint(m, "KeypointTarget",
                                      "A key point of a network; an ellipse around it is judged.");
  using K = KeypointTarget;
  bind_fields<1>(
      keypoint, Field{"pixel", &K::pixel, "(u, v) of the report's images."},
      Field{"score", &K::score, "The network's."},
      Field{"min_score", &K::min_score, "Below: unknown."},
      Field{"semi_axes", &K::semi_axes, "Pixels, or metres if in_metres; > 0."},
      Field{"angle", &K::angle, "Radians from +u to +v: of the first semi-axis."},
      Field{"in_metres", &K::in_metres, "Lengths are metres at the expected or measured depth."},
      Field{"expected_depth", &K::expected_depth, "Metres, > 0; None: not known."});
}

void bind_space_shapes(py::module_& m) {
  using P = PointTarget;
  py::class_<P> point(m, "PointTarget", "A ball around a point.");
  bind_fields<1>(point, Field{"position", &P::position, "Metres."},
                 Field{"radius", &P::radius, "Metres."}, Field{"frame", &P::frame, frame_doc});
  using B = BoxTarget;
  py::class_<B> box(m, "BoxTarget", "A box, rendered alone.");
  bind_fields<2>(box, Field{"pose", &B::pose, "Of its centre, axes along its edges, metres."},
                 Field{"size", &B::size, "Whole edges, metres."},
                 Field{"frame", &B::frame, frame_doc});
  using M = MeshTarget;
  py::class_<M> mesh(m, "MeshTarget",
                     "A mesh, rendered alone. Give the same TriangleMesh again for the same mesh: "
                     "it keeps what was prepared for rendering.");
  mesh.def(py::init([](const Mesh& of, const Eigen::Isometry3d& pose, ReferenceFrame frame) {
             return M{of.prepared, pose, std::move(frame)};
           }),
           py::arg("mesh"), py::arg("pose"), py::kw_only(), py::arg("frame") = ReferenceFrame());
  show_fields(mesh,
              Field{"mesh", [](const M& of) { return Mesh{of.mesh}; }, "In the object's frame."},
              Field{"pose", &M::pose, "Metres."}, Field{"frame", &M::frame, frame_doc});
  bind_replace(mesh, {"mesh", "pose", "frame"});
}

/// A pose or a position, by its shape.
TargetEstimate estimate_of(const ValueSource& value, Nanoseconds<std::optional<std::int64_t>> stamp,
                           ReferenceFrame frame, const std::optional<Matrix6d>& covariance) {
  TargetEstimate made{std::monostate(), stamp, std::move(frame), covariance};
  if (value.is_none()) return made;
  const bool is_pose = py::hasattr(value, "__len__") && py::len(value) == 4;
  if (is_pose)
    made.value = pose_of(value);
  else
    made.value = matrix_of<Eigen::Vector3d>(value);
  return made;
}

void bind_estimate(py::module_& m) {
  using E = TargetEstimate;
  py::class_<E> estimate(m, "TargetEstimate",
                         "A perception system's estimate of a target's pose or position.");
  estimate.def(py::init(&estimate_of), py::arg("value"), py::kw_only(),
               py::arg("stamp") = py::none(), py::arg("frame") = ReferenceFrame(),
               py::arg("covariance") = TargetEstimate{}.covariance);
  show_fields(estimate,
              Field{"value", &E::value,
                    "A pose (4, 4), a position (3,), metres, or None: not found in this frame."},
              Field{"stamp", &E::stamp, "Of its image, nanoseconds; None: the target's."},
              Field{"frame", &E::frame, frame_doc},
              Field{"covariance", &E::covariance,
                    "Of position and rotation vector along the axes of frame."});
}

void bind_target(py::module_& m) {
  using T = Target;
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
  target.def("check", &check_target, "Raises InputError for what can be right in no frame.");
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
