// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include <epoxy/gl.h>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_calls.hpp>
#include <penumbra/render/gl/readback.hpp>

namespace penumbra::gl {
namespace {

/// Returns the pixels from a row of an image in memory to the next: rows start on cache lines.
std::size_t row_stride(int width) {
  constexpr std::size_t alignment = 64;
  return (static_cast<std::size_t>(width) + alignment - 1) / alignment * alignment;
}

/// Submits all earlier calls. Returns a fence that is signalled when the device has done them.
GLsync make_fence() {
  const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (fence == nullptr) {
    throw DeviceError("OpenGL: the frame cannot be waited for (" + take_error() + ")");
  }
  glFlush();
  return fence;
}

/// Waits for a fence, deletes it and makes it null; does not wait for null. Throws DeviceError if
/// the fence is not signalled or the context fails.
void wait_for(void*& fence) {
  if (fence == nullptr) return check_frame();
  constexpr GLuint64 patience = 60'000'000'000;  // ns; drivers reset what hangs much sooner
  auto* const sync = static_cast<GLsync>(std::exchange(fence, nullptr));
  const GLenum result = glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, patience);
  glDeleteSync(sync);
  check_frame();
  if (result != GL_ALREADY_SIGNALED && result != GL_CONDITION_SATISFIED) {
    throw DeviceError("OpenGL: a frame was not done in 60 s");
  }
}

}  // namespace

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
