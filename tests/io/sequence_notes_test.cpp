// SPDX-License-Identifier: Apache-2.0
#include "../support/errors.hpp"
#include "../support/nanoseconds.hpp"

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <io/files/sequence_notes.hpp>

namespace penumbra::io {
namespace {

using test::ms;
using Lines = std::vector<std::string>;

constexpr const char* urdf = R"(<robot name="limits">
  <link name="base"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
    <limit lower="-1.57" upper="1.57" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.04" effort="1" velocity="1"/></joint>
  <joint name="follower" type="prismatic"><parent link="base"/><child link="c"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/>
    <mimic joint="slide" multiplier="4" offset="-0.01"/></joint>
  <joint name="wheel" type="continuous"><parent link="base"/><child link="d"/><axis xyz="0 0 1"/>
  </joint>
  <joint name="bare" type="revolute"><parent link="base"/><child link="e"/><axis xyz="0 0 1"/>
    <limit effort="1" velocity="1"/></joint>
</robot>)";

Robot robot() { return Robot::parse(urdf, ".", {.geometry = Geometry::visual}); }

/// The notes of frames that show so many pixels of the robot; nothing: pose unknown.
Lines notes_of(const std::vector<std::optional<std::size_t>>& frames) {
  const Robot any = robot();
  SequenceNotes notes(any);
  for (const auto& pixels : frames) {
    FrameReport report;
    report.pixels.robot = pixels;
    notes.add(report, {});
  }
  return notes.lines();
}

/// The notes of frames with such stamps, the first of index 10.
Lines notes_of_stamps(const std::vector<std::optional<std::int64_t>>& stamps) {
  const Robot any = robot();
  SequenceNotes notes(any);
  FrameReport report;
  report.index = 10;
  for (const auto& stamp : stamps) {
    report.stamp = stamp;
    notes.add(report, {});
    ++report.index;
  }
  return notes.lines();
}

/// The notes of frames with such positions of turn, slide, wheel and bare.
Lines notes_of_positions(const std::vector<std::vector<double>>& frames) {
  const Robot any = robot();
  SequenceNotes notes(any);
  for (const auto& given : frames) {
    std::vector<double> positions(given.size());
    const char* const names[] = {"turn", "slide", "wheel", "bare"};
    for (std::size_t i = 0; i < given.size(); ++i)
      positions[any.find_variable(names[i]).value()] = given[i];
    notes.add({}, positions);
  }
  return notes.lines();
}

/// Expects one note with these parts.
void expect_note(const Lines& lines, std::initializer_list<std::string_view> parts) {
  ASSERT_EQ(lines.size(), 1U);
  for (const std::string_view part : parts) EXPECT_TRUE(test::holds(lines[0], part));
}

TEST(SequenceNotes, ARobotInNoFrameIsTold) {
  expect_note(notes_of({0, std::nullopt, 0}), {"in no frame"});
  expect_note(notes_of({0}), {"not in the image"});
  EXPECT_EQ(notes_of({0, 1, 0}), Lines{});
  EXPECT_EQ(notes_of({std::nullopt}), Lines{}) << "what is missing there is said elsewhere";
}

/// The notes of frames that are labelled so.
Lines notes_of_labels(const std::vector<PixelCounts>& frames, FrameStatus status = FrameStatus::ok,
                      const SequenceNotes::Source& source = {}, bool nothing_measured = false) {
  const Robot any = robot();
  SequenceNotes notes(any, source);
  for (const PixelCounts& pixels : frames) {
    FrameReport report;
    report.status = status;
    report.nothing_measured = nothing_measured;
    report.pixels = pixels;
    notes.add(report, {});
  }
  return notes.lines();
}

PixelCounts counts_of(std::size_t front, std::size_t occluded, std::size_t unknown,
                      std::size_t beyond) {
  PixelCounts pixels;
  pixels.robot = front + occluded + unknown + beyond;
  pixels.front = front;
  pixels.occluded = occluded;
  pixels.unknown = unknown;
  pixels.beyond = beyond;
  return pixels;
}

TEST(SequenceNotes, APoseOrDepthThatFitsNowhereIsAsked) {
  const PixelCounts good = counts_of(200, 600, 100, 100);
  EXPECT_EQ(notes_of_labels({good, good}), Lines{});
  const PixelCounts off = counts_of(50, 90, 260, 600);
  // A pose off by 15 cm.
  expect_note(notes_of_labels({off, off}),
              {"6.8 % are front", "81.1 % beyond", "camera's pose", "millimetres"});
  EXPECT_EQ(notes_of_labels({counts_of(980, 10, 10, 0)}).size(), 1U) << "cm";
  EXPECT_EQ(notes_of_labels({off, good, good, good}), Lines{}) << "one frame is not the sequence";
}

TEST(SequenceNotes, ARobotWithoutMeasurementIsTold) {
  const PixelCounts blind = counts_of(1, 30, 969, 0);
  expect_note(notes_of_labels({blind}), {"3.1 %"});
  EXPECT_EQ(notes_of_labels({counts_of(0, 60, 940, 0)}), Lines{});
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::missing_depth), Lines{}) << "said elsewhere";
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::bad_depth), Lines{}) << "likewise";
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::bad_depth, {}, true).size(), 1U)
      << "images came, of which no pixel is measured";
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::ok, {.has_sensor = false}), Lines{});
}

