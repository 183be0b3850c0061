// SPDX-License-Identifier: Apache-2.0
// Messages as bytes, and back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/camera/camera.hpp>

#include <io/ros/message_decoder.hpp>
#include <io/ros/message_encoder.hpp>

namespace penumbra::test {

template <typename M>
std::vector<std::byte> encoded(const M& message) {
  std::vector<std::byte> payload;
  io::encode(message, payload);
  return payload;
}

template <typename M>
M decoded(std::span<const std::byte> payload) {
  M message;
  const auto fault = io::Decoder<M>().decode(payload, message);
  EXPECT_FALSE(fault) << *fault;
  return message;
}

/// Returns what the driver of a camera without distortion publishes.
inline io::CameraInfoMessage camera_info_of(const Intrinsics& of, const io::MessageHeader& header) {
  return {.header = header,
          .height = static_cast<std::uint32_t>(of.height()),
          .width = static_cast<std::uint32_t>(of.width()),
          .distortion_model = "plumb_bob",
          .d = {0, 0, 0, 0, 0},
          .k = {of.fx(), 0, of.cx(), 0, of.fy(), of.cy(), 0, 0, 1},
          .r = {1, 0, 0, 0, 1, 0, 0, 0, 1},
          .p = {of.fx(), 0, of.cx(), 0, 0, of.fy(), of.cy(), 0, 0, 0, 1, 0}};
}

}  // namespace penumbra::test
