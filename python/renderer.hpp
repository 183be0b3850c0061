// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <python/arrays.hpp>
#include <python/robot.hpp>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::python {

/// A renderer, and which of its frames' images are still what was drawn.
class Renderer {
 public:
  Renderer(Backend backend, const Intrinsics& intrinsics, const std::vector<OwnedBody>& bodies,
           const RendererOptions& options);

  /// Throws ValueError as Lease::end, for another number of poses, and for a second thread.
  void submit(const Poses& T_camera_body);
  /// Answers the frame's number.
  std::uint64_t collect(VirtualDepthView& view);

  /// Throws ValueError if a later frame has taken the images of frame `number`.
  [[nodiscard]] py::object base_of(std::uint64_t number, const std::shared_ptr<const void>& owner);

  [[nodiscard]] const DepthRenderer& renderer() const { return *renderer_; }

 private:
  /// Of a frame and the one that takes its place.
  struct Slot {
    Lease lease;
    std::uint64_t number = 0;
  };

  [[nodiscard]] Slot& slot_of(std::uint64_t number) { return slots_[number % slots_.size()]; }

  std::unique_ptr<DepthRenderer> renderer_;
  std::vector<Slot> slots_;
  std::uint64_t submitted_ = 0, collected_ = 0;
  OneThread thread_;
};

/// What a frame showed.
class VirtualDepth {
 public:
  VirtualDepth(std::shared_ptr<Renderer> renderer, std::uint64_t number,
               const VirtualDepthView& view)
      : renderer_(std::move(renderer)), number_(number), view_(view) {}

  [[nodiscard]] ImageResult<float> depth() const { return array_of(view_.depth, base()); }
  [[nodiscard]] ImageResult<std::uint16_t> links() const { return array_of(view_.links, base()); }

  /// The images, kept by what is returned beside them.
  [[nodiscard]] std::pair<VirtualDepthView, py::object> view() const { return {view_, base()}; }

 private:
  [[nodiscard]] py::object base() const { return renderer_->base_of(number_, renderer_); }

  std::shared_ptr<Renderer> renderer_;
  std::uint64_t number_;
  VirtualDepthView view_;
};

}  // namespace penumbra::python
