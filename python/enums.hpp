// SPDX-License-Identifier: Apache-2.0
// C++ enumerations as Python's own enum classes.
#pragma once

#include <string>
#include <vector>

#include <python/values.hpp>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/joint_buffer.hpp>
#include <penumbra/tracking/trackers.hpp>

#include <io/files/recording.hpp>

namespace penumbra::python {

/// The Python class of a C++ enumeration, once bind_enums() has run. Kept for the whole process.
template <typename E>
struct EnumClass {
  struct Member {
    E value;
    PyObject* object;
  };
  static inline std::vector<Member> members;
};

/// To and from the members of EnumClass<E>; anything else is refused.
template <typename E>
struct EnumCaster : ValueCaster<E> {
  bool load(pybind11::handle source, bool /*convert*/) {
    for (const auto& member : EnumClass<E>::members) {
      if (member.object != source.ptr()) continue;
      this->value = member.value;
      return true;
    }
    return false;
  }
  static pybind11::handle cast(E of, pybind11::return_value_policy /*policy*/,
                               pybind11::handle /*parent*/) {
    for (const auto& member : EnumClass<E>::members)
      if (member.value == of) return pybind11::handle(member.object).inc_ref();
    throw std::logic_error("an enumeration has a value without a name");
  }
};

}  // namespace penumbra::python

#define PENUMBRA_PYTHON_ENUM(Type, Name)                                            \
  template <>                                                                       \
  struct pybind11::detail::type_caster<Type> : penumbra::python::EnumCaster<Type> { \
    static constexpr auto name = const_name("penumbra." Name);                      \
  }

PENUMBRA_PYTHON_ENUM(penumbra::Backend, "Backend");
PENUMBRA_PYTHON_ENUM(penumbra::DistortionModel, "DistortionModel");
PENUMBRA_PYTHON_ENUM(penumbra::Extent, "Extent");
PENUMBRA_PYTHON_ENUM(penumbra::FrameStatus, "FrameStatus");
PENUMBRA_PYTHON_ENUM(penumbra::Geometry, "Geometry");
PENUMBRA_PYTHON_ENUM(penumbra::ImageSpace, "ImageSpace");
PENUMBRA_PYTHON_ENUM(penumbra::JointStatus, "JointStatus");
PENUMBRA_PYTHON_ENUM(penumbra::JointType, "JointType");
PENUMBRA_PYTHON_ENUM(penumbra::Label, "Label");
PENUMBRA_PYTHON_ENUM(penumbra::Motion, "Motion");
PENUMBRA_PYTHON_ENUM(penumbra::Outcome, "Outcome");
PENUMBRA_PYTHON_ENUM(penumbra::PointMotion, "PointMotion");
PENUMBRA_PYTHON_ENUM(penumbra::PoseSource, "PoseSource");
PENUMBRA_PYTHON_ENUM(penumbra::Source, "Source");
PENUMBRA_PYTHON_ENUM(penumbra::Verdict, "Verdict");
PENUMBRA_PYTHON_ENUM(penumbra::io::BeyondMeans, "BeyondMeans");

#undef PENUMBRA_PYTHON_ENUM
