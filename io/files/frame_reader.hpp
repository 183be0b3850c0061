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

/// One frame of a recording or bag. Its buffers can be reused for the next. A bag's frame has no
/// positions, and depth and colour only if pictures are wanted.
struct FrameData {
  std::int64_t index = 0;
  std::optional<std::int64_t> stamp;  ///< nanoseconds
  FrameStatus status =
      FrameStatus::ok;            ///< a recording's: missing_joints, missing_depth, bad_depth
  std::string message;            ///< one line that names the file; empty if ok
  std::vector<double> positions;  ///< order of Robot::variables(); empty if missing_joints
  std::variant<Image<std::uint16_t>, Image<float>> depth;  ///< valid unless missing or bad
  Image<Rgb8> color;          ///< empty if not wanted, not recorded or not usable
  std::string color_message;  ///< why a recorded colour image is not usable; empty if it is
  std::vector<AttachedBody> attached;        ///< of a recording
  std::vector<std::size_t> uncertain_links;  ///< of a recording: as in Frame, for `message`

  [[nodiscard]] DepthView depth_view() const;
};

/// Returns the input of the pipeline for a recorded frame; it refers to `data`.
[[nodiscard]] Frame frame_of(const FrameData& data);

/// Reads a recording's frames. Faults of a frame's data become its status and are never thrown.
class FrameReader {
 public:
  /// Reads the joint file and lists the depth images. Keeps neither argument. Throws InputError as
  /// read_joint_file and FramePattern::existing.
  FrameReader(const Recording& recording, const Robot& robot);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::int64_t index(std::size_t i) const { return rows_[i].index; }

  /// Reads the i-th frame in the order of the joint file. Depth images without a row are frames
  /// with status missing_joints, before the first row of a later frame. The depth image is read
  /// even if the joints are missing. Several threads may call this, each with its own FrameData.
  void read(std::size_t i, bool with_color, FrameData& frame) const;

 private:
  ImageSize size_;
  RecordingFrames files_;
  std::optional<double> depth_scale_;  // metres per unit; null: the format's
  std::vector<JointRow> rows_;
  std::vector<RecordedBody> bodies_;
  std::vector<RobotPart> parts_;
};

}  // namespace penumbra::io
