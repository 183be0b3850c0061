// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/without_robot.hpp>

#include <apps/penumbra/arguments.hpp>
#include <apps/penumbra/run_output.hpp>
#include <io/files/file_lock.hpp>
#include <io/files/overlay_painter.hpp>
#include <io/web/key_frames.hpp>

namespace penumbra::app {

/// Digits of a frame's index in file names, at least.
inline constexpr std::size_t frame_digits = 6;

/// Throws InputError unless the output folder is missing, empty, holds the report of an earlier
/// run, or the user forces it. Touches nothing.
void check_output_folder(const RunArguments& arguments);

/// Where `run` writes. Files are named by the frame's index: vdi/000000.npy, labels/000000.png.
class OutputFolder final : public RunOutput {
 public:
  /// Makes the folder and those of the images to save, and removes an earlier run's report, page
  /// and images. `rectification` brings recorded images to the report's; null where they fit, else
  /// it must outlive this. Throws InputError if the folder cannot be used or another run writes to
  /// it.
  OutputFolder(const std::filesystem::path& folder, const RunArguments& arguments,
               const Rectification* rectification);

  /// Removes this run's images, unless it was finished.
  ~OutputFolder() override;
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  void begin(const io::ReportHead& head) override;

  /// Writes the frame's images. Where the robot's pose is unknown there is no VDI and no link
  /// image, and all labels are unknown. Throws InputError where writing fails.
  void save(const FrameReport& report, const io::FrameData& frame,
            const io::ShownTargets& targets) override;
  void finish(const Statistics& statistics, std::span<const std::string> notes) override;
  [[nodiscard]] std::string where() const override { return "report: " + report_file().string(); }

 private:
  void write_page() const;
  void save_without_robot(const FrameReport& report, const io::FrameData& frame,
                          const Camera& camera);
  [[nodiscard]] std::filesystem::path report_file() const { return folder_ / "report.json"; }
  [[nodiscard]] std::filesystem::path file(const char* kind, std::size_t index,
                                           const char* ending) const;

  std::filesystem::path folder_;
  io::FileLock lock_;
  Saves saves_;
  bool has_page_;
  std::string points_frame_;
  DepthImage filtered_;
  Image<std::uint16_t> millimetres_;
  std::optional<CloudMaker> cloud_maker_;  // made with the first points
  PointCloud cloud_;
  io::OverlayPainter painter_;
  io::KeyFrames key_frames_;
  std::vector<std::size_t> saved_;  // frames whose images may be written
  bool finished_ = false;
  std::optional<io::ReportWriter> report_;
};

}  // namespace penumbra::app
