// SPDX-License-Identifier: Apache-2.0
#include "../support/nanoseconds.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
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

TEST(SequenceNotes, ARobotInNoFrameIsTold) {
  ASSERT_EQ(notes_of({0, std::nullopt, 0}).size(), 1U);
  EXPECT_NE(notes_of({0, std::nullopt, 0})[0].find("in no frame"), std::string::npos);
  ASSERT_EQ(notes_of({0}).size(), 1U);
  EXPECT_NE(notes_of({0})[0].find("not in the image"), std::string::npos);
}

TEST(SequenceNotes, ARobotInOneFrameOrOfUnknownPoseIsNot) {
  EXPECT_EQ(notes_of({0, 1, 0}), Lines{});
  EXPECT_EQ(notes_of({std::nullopt, std::nullopt}), Lines{})
      << "what is missing there is said elsewhere";
  EXPECT_EQ(notes_of({}), Lines{});
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
  const Lines pose = notes_of_labels({off, off});
  ASSERT_EQ(pose.size(), 1U) << "a pose off by 15 cm";
  EXPECT_NE(pose[0].find("6.8 % are front and 81.1 % beyond"), std::string::npos) << pose[0];
  EXPECT_NE(pose[0].find("camera's pose"), std::string::npos) << pose[0];
  EXPECT_NE(pose[0].find("millimetres"), std::string::npos) << pose[0];
  EXPECT_EQ(notes_of_labels({counts_of(980, 10, 10, 0)}).size(), 1U) << "cm";
  EXPECT_EQ(notes_of_labels({off, good, good, good}), Lines{}) << "one frame is not the sequence";
}

TEST(SequenceNotes, ARobotWithoutMeasurementIsTold) {
  const PixelCounts blind = counts_of(1, 30, 969, 0);
  const Lines lines = notes_of_labels({blind});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("measured on 3.1 % of the robot's pixels"), std::string::npos);
  EXPECT_EQ(notes_of_labels({counts_of(0, 60, 940, 0)}), Lines{});
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::missing_depth), Lines{}) << "said elsewhere";
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::bad_depth), Lines{}) << "likewise";
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::bad_depth, {}, true).size(), 1U)
      << "images came, of which no pixel is measured";
  EXPECT_EQ(notes_of_labels({blind}, FrameStatus::ok, {.has_sensor = false}), Lines{});
}

TEST(SequenceNotes, RawPixelsThatTheLensModelDoesNotReachAreTold) {
  PixelCounts pixels = counts_of(0, 10, 0, 0);
  pixels.uncovered = 38;
  const Lines lines = notes_of_labels({pixels});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("does not reach 38 pixels"), std::string::npos) << lines[0];
  EXPECT_EQ(notes_of_labels({pixels}, FrameStatus::ok, {.image = ImageSpace::rectified}), Lines{})
      << "every rectified image has a rim that the camera did not see";
}

TEST(SequenceNotes, LinksBeforeTheNearPlaneAreTold) {
  const Robot any = robot();
  SequenceNotes notes(any);
  const std::vector<std::size_t> one = {*any.find_link("a")};
  const std::vector<std::size_t> two = {*any.find_link("base"), *any.find_link("a")};
  FrameReport report;
  for (const auto& near : {std::span<const std::size_t>(one), std::span<const std::size_t>(two),
                           std::span<const std::size_t>()}) {
    report.near_links = near;
    notes.add(report, {});
  }
  const std::string why = ": what it hides is labelled as if it were not there";
  EXPECT_EQ(
      notes.lines(),
      (Lines{
          "part of link 'base' lies within 1 cm of the camera and is not drawn in 1 frame" + why,
          "part of link 'a' lies within 1 cm of the camera and is not drawn in 2 frames" + why}));
}

TEST(SequenceNotes, StampsThatDoNotRiseAreTold) {
  EXPECT_EQ(notes_of_stamps({5 * ms, 6 * ms, 7 * ms}), Lines{});
  EXPECT_EQ(notes_of_stamps({std::nullopt, std::nullopt}), Lines{});
  EXPECT_EQ(notes_of_stamps({5 * ms, 5 * ms, 6 * ms}),
            Lines{"1 stamp not after the frame's before, first in frame 11 (5000000 ns after "
                  "5000000 ns): are frames doubled or out of order?"});
  EXPECT_EQ(notes_of_stamps({5 * ms, 9 * ms, std::nullopt, 8 * ms, 7 * ms}),
            Lines{"2 stamps not after the frame's before, first in frame 13 (8000000 ns after "
                  "9000000 ns): are frames doubled or out of order?"})
      << "a frame without a stamp is passed over";
}

TEST(SequenceNotes, StampsOfAnotherUnitAreTold) {
  const auto expect_asked = [](const Lines& lines, const std::string& longest) {
    EXPECT_EQ(lines, Lines{"stamps rise by " + longest +
                           " ns at most from frame to frame: are stamps in nanoseconds?"});
  };
  expect_asked(notes_of_stamps({1700000000'000000, 1700000000'033333, 1700000000'066667}), "33334");
  expect_asked(notes_of_stamps({1700000000'000, std::nullopt, 1700000000'033}), "33");
  expect_asked(notes_of_stamps({1700000000, 1700000001}), "1");
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
  EXPECT_EQ(lines[1],
            "stamps went back by more than a second in 1 frame with targets: what was known of "
            "them until then was forgotten");
  EXPECT_EQ(lines[2],
            "targets that want handling in 2 frames without a stamp: none is handled there");
}

TEST(SequenceNotes, JointsBeyondTheirLimitsAreTold) {
  EXPECT_EQ(notes_of_positions({{1.57, 0.025, 1000.0, 3.0}, {-1.579, 0.0025, -1000.0, 0.0}, {}}),
            Lines{})
      << "rounded limits, joints without any, frames without positions";
  EXPECT_EQ(notes_of_positions({{90.0, 0.01, 0.0, 0.0}, {1.6, 0.01, 0.0, 0.0}, {0, 0.01, 0, 0}}),
            Lines{"joint 'turn' beyond its limits in 2 frames: are the positions in radians and "
                  "metres?"});
  EXPECT_EQ(notes_of_positions({{0.0, 0.03, 0.0, 0.0}}),
            Lines{"joint 'follower' beyond its limits in 1 frame: are the positions in radians and "
                  "metres?"})
      << "4 x 0.03 - 0.01 = 0.11";
  EXPECT_EQ(notes_of_positions({{-1.59, 0.042, 0.0, 0.0}}),
            Lines{"joint 'turn' beyond its limits in 1 frame, joint 'slide' beyond its limits in 1 "
                  "frame, joint 'follower' beyond its limits in 1 frame: are the positions in "
                  "radians and metres?"});
}

}  // namespace
}  // namespace penumbra::io
