// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <python/frame.hpp>

#include <io/files/frame_reader.hpp>

namespace penumbra::python {

/// A recorded frame that keeps its images.
struct RecordedFrame {
  std::shared_ptr<io::FrameData> data;
  OwnedFrame frame;  ///< its depth lies in `data`
};

/// Of the frame that a source made of `data`; where its depth image lies elsewhere `data` gets a
/// copy. `targets`: what the source gave.
[[nodiscard]] RecordedFrame recorded(std::shared_ptr<io::FrameData> data, const Frame& frame,
                                     OwnedTargets targets);

/// Python's own iterator over what has __getitem__.
class FrameIterator : public py::object {
  PYBIND11_OBJECT_DEFAULT(FrameIterator, py::object, is_any)
};

}  // namespace penumbra::python

template <>
struct pybind11::detail::handle_type_name<penumbra::python::FrameIterator> {
  static constexpr auto name = const_name("Iterator[penumbra.RecordedFrame]");
};
