// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <penumbra/pipeline/frame.hpp>

namespace penumbra {

/// What is doubtful of a sequence of frames though each of them may be ok.
class SequenceNotes {
 public:
  void add(const FrameReport& report);

  /// A line each: a robot that is in no frame whose pose is known.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  std::size_t posed_frames_ = 0;
  bool robot_seen_ = false;
};

}  // namespace penumbra
