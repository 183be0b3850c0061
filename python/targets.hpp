// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <python/arrays.hpp>
#include <python/robot.hpp>

#include <penumbra/targets/target.hpp>

namespace penumbra::python {

// Arguments that are checked after the call.
using MaskSource = Shown<"Annotated[Union[NDArray[uint8], NDArray[bool_]], '(H, W)']">;
using CornerSource = Shown<"Annotated[NDArray[float64], '(N, 2)']">;
using ValueSource = Shown<"Annotated[NDArray[float64], '(4, 4) or (3,)']">;

/// Returns a mask on an array of uint8 or of bool, whose bytes are 0 and 1. Throws as
/// check_image().
[[nodiscard]] PixelMask pixel_mask_of(const py::object& source, const char* argument);

}  // namespace penumbra::python

namespace pybind11::detail {

/// None is the camera's frame, an empty name the root's.
template <>
struct type_caster<penumbra::ReferenceFrame>
    : penumbra::python::ValueCaster<penumbra::ReferenceFrame> {
  static constexpr auto name = const_name("Optional[str]");
  bool load(handle source, bool convert) {
    using penumbra::ReferenceFrame;
    if (source.is_none()) return true;
    make_caster<std::string> inner;
    if (!inner.load(source, convert)) return false;
    auto link = cast_op<std::string&&>(std::move(inner));
    value = link.empty() ? ReferenceFrame::root() : ReferenceFrame::of_link(std::move(link));
    return true;
  }
  static handle cast(const penumbra::ReferenceFrame& frame, return_value_policy /*policy*/,
                     handle /*parent*/) {
    if (frame.kind == penumbra::ReferenceFrame::Kind::camera) return none().release();
    return str(frame.link).release();
  }
};

}  // namespace pybind11::detail
