// SPDX-License-Identifier: Apache-2.0
#include <penumbra/pipeline/sequence_notes.hpp>

namespace penumbra {

void SequenceNotes::add(const FrameReport& report) {
  if (!report.pixels.robot) return;
  ++posed_frames_;
  robot_seen_ = robot_seen_ || *report.pixels.robot > 0;
}

std::vector<std::string> SequenceNotes::lines() const {
  std::vector<std::string> lines;
  if (posed_frames_ > 0 && !robot_seen_)
    lines.push_back(std::string("the robot is ") +
                    (posed_frames_ == 1 ? "not in the image" : "in no frame") +
                    ": is the camera's pose that of the camera in its parent link's frame (not "
                    "the inverse), in metres?");
  return lines;
}

}  // namespace penumbra
