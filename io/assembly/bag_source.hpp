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
  Camera camera;  ///< of the images that are judged
  /// The depth images' own, if they are to be brought to `camera` by TF; nothing: they are its.
  std::optional<Camera> depth_camera = {};
  PoseOptions poses = {};
  bool compare_sources = true;  ///< of JointBufferOptions and TransformBufferOptions
  double time_offset = 0.0;     ///< FrameQueueOptions::time_offset
  std::optional<std::int64_t> first, end = {};  ///< which frames are wanted
  bool with_color = false;                      ///< for pictures
};

/// A bag's depth images, numbered from 0 as they were recorded, each with the robot's pose at its
/// own stamp. Each image comes out: one whose pose or pixels are not known with the status that
/// says so. Targets come with the next frame after their messages.
class BagSource final : public FrameSource {
 public:
  /// `robot` must outlive this. Throws InputError as open_bag and FrameQueue, and for frames that
  /// the bag says it does not have.
  BagSource(const std::filesystem::path& bag, const Robot& robot, BagSourceOptions options);

  /// Throws InputError if the bag turns out to have none of the wanted frames.
  bool next(FrameData& data, Frame& frame) override;
  [[nodiscard]] std::optional<std::size_t> size() const override { return size_; }
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  /// A depth image that waits for its pose.
  struct Waiting {
    std::vector<std::byte> payload;
    BagMessage message;  // refers to the payload
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
  Ready current_;  // what the caller works on
  TransformAnswer T_color_depth_;
  CameraChanges camera_changes_, color_changes_;
  InfoPairs pairs_;  // of the depth images
  std::optional<std::size_t> size_;
  std::uint64_t images_ = 0;  // read so far
  std::uint64_t given_ = 0;
  std::int64_t now_ = 0;  // log time
  bool ended_ = false;
};

}  // namespace penumbra::io
