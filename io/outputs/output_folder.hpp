// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/pipeline/without_robot.hpp>

#include <io/files/background_jobs.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/files/result_folder.hpp>
#include <io/files/sink.hpp>
#include <io/web/key_frames.hpp>

namespace penumbra::io {

/// The images that `run` writes next to the report.
struct Saves {
  bool vdi = false, labels = false, links = false, robot_mask = false, overlay = false,
       filtered = false, points = false;
  bool operator==(const Saves&) const = default;
};

/// The place of the results, and their kinds.
struct OutputOptions {
  std::filesystem::path path;  ///< a folder, or a bag: *.mcap
  // For folders:
  Saves saves;
  std::string points_frame;  ///< link of the points' frame; empty: the optical frame
  bool report_page = false;  ///< also write report.html
  bool force = false;        ///< also into a folder with other files
  int threads = 0;           ///< for writing images; 0: one per core
};

/// Returns what a run's folder holds.
[[nodiscard]] ResultFolderOptions run_results(const OutputOptions& options);

/// The results of `run` in its folder. Images are named by the frame's index: vdi/000000.npy,
/// labels/000000.png.
class OutputFolder final : public Sink {
 public:
  /// Begins `folder`, which is of run_results(`options`). `pipeline`: of the frames. Both must
  /// outlive this. Throws InputError if the folder cannot be used.
  OutputFolder(const OutputOptions& options, ResultFolder& folder, const Pipeline& pipeline);

  void begin(const ReportHead& head) override;

  /// Writes the frame's images on other threads. Without the robot's pose there is no VDI and no
  /// link image, and all labels are unknown. Throws InputError if writing images fails.
  void take(const Frame& frame, const FrameReport& report) override;
  void finish(const Statistics& statistics, std::span<const std::string> notes) override;

 private:
  [[nodiscard]] std::string add_page();
  template <typename T, typename Write>
  void write_later(std::filesystem::path file, ImageView<const T> image, Write write);
  void save_without_robot(const Frame& frame, const FrameReport& report);

  OutputOptions options_;
  ResultFolder& folder_;
  Camera camera_;  // of the report's images
  DepthImage filtered_;
  std::optional<CloudMaker> cloud_maker_;  // made with the first points
  OverlayPainter painter_;
  KeyFrames key_frames_;
  std::filesystem::path report_file_;  // unfinished
  std::optional<ReportWriter> report_;
  std::vector<std::string> missing_links_, notes_;  // of the head
  BackgroundJobs writers_;                          // the first to end
};

/// Throws InputError if results would replace the input, or what is no result.
void check_output_place(const std::filesystem::path& input, const std::filesystem::path& output);

/// Returns whether this is the name of a bag.
[[nodiscard]] bool is_output_bag(const std::filesystem::path& output);

}  // namespace penumbra::io
