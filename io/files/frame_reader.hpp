// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/joint_file.hpp>
#include <io/files/png.hpp>
#include <io/files/recording.hpp>

namespace penumbra::io {

/// One recorded frame. Buffers are reused from frame to frame.
struct FrameData {
  std::int64_t index = 0;
  std::optional<std::int64_t> stamp;     ///< nanoseconds
  FrameStatus status = FrameStatus::ok;  ///< or missing_joints, missing_depth, bad_depth
  std::string message;                   ///< one line that names the file; empty if ok
  std::vector<double> positions;         ///< order of Robot::variables(); empty if missing_joints
  std::variant<Image<std::uint16_t>, Image<float>> depth;  ///< valid unless missing or bad
  Image<Rgb8> color;          ///< empty where not asked for, not recorded or not usable
  std::string color_message;  ///< why a recorded colour image is not usable; empty if it is

  [[nodiscard]] DepthView depth_view() const;
};

/// Reads a recording's frames. Faults of a frame's data are told in its status, never thrown.
class FrameReader {
 public:
  /// Reads the joint file and looks which depth images there are. Keeps neither argument. Throws
  /// InputError as read_joint_file and FramePattern::existing do.
  FrameReader(const Recording& recording, const Robot& robot);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::int64_t index(std::size_t i) const { return rows_[i].index; }

  /// Reads the i-th frame in the order of the joint file; depth images without a row there are
  /// frames too, of status missing_joints, before the first row of a later frame. The depth image
  /// is read even where the joints are missing, so that a picture can be shown; colour only if
  /// asked for. May be called from several threads, each with its own FrameData.
  void read(std::size_t i, bool with_color, FrameData& frame) const;

 private:
  ImageSize size_;
  RecordingFrames files_;
  std::vector<JointRow> rows_;
};

}  // namespace penumbra::io
