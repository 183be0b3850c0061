// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <python/arrays.hpp>
#include <python/robot.hpp>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::python {

/// A renderer and its last frames.
class Renderer {
 public:
  Renderer(Backend backend, const Intrinsics& intrinsics, const std::vector<OwnedBody>& bodies,
           const RendererOptions& options);

  /// Throws ValueError for another number of poses, and for a second thread.
  void submit(const Poses& T_camera_body);
  /// Returns the frame's number.
  std::uint64_t collect();

  /// Returns the images of frame `number`. Throws ValueError if a later frame has replaced them.
  [[nodiscard]] const VirtualDepthView& images(std::uint64_t number) const;

  /// Keeps other threads from rendering meanwhile.
  [[nodiscard]] OneThread::Use hold() { return {thread_, "Renderer"}; }

  [[nodiscard]] const DepthRenderer& renderer() const { return *renderer_; }

 private:
  std::unique_ptr<DepthRenderer> renderer_;
  std::vector<VirtualDepthView> frames_;  // number % size
  std::uint64_t submitted_ = 0, collected_ = 0;
  OneThread thread_;
};

/// What a frame showed.
struct VirtualDepth {
  std::shared_ptr<Renderer> renderer;
  std::uint64_t number;
  ReadImage<float> depth_image{};
  ReadImage<std::uint16_t> link_image{};

  [[nodiscard]] const VirtualDepthView& view() const { return renderer->images(number); }
  [[nodiscard]] ImageResult<float> depth() const {
    return depth_image.read([&] { return view().depth; });
  }
  [[nodiscard]] ImageResult<std::uint16_t> links() const {
    return link_image.read([&] { return view().links; });
  }
};

}  // namespace penumbra::python
