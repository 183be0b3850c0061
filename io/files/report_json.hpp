// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
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

#include <io/files/disk_file.hpp>
#include <io/files/recording.hpp>
#include <io/files/statistics.hpp>

namespace penumbra::io {

/// The topics and settings that were used for a bag.
struct UsedBag {
  struct Topic {
    std::string role, name, type;
    std::string why;  ///< the reason for the choice
  };
  std::vector<Topic> topics;
  std::string poses;                       ///< "joints", "tf", "both"
  std::string camera_frame, camera_link;   ///< place of the camera
  std::string camera_by;                   ///< source of that place: "tf"
  double time_offset = 0.0;                ///< seconds
  bool first_publisher = false;            ///< publishers of one joint are not compared
  std::string joint_names = {};            ///< RobotInputOptions; empty: the joints'
  std::optional<double> depth_scale = {};  ///< metres per unit; default: the format's
  bool depth_along_ray = false;            ///< not the z-component
};

/// The settings that label clouds.
struct UsedClouds {
  CloudRule rule;
  bool merged = false;
  bool times = true;
};

/// The settings of a run.
struct UsedSettings {
  LabelRule rule;
  bool paper_labels = false;
  BeyondMeans beyond = BeyondMeans::occluded;
  ImageSpace image = ImageSpace::raw;
  RobotOptions robot;
  std::string targets = {};     ///< the targets' file; empty: none
  double target_history = 0.0;  ///< PipelineConfig's, seconds
  std::optional<UsedBag> bag = {};
  std::optional<UsedClouds> clouds = {};  ///< of a sensor of points; without rule, labels and image
};

/// The head of a report.
struct ReportHead {
  std::string input;
  std::optional<RendererInfo> renderer;  ///< of a camera
  UsedSettings settings;
  std::span<const std::string> links;          ///< names, in the order of link images
  std::span<const std::string> missing_links;  ///< not drawn, their geometry could not be read
  std::span<const std::string> notes;          ///< before the frames: Robot::notes()
};

/// The first bytes of every report.
inline constexpr std::string_view report_json_start = "{\"penumbra\": ";

/// Writes report.json (docs/recording.md) frame by frame. Members throw InputError if the file
/// cannot be written.
class ReportWriter {
 public:
  ReportWriter(const std::filesystem::path& file, std::string start);
  void add(std::string_view frame);
  void finish(std::string_view end);

 private:
  OutputFile output_;
  std::string waiting_;
  bool is_first_ = true;
};

/// Return the parts of a report's text: start, frames with "," between them, end. Values that do
/// not apply are null.
[[nodiscard]] std::string report_start(const ReportHead& head);
[[nodiscard]] std::string report_frame(const FrameReport& report);
/// `notes`: all of them.
[[nodiscard]] std::string report_end(const Statistics& statistics,
                                     std::span<const std::string> missing_links,
                                     std::span<const std::string> notes);
/// Returns the end of a report without a summary, while frames are still added.
[[nodiscard]] std::string unfinished_report_end();

/// What `inspect --json` prints: every link, every joint, where packages were found.
[[nodiscard]] std::string robot_json(const Robot& robot);

}  // namespace penumbra::io
