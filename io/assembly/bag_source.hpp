// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame_queue.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

#include <io/assembly/bag_inbox.hpp>
#include <io/assembly/bag_scene.hpp>
#include <io/assembly/bag_topics.hpp>
#include <io/assembly/camera_changes.hpp>
#include <io/assembly/color_images.hpp>
#include <io/assembly/depth_input.hpp>
#include <io/assembly/info_pairs.hpp>
#include <io/assembly/message_sources.hpp>
#include <io/files/frame_source.hpp>
#include <io/ros/target_inbox.hpp>

namespace penumbra::io {

struct BagSourceOptions {
  BagTopics topics;
  BagScene scene;
  Camera camera;  ///< of the judged images
  /// The camera of the depth images if they have to be registered to `camera` by TF; nothing if it
  /// is `camera`.
  std::optional<Camera> depth_camera = {};
  PoseOptions poses = {};
  bool compare_sources = true;  ///< see JointBufferOptions and TransformBufferOptions
  double time_offset = 0.0;     ///< see FrameQueueOptions::time_offset
  std::optional<std::int64_t> first, end = {};  ///< the range of frames to read
  bool with_color = false;                      ///< with colour images, for pictures
};

/// Reads a bag's depth images, numbered from 0 in the order of recording, each with the robot's
/// pose at its own stamp. Returns every image; if its pose or pixels are not known, its status says
/// so. Targets come with the next frame after their messages.
class BagSource final : public FrameSource {
 public:
  /// `robot` must outlive this. Throws InputError like open_bag and FrameQueue, and for frames that
  /// the bag does not have according to its message count.
  BagSource(const std::filesystem::path& bag, const Robot& robot, BagSourceOptions options);

  /// Reads the next frame. Throws InputError at the end if the bag has none of the requested
  /// frames.
  bool next(FrameData& data, Frame& frame) override;
  [[nodiscard]] std::optional<std::size_t> size() const override { return size_; }
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  /// A depth image that waits for its pose.
  struct Waiting {
    std::vector<std::byte> payload;
    BagMessage message;  // views into the payload
    std::int64_t stamp = 0;
    std::string fault;  // why it cannot be used
  };
  struct Ready {
    std::uint64_t index = 0;
    Waiting image;
    QueuedFrame pose;
  };

  void check_range();
  void read_message();
  void take(const BagMessage& message);
  template <typename M>
  void take_depth(const BagMessage& message);
  void take_info(const BagMessage& message, const CameraInfoMessage& first, CameraChanges& changes);
  void take_joints(const BagMessage& message);
  void take_transforms(const BagMessage& message, bool is_static);
  void take_targets(const BagMessage& message);
  template <typename M>
  void take_targets_as(const BagMessage& message);
  template <typename M>
  void take_color(const BagMessage& message);
  void collect();
  void give_unposed(std::uint64_t index, Waiting image, const std::string& why);
  [[nodiscard]] bool is_presentable() const;
  void present(FrameData& data, Frame& frame);
  [[nodiscard]] std::string decode(const Waiting& image, DepthView& depth);
  void show_color(std::int64_t stamp, FrameData& data);

  BagSourceOptions options_;
  BagInbox inbox_;
  PoseHistory history_;
  MessageSources sources_;
  std::vector<DroppedFrame> dropped_;
  FrameQueue queue_;
  DepthInput depth_;
  ColorImages colors_;
  TargetInbox targets_;
  std::map<std::uint64_t, Waiting> waiting_;  // by index
  std::deque<Ready> ready_;
  Ready current_;  // the frame that the caller uses
  TransformAnswer T_color_depth_;
  CameraChanges camera_changes_, color_changes_;
  InfoPairs pairs_;  // of the depth images
  std::optional<std::size_t> size_;
  std::uint64_t images_ = 0;  // number read so far
  std::uint64_t given_ = 0;
  std::int64_t now_ = 0;  // current log time
  bool ended_ = false;
};

}  // namespace penumbra::io
