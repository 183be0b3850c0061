// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <utility>

#include <python/bindings.hpp>

namespace penumbra::python {
namespace {

template <typename E>
using Named = std::pair<const char*, E>;

/// Makes the class; `value` gives a member's value in Python.
template <typename E, typename Value>
void make_enum(py::module_& m, const char* base, const char* name, const char* doc,
               const std::vector<Named<E>>& members, Value value) {
  py::dict values;
  for (const auto& [member, of] : members) values[member] = value(member, of);
  const py::object made =
      py::module_::import("enum").attr(base)(name, values, py::arg("module") = "penumbra");
  made.attr("__doc__") = doc;
  for (const auto& [member, of] : members)
    EnumClass<E>::members.push_back({of, py::object(made.attr(member)).release().ptr()});
  m.attr(name) = made;
}

/// Members are called as in C++; their values are the names in report.json and YAML files.
template <typename E>
void bind_enum(py::module_& m, const char* name, const char* doc,
               const std::vector<Named<E>>& members) {
  make_enum<E>(m, "Enum", name, doc, members,
               [](const char* member, E /*of*/) { return py::str(member); });
}

/// Members are called as to_string() calls the first `count` values.
template <typename E>
void bind_named_enum(py::module_& m, const char* name, const char* doc, int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.emplace_back(to_string(static_cast<E>(i)));
  std::vector<Named<E>> members;
  for (int i = 0; i < count; ++i)
    members.emplace_back(names[static_cast<std::size_t>(i)].c_str(), static_cast<E>(i));
  bind_enum<E>(m, name, doc, members);
}

void bind_image_enums(py::module_& m) {
  make_enum<Label>(m, "IntEnum", "Label",
                   "The value of a pixel in a label image. clear: no robot on this ray; front: "
                   "something real before the robot; occluded: the sensor sees the robot; unknown: "
                   "robot on the ray, no measurement; beyond: the sensor sees past the model; "
                   "fringe: next to the robot, where the sensor carried its depth.",
                   {{"clear", Label::clear},
                    {"front", Label::front},
                    {"occluded", Label::occluded},
                    {"unknown", Label::unknown},
                    {"beyond", Label::beyond},
                    {"fringe", Label::fringe}},
                   [](const char* /*member*/, Label of) { return static_cast<int>(of); });
  bind_enum<ImageSpace>(m, "ImageSpace",
                        "Which image results are given in: raw, the camera's as it comes, or "
                        "rectified, the pinhole image that covers it.",
                        {{"raw", ImageSpace::raw}, {"rectified", ImageSpace::rectified}});
  bind_named_enum<Backend>(
      m, "Backend", "The renderer: cpu (SIMD), gl (OpenGL without a display), reference.", 3);
  bind_named_enum<DistortionModel>(m, "DistortionModel", "A lens model, by ROS's name.", 4);
  bind_enum<io::BeyondMeans>(
      m, "BeyondMeans", "What verdicts make of the label beyond.",
      {{"occluded", io::BeyondMeans::occluded}, {"visible", io::BeyondMeans::visible}});
}

void bind_robot_enums(py::module_& m) {
  bind_enum<Geometry>(m, "Geometry", "Which geometry of a URDF is drawn.",
                      {{"collision", Geometry::collision}, {"visual", Geometry::visual}});
  bind_named_enum<JointType>(m, "JointType", "A joint's type, by its name in a URDF.", 6);
  bind_enum<JointStatus>(
      m, "JointStatus",
      "Whether joint positions are known at a stamp; missing: never seen, stale: "
      "not near it, disputed: two publishers differ.",
      {{"ok", JointStatus::ok},
       {"missing", JointStatus::missing},
       {"stale", JointStatus::stale},
       {"disputed", JointStatus::disputed}});
  bind_enum<PoseSource>(m, "PoseSource", "The source of the links' poses.",
                        {{"joints", PoseSource::joints},
                         {"transforms", PoseSource::transforms},
                         {"both", PoseSource::both}});
}

void bind_frame_enums(py::module_& m) {
  bind_named_enum<FrameStatus>(m, "FrameStatus",
                               "Whether a frame can be relied on, and if not, why.", 9);
  bind_named_enum<Verdict>(m, "Verdict",
                           "The verdict on a target. held: an attached body has its name.", 6);
  bind_enum<Extent>(m, "Extent",
                    "What a region covers of its target: amodal, all of it, or modal, what a "
                    "detector still sees.",
                    {{"amodal", Extent::amodal}, {"modal", Extent::modal}});
}

void bind_track_enums(py::module_& m) {
  bind_named_enum<Source>(m, "Source", "Where a handled target's position comes from.", 4);
  bind_named_enum<Outcome>(m, "Outcome", "What a tracker did with an estimate.", 5);
  bind_named_enum<Motion>(m, "Motion", "How a target's pose moves while nobody sees it.", 4);
  bind_named_enum<PointMotion>(m, "PointMotion", "How a target's point moves while nobody sees it.",
                               2);
}

}  // namespace

void bind_enums(py::module_& m) {
  bind_image_enums(m);
  bind_robot_enums(m);
  bind_frame_enums(m);
  bind_track_enums(m);
}

}  // namespace penumbra::python
