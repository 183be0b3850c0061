// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string>

#include <epoxy/gl.h>

#include <penumbra/render/gl/buffer.hpp>
#include <penumbra/render/gl/gl_check.hpp>
#include <penumbra/render/gl/readback.hpp>

namespace penumbra::gl {

Readback::Readback(const Intrinsics& intrinsics)
    : width_(intrinsics.width()), height_(intrinsics.height()), stride_(row_stride(width_)) {
  const std::size_t pixels = stride_ * static_cast<std::size_t>(height_);
  const std::size_t slot_bytes = pixels * (sizeof(float) + sizeof(std::uint16_t));
  constexpr GLbitfield access = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT |
                                GL_MAP_COHERENT_BIT | GL_CLIENT_STORAGE_BIT;
  const std::string what = std::to_string(slots) + " images of " + std::to_string(width_) + " x " +
                           std::to_string(height_) + " pixels";
  const GLuint buffer = make_buffer(slots * slot_bytes, nullptr, access, what, &data_);
  std::fill_n(data_, slots * slot_bytes, std::byte{0});
  for (std::size_t i = 0; i < slots; ++i) {
    slots_[i].touched = TileMask(width_, height_);
    slots_[i].depth = reinterpret_cast<float*>(data_ + i * slot_bytes);
    slots_[i].links = reinterpret_cast<std::uint16_t*>(slots_[i].depth + pixels);
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(stride_));
}

void Readback::start(std::size_t index, const PixelRectangle& r) {
  Slot& slot = slots_[index];
  for_each_outside(slot.rectangle, r, [&](const PixelRectangle& old) { clear(slot, old); });
  slot.rectangle = r;
  std::fill(slot.touched.rows.begin(), slot.touched.rows.end(), std::uint64_t{0});
  if (r.empty()) return;
  slot.touched.mark(r.u0, r.v0, r.u1 - 1, r.v1 - 1);
  const std::size_t first =
      static_cast<std::size_t>(r.v0) * stride_ + static_cast<std::size_t>(r.u0);
  const auto offset = [&](const auto* pixel) {
    return as_address(static_cast<std::size_t>(reinterpret_cast<const std::byte*>(pixel) - data_));
  };
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(r.u0, r.v0, r.width(), r.height(), GL_RED, GL_FLOAT, offset(slot.depth + first));
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glReadPixels(r.u0, r.v0, r.width(), r.height(), GL_RED_INTEGER, GL_UNSIGNED_SHORT,
               offset(slot.links + first));
  slot.fence = make_fence();
}

VirtualDepthView Readback::wait(std::size_t index) {
  Slot& slot = slots_[index];
  wait_for(slot.fence);
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  return {
      {slot.depth, width_, height_, stride}, {slot.links, width_, height_, stride}, &slot.touched};
}

void Readback::clear(Slot& slot, const PixelRectangle& r) const {
  for (int v = r.v0; v < r.v1; ++v) {
    const std::size_t first =
        static_cast<std::size_t>(v) * stride_ + static_cast<std::size_t>(r.u0);
    std::fill_n(slot.depth + first, r.width(), 0.0F);
    std::fill_n(slot.links + first, r.width(), std::uint16_t{0});
  }
}

}  // namespace penumbra::gl
