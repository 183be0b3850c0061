// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <penumbra/render/cpu/frame.hpp>

namespace penumbra::cpu {

/// Records of one kernel's bins; one per thread.
struct Scratch;
struct ScratchDeleter {
  void operator()(Scratch* scratch) const;
};
using ScratchPtr = std::unique_ptr<Scratch, ScratchDeleter>;
[[nodiscard]] ScratchPtr make_scratch();

/// One frame's constants.
struct FrameContext {
  const ClusteredScene* scene;
  const BodyFrame* bodies;
  const Bounds* holes;  // of ClusteredScene::holes
  const View* view;
  Packing packing;
};

/// The functions of the renderer as compiled for one SIMD target.
struct Kernel {
  int lanes;

  /// Appends those clusters of a group to `items` that may be in view; returns how many. If both
  /// sides are drawn, `second` selects the clusters that face away: the others often hide them.
  std::size_t (*cull)(const FrameContext& frame, std::uint32_t group, Sides sides, bool second,
                      DrawItem* items);

  /// Draws clusters into the canvas and marks the tiles it touches.
  void (*draw)(const FrameContext& frame, std::span<const DrawItem> items, Scratch& scratch,
               Canvas& canvas);

  /// Writes tile row `row` of the output from the nearest of all canvases, and clears what they and
  /// the previous frame (whose tiles are `previous`) left there. Returns the tiles that hold
  /// pixels.
  std::uint64_t (*resolve)(std::span<Canvas> canvases, const Packing& packing,
                           std::uint64_t previous, std::size_t row, const Output& output);
};

/// The kernel for a target of simd_target().
[[nodiscard]] Kernel kernel_for(std::int64_t target);

}  // namespace penumbra::cpu
