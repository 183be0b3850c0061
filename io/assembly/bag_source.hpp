// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <io/assembly/bag_topics.hpp>
#include <io/assembly/cloud_input.hpp>
#include <io/assembly/depth_input.hpp>
#include <io/assembly/frame_assembler.hpp>
#include <io/bag/bag_reader.hpp>
#include <io/files/frame_source.hpp>

namespace penumbra::io {

struct BagSourceOptions {
  BagOptions bag;
  BagTopics topics;
  std::optional<KnownCamera> camera = {};
  std::optional<CloudInputOptions> cloud = {};      ///< one of topics.clouds, in place of a camera
  std::vector<TransformMessage> static_transforms;  ///< see RobotInputOptions
  std::optional<std::int64_t> first, end = {};      ///< the range of frames to read
  std::string range_option = "--frames";            ///< that gave it, for messages
  bool with_color = false;                          ///< with colour images, for pictures
};

/// Feeds a bag's messages to a FrameAssembler. Returns every depth image or cloud, numbered from 0
/// in the order of recording; if its pose or pixels are not known, its status says so. Targets come
/// with the frame of their stamp, or the next one after their messages.
class BagSource final : public FrameSource {
 public:
  /// Throws InputError like open_bag and FrameQueue, and for frames that the bag does not have
  /// according to its message count.
  BagSource(const std::filesystem::path& bag, const Robot& robot, BagSourceOptions options);

  /// Reads the next frame. Throws InputError at the end if the bag has none of the requested
  /// frames.
  bool read(std::size_t number, Frame& frame) override;
  [[nodiscard]] std::optional<std::size_t> size() const override { return size_; }
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  void check_range();
  [[nodiscard]] const TopicUse& sensor() const;
  void read_message();
  [[nodiscard]] const std::optional<std::size_t>& input_of(std::size_t topic);
  [[nodiscard]] bool is_in_range(std::int64_t image) const;

  BagSourceOptions options_;
  std::unique_ptr<BagReader> bag_;
  std::string name_;
  FrameAssembler assembler_;
  std::vector<std::optional<std::size_t>> inputs_;  // the assembler's topic of each of the bag's
  std::optional<DepthInput> depth_;                 // of a camera
  std::optional<std::size_t> size_;
  std::int64_t images_ = 0;  // number of images or clouds read so far
  std::int64_t now_ = 0;     // current log time
  bool ended_ = false, given_ = false;
  std::string time_note_;  // the first cloud's
};

}  // namespace penumbra::io
