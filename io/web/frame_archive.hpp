// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <io/web/packet.hpp>

namespace penumbra::io {

/// Frames that were judged, or are being: those there are can be read meanwhile, by any thread.
class FrameArchive {
 public:
  FrameArchive() = default;
  FrameArchive(const FrameArchive&) = delete;
  FrameArchive& operator=(const FrameArchive&) = delete;
  virtual ~FrameArchive() = default;

  /// Frames so far.
  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual bool is_complete() const = 0;
  /// report.json so far, of its frames those from the given one on.
  [[nodiscard]] virtual SharedBytes report(std::size_t from) const = 0;
  /// The i-th in the report's order; null: there is none (yet). This must outlive it.
  [[nodiscard]] virtual std::unique_ptr<PacketFrame> frame(std::size_t i) const = 0;
  /// What cannot be shown and which command gives it, a sentence each.
  [[nodiscard]] virtual std::vector<std::string> missing() const = 0;
};

}  // namespace penumbra::io