TEST(SequenceNotes, StampsThatDoNotRiseAreTold) {
  EXPECT_EQ(notes_of_stamps({5 * ms, 6 * ms, 7 * ms}), Lines{});
  EXPECT_EQ(notes_of_stamps({std::nullopt, std::nullopt}), Lines{});
  expect_note(notes_of_stamps({5 * ms, 5 * ms, 6 * ms}), {"1 stamp ", "frame 11", "5000000 ns"});
  // A frame without a stamp is passed over.
  expect_note(notes_of_stamps({5 * ms, 9 * ms, std::nullopt, 8 * ms, 7 * ms}),
              {"2 stamps ", "frame 13", "8000000 ns", "9000000 ns"});
}

TEST(SequenceNotes, StampsOfAnotherUnitAreTold) {
  expect_note(notes_of_stamps({1700000000'000000, 1700000000'033333, 1700000000'066667}),
              {"33334 ns", "nanoseconds"});
  expect_note(notes_of_stamps({1700000000'000, std::nullopt, 1700000000'033}), {"33 ns"});
  expect_note(notes_of_stamps({1700000000, 1700000001}), {"1 ns"});
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ(notes_of_stamps({least, std::numeric_limits<std::int64_t>::max()}), Lines{});
  EXPECT_EQ(notes_of_stamps({5, 5 + ms, 6 + ms}), Lines{}) << "not throughout";
  EXPECT_EQ(notes_of_stamps({5}), Lines{});
  EXPECT_EQ(notes_of_stamps({5, 5}).size(), 1U) << "of frames that are doubled alone";
  EXPECT_EQ(notes_of_stamps({5, 5, 6}).size(), 2U);
}

TEST(SequenceNotes, TargetsThatAreForgottenOrNotHandledAreTold) {
  const Robot any = robot();
  SequenceNotes notes(any);
  const std::vector<TargetReport> plain(1);
  std::vector<TargetReport> waiting(2);
  waiting[1].wants_stamp = true;
  FrameReport report;
  for (const std::int64_t stamp : {5, 4, 6, 6, 2}) {
    report.stamp = stamp * 1001 * ms;
    report.targets = stamp == 2 ? std::span<const TargetReport>() : plain;
    notes.add(report, {});
  }
  report.stamp.reset();
  report.targets = waiting;
  notes.add(report, {});
  notes.add(report, {});
  const Lines lines = notes.lines();
  ASSERT_EQ(lines.size(), 3U);
  for (const char* part : {"1 frame", "forgotten"}) EXPECT_TRUE(test::holds(lines[1], part));
  for (const char* part : {"2 frames", "handle"}) EXPECT_TRUE(test::holds(lines[2], part));
}

TEST(SequenceNotes, JointsBeyondTheirLimitsAreTold) {
  EXPECT_EQ(notes_of_positions({{1.57, 0.025, 1000.0, 3.0}, {-1.579, 0.0025, -1000.0, 0.0}, {}}),
            Lines{})
      << "rounded limits, joints without any, frames without positions";
  expect_note(notes_of_positions({{90.0, 0.01, 0.0, 0.0}, {1.6, 0.01, 0.0, 0.0}, {0, 0.01, 0, 0}}),
              {"'turn'", "2 frames", "radians"});
  // The follower is at 4 x 0.03 - 0.01 = 0.11.
  expect_note(notes_of_positions({{0.0, 0.03, 0.0, 0.0}}), {"'follower'", "1 frame"});
  expect_note(notes_of_positions({{-1.59, 0.042, 0.0, 0.0}}), {"'turn'", "'slide'", "'follower'"});
}

}  // namespace
}  // namespace penumbra::io
