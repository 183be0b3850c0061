// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/recording.hpp>
#include <io/files/statistics.hpp>

namespace penumbra::io {

/// What was taken of a bag.
struct UsedBag {
  struct Topic {
    std::string role, name, type;
    std::string why;  ///< it was taken, in words
  };
  std::vector<Topic> topics;
  std::string poses;                      ///< "joints", "tf", "both"
  std::string camera_frame, camera_link;  ///< where the camera sits
  std::string camera_by;                  ///< who says so: "tf"
  double time_offset = 0.0;               ///< seconds
  bool first_publisher = false;           ///< publishers of one joint are not compared
};

/// By which choices results were made.
struct UsedSettings {
  LabelRule rule;
  bool paper_labels = false;
  BeyondMeans beyond = BeyondMeans::occluded;
  ImageSpace image = ImageSpace::raw;
  RobotOptions robot;
  std::string targets = {};     ///< the targets' file; empty: none
  double target_history = 0.0;  ///< PipelineConfig's, seconds
  std::optional<UsedBag> bag = {};
};

/// What a report says before its frames.
struct ReportHead {
  std::string input;
  RendererInfo renderer;
  UsedSettings settings;
  std::span<const std::string> links;          ///< names, in the order of link images
  std::span<const std::string> missing_links;  ///< not drawn, their geometry could not be read
  std::span<const std::string> notes;          ///< before the frames: Robot::notes()
};

/// How every report begins.
inline constexpr std::string_view report_json_start = "{\"penumbra\": ";

/// Writes report.json (DESIGN section 4) frame by frame; what does not apply is null. It is
/// a PendingFile. Members throw InputError where the file cannot be written.
class ReportWriter {
 public:
  ReportWriter(const std::filesystem::path& file, const ReportHead& head);
  ~ReportWriter();
  ReportWriter(const ReportWriter&) = delete;
  ReportWriter& operator=(const ReportWriter&) = delete;

  void add(const FrameReport& report);

  /// `notes`: what the frames as a whole gave rise to; follow the head's.
  void finish(const Statistics& statistics, std::span<const std::string> notes = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The parts of a report's text: start, frames with "," between them, end.
[[nodiscard]] std::string report_start(const ReportHead& head);
[[nodiscard]] std::string report_frame(const FrameReport& report);
/// `notes`: all of them.
[[nodiscard]] std::string report_end(const Statistics& statistics,
                                     std::span<const std::string> missing_links,
                                     std::span<const std::string> notes);
/// Of a report whose frames are not all there yet: its summary is null.
[[nodiscard]] std::string unfinished_report_end();

/// What `render --json` prints.
struct RenderResult {
  std::size_t triangles = 0;
  std::size_t robot_pixels = 0;
  std::size_t uncovered_pixels = 0;  ///< PixelCounts::uncovered
  RendererInfo renderer;
  std::span<const std::string> variables;      ///< names of the joint positions
  std::span<const double> positions;           ///< in their order, rad and m
  std::span<const std::string> missing_links;  ///< as in ReportHead
  std::span<const std::string> notes;          ///< likewise
  Statistics statistics;                       ///< timings of the repeats
};

[[nodiscard]] std::string render_json(const RenderResult& result);

/// What `inspect --json` prints: every link, every joint, where packages were found.
[[nodiscard]] std::string robot_json(const Robot& robot);

}  // namespace penumbra::io
