// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/occlusion/labels.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/image_size.hpp>
#include <io/web/frame_archive.hpp>
#include <io/web/frame_store.hpp>

namespace penumbra::io {

/// A report.json, read: by which input and choices a run judged, and what came of it.
struct RunReport {
  std::string input;
  Backend backend = Backend::cpu;
  Tolerance tolerance;
  int front_min_width = 0;
  int fringe_reach = 0;
  bool paper_labels = false;
  ImageSpace image = ImageSpace::raw;
  std::optional<Geometry> geometry;  ///< nothing: links have different ones
  bool geometry_fallback = false;
  std::string targets;  ///< their file; empty: none
  bool has_target_topics = false;
  bool has_missing_links = false;
  std::vector<std::string> links;
  std::vector<std::int64_t> indices;  ///< of the frames
  std::vector<std::string> frames;    ///< as they stand in the report
  std::string start, end;             ///< the report's text around the frames

  /// Throws InputError where the file is no report of a run, or that of another version.
  [[nodiscard]] static RunReport read(const std::filesystem::path& file);
};

/// The results of a run in a folder: what was saved, and of the rest what its input gives when it
/// is judged again. That is shown where it gives what the report says, frame by frame; where not,
/// it is said.
class RunFolder final : public FrameArchive {
 public:
  /// `again`: where the input's frames go as they are judged again; null: the input cannot be had,
  /// and `why` says why not. Must outlive this.
  RunFolder(std::filesystem::path folder, RunReport report, const FrameStore* again,
            std::string why);

  /// Those that files were saved of, and those the input gives.
  [[nodiscard]] std::vector<Part> parts() const;

  /// The next frame was judged again. By one thread, as finish().
  void compare_next();
  /// `why`: why no more frames can be judged; empty: they all were.
  void finish(const std::string& why);

  [[nodiscard]] std::size_t size() const override;
  [[nodiscard]] bool is_complete() const override { return is_complete_; }
  [[nodiscard]] SharedBytes report(std::size_t from) const override;
  [[nodiscard]] std::unique_ptr<PacketFrame> frame(std::size_t i) const override;
  [[nodiscard]] std::vector<std::string> missing() const override;

 private:
  class SavedFrame;
  [[nodiscard]] bool is_saved(Part part) const;
  [[nodiscard]] std::string lacking() const;

  std::filesystem::path folder_;
  RunReport report_;
  const FrameStore* again_;
  std::string why_;
  std::atomic<bool> is_complete_ = false;

  mutable std::mutex mutex_;
  std::vector<bool> agrees_;  // of the frames that were judged again
  std::size_t different_ = 0;
  std::size_t first_different_ = 0;
};

}  // namespace penumbra::io
