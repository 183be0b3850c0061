// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/pipeline/sequence_notes.hpp>

namespace penumbra::test {
namespace {

/// The notes of frames that show so many pixels of the robot; nothing: pose unknown.
std::vector<std::string> notes_of(const std::vector<std::optional<std::size_t>>& frames) {
  SequenceNotes notes;
  for (const auto& robot : frames) {
    FrameReport report;
    report.pixels.robot = robot;
    notes.add(report);
  }
  return notes.lines();
}

TEST(SequenceNotes, ARobotInNoFrameIsTold) {
  ASSERT_EQ(notes_of({0, std::nullopt, 0}).size(), 1U);
  EXPECT_NE(notes_of({0, std::nullopt, 0})[0].find("in no frame"), std::string::npos);
  ASSERT_EQ(notes_of({0}).size(), 1U);
  EXPECT_NE(notes_of({0})[0].find("not in the image"), std::string::npos);
}

TEST(SequenceNotes, ARobotInOneFrameOrOfUnknownPoseIsNot) {
  EXPECT_EQ(notes_of({0, 1, 0}), std::vector<std::string>{});
  EXPECT_EQ(notes_of({std::nullopt, std::nullopt}), std::vector<std::string>{})
      << "what is missing there is said elsewhere";
  EXPECT_EQ(notes_of({}), std::vector<std::string>{});
}

}  // namespace
}  // namespace penumbra::test
