// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <span>

#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/sink.hpp>
#include <io/web/packet.hpp>
#include <io/web/pose_outlines.hpp>
#include <io/web/spool_file.hpp>

namespace penumbra::io {

/// Keeps frames as they are judged, or scans: the report in memory, the images compressed in a
/// temporary file, so that recordings may be longer than the memory, and bags can be shown in any
/// order.
class FrameStore final : public FrameArchive, public Sink {
 public:
  /// `pipeline`: of the frames; it must outlive this. Throws InputError if no temporary file can be
  /// made.
  FrameStore(const Pipeline& pipeline, const ReportHead& head);

  // By one thread; take() throws InputError where the disk is full.
  void take(const Frame& frame, const FrameReport& report) override;
  void finish(const Statistics& statistics, std::span<const std::string> notes) override;

  /// Shows the outlines of a calibration of the camera of the report's images, too. Both must
  /// outlive this. Call it before take().
  void outline(PoseOutlines& outlines, const RunningCalibration& calibration) {
    outlines_ = &outlines;
    calibration_ = &calibration;
  }

  // Any thread may call these.
  [[nodiscard]] std::size_t size() const override;
  [[nodiscard]] bool is_complete() const override;
  [[nodiscard]] SharedBytes report(std::size_t from) const override;
  [[nodiscard]] std::optional<PacketFrame> frame(std::size_t i) const override;
  [[nodiscard]] std::vector<std::string> missing() const override;

 private:
  /// The position, type and size of an image.
  struct Kept {
    SpoolPlace place;
    const char* type = nullptr;  // null: no image
    int width = 0, height = 0;
  };
  struct Entry {
    std::size_t report_offset = 0, report_size = 0;  // in text_
    SpoolPlace poses;
    std::array<Kept, part_count> parts;
    RobotPose pose;  // with outlines
  };

  template <typename T>
  [[nodiscard]] Kept keep(ImageView<const T> image, const char* type);
  [[nodiscard]] Kept keep_depth(const DepthView& depth);
  [[nodiscard]] Kept keep_color(const Frame& frame);
  void add_points(const FrameReport& report, const Scan& scan, Entry& entry);
  void add_images(const FrameReport& report, const Frame& frame, Entry& entry);
  void add(Entry entry, const std::string& text);

  const Pipeline& pipeline_;
  PoseOutlines* outlines_ = nullptr;
  const RunningCalibration* calibration_ = nullptr;
  TargetOverlay target_overlay_;
  SpoolFile spool_;
  std::vector<std::string> missing_links_, notes_;

  // Used by the adding thread only.
  Image<Rgb8> color_;
  Image<float> metres_, rectified_;
  std::vector<std::byte> file_;
  std::string pixels_;

  mutable std::mutex mutex_;
  std::string text_;           // the report so far
  std::size_t head_size_ = 0;  // size of its part before the frames
  std::string end_;            // end of the report; empty until it is known
  std::vector<Entry> entries_;
  std::size_t without_color_ = 0;
  std::string first_without_color_;
};

}  // namespace penumbra::io
