// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <io/web/packet.hpp>

namespace penumbra::io {

/// An archive of judged frames, which may still grow. Any thread may read the frames meanwhile.
class FrameArchive {
 public:
  FrameArchive() = default;
  FrameArchive(const FrameArchive&) = delete;
  FrameArchive& operator=(const FrameArchive&) = delete;
  virtual ~FrameArchive() = default;

  /// Returns the number of frames so far.
  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual bool is_complete() const = 0;
  /// Returns report.json so far, with the frames from index `from` on.
  [[nodiscard]] virtual SharedBytes report(std::size_t from) const = 0;
  /// Returns frame i in the report's order, or null if it does not exist (yet). This must outlive
  /// the frame.
  [[nodiscard]] virtual std::unique_ptr<PacketFrame> frame(std::size_t i) const = 0;
  /// Returns what cannot be shown and the command that provides it, one sentence each.
  [[nodiscard]] virtual std::vector<std::string> missing() const = 0;
};

}  // namespace penumbra::io
