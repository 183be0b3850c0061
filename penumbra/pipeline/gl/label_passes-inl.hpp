// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/occlusion/label_work-inl.hpp>
#include <penumbra/pipeline/gl/gl_labeller.hpp>
#include <penumbra/render/gl/buffer.hpp>
#include <penumbra/render/gl/pixel_rectangle.hpp>

namespace penumbra::gl {

/// The labelling of frames by compute shaders, and a ring of memory for what comes back. All calls
/// need the context that it was made in; its OpenGL objects die with that.
class LabelPasses {
 public:
  static constexpr std::size_t slots = GlLabeller::max_pending;

  /// Throws InputError where the images are larger than the device takes.
  LabelPasses(int width, int height, const LabelRule& rule);

  /// Labels `measured` by the virtual depth in texture `depth`, all of which lies in `seen`.
  void start(std::size_t slot, unsigned depth, const PixelRectangle& seen,
             const DepthView& measured, std::span<const PixelRectangle> boxes);

  /// Waits until the slot's labels are complete. Throws DeviceError where they never will
  /// be.
  [[nodiscard]] DeviceLabels wait(std::size_t slot);

 private:
  using Counts = std::array<std::uint32_t, label_count>;
  using Box = std::array<std::int32_t, 4>;

  /// As the shaders' uniform block has it.
  struct Parameters {
    Box window, seen, cell_window;
    std::array<std::int32_t, 2> size;
    std::int32_t millimetres, min_width;
    std::array<float, 4> tolerance_beyond;
    std::array<std::uint32_t, 2> measured;
    std::int32_t cells, unused;
  };
  static_assert(sizeof(Parameters) == 96);

  // What a frame shares with the device, in bytes: its parameters, its counts, its boxes.
  static constexpr std::size_t count_room = 1 + GlLabeller::max_boxes;  // the image's are first
  static constexpr std::size_t counts_at = aligned(sizeof(Parameters));
  static constexpr std::size_t boxes_at = counts_at + aligned(count_room * sizeof(Counts));
  static constexpr std::size_t shared_size =
      boxes_at + aligned(GlLabeller::max_boxes * sizeof(Box));

  /// What the shader of this name takes.
  struct Spread {
    int step_u, step_v, first, last;
    unsigned wanted, given, needed;
    bool all;
  };
  class Marks;

  struct Slot {
    PixelRectangle rectangle;  // outside of it all labels are clear
    TileMask touched;
    void* fence = nullptr;
    std::byte* shared = nullptr;  // mapped; written and read by copies alone
    Parameters parameters{};
    std::array<Counts, count_room> counts{};
    std::uint8_t* labels = nullptr;
    std::vector<std::array<std::size_t, label_count>> boxes;  // max_boxes of them
    std::vector<PixelRectangle> asked;
  };

  void make_images();
  void make_buffers();
  void make_programs();
  void set_parameters(Slot& slot, bool millimetres) const;
  void upload(const Box& window, const DepthView& measured) const;
  void run(const Slot& slot) const;
  void clean_up(const Parameters& p) const;
  void spread(Marks& marks, const Box& window, const Spread& spread) const;
  void fetch(std::size_t index, const Slot& slot) const;

  int width_, height_;
  labelling::Rule rule_;
  std::size_t stride_;  // of the labels that come back
  unsigned labels_ = 0, sensor_millimetres_ = 0, sensor_metres_ = 0;
  std::array<unsigned, 2> marks_{}, cells_{};
  unsigned counts_ = 0, shared_buffer_ = 0, label_buffer_ = 0;
  unsigned label_ = 0, cell_ = 0, nearest_ = 0, certain_ = 0, solid_ = 0, spread_ = 0, finish_ = 0,
           box_ = 0;  // programs
  std::array<Slot, slots> slots_;
};

}  // namespace penumbra::gl
