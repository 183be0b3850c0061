// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <io/assembly/bag_topics.hpp>
#include <io/assembly/frame_tree.hpp>
#include <io/assembly/message_faults.hpp>
#include <io/assembly/message_handler.hpp>
#include <io/assembly/robot_input.hpp>
#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// The data that holds for a whole bag: robot, camera and fixed frames. It may stand anywhere in
/// the bag.
struct BagScene {
  std::vector<RobotDescription> descriptions;  ///< in the order of BagTopics::descriptions
  std::optional<std::string> depth_frame;      ///< frame_id of the first depth image
  std::optional<CameraInfoMessage> camera_info, color_info;
  std::map<std::string, std::string> cloud_frames;  ///< frame_id of the first cloud, by topic
  std::vector<TransformMessage> static_transforms;
  FrameTree frames;  ///< the frames of TF
};

/// Finds the scene of a bag before its frames are read.
class BagSceneReader {
 public:
  /// Throws InputError as open_bag and choose_topics.
  BagSceneReader(const std::filesystem::path& bag, const BagOptions& options, bool with_color);
  BagSceneReader(const BagSceneReader&) = delete;
  BagSceneReader& operator=(const BagSceneReader&) = delete;

  [[nodiscard]] const BagTopics& topics() const { return topics_; }
  [[nodiscard]] const BagScene& scene() const { return scene_; }

  /// Reads until robot and camera, or the clouds' frames, are known. Throws InputError that names
  /// the topic if the bag lacks one.
  void read_robot_and_camera();

  /// Reads on until `found` returns true or the bag ends. Returns whether it was found.
  bool read_until(const std::function<bool(const BagScene&)>& found);

 private:
  void take(const BagMessage& message);
  [[nodiscard]] MessageHandler handler_of(const BagTopic& topic);
  [[nodiscard]] const RobotDescription* find_description(const std::string& robot) const;
  [[nodiscard]] bool is_mounted(const std::string& robot) const;
  [[nodiscard]] std::string lacking() const;

  std::unique_ptr<BagReader> bag_;
  std::string name_;
  BagTopics topics_;
  BagScene scene_;
  std::vector<MessageHandler> handlers_;  // of each topic of the bag, null: not needed
  MessageFaults faults_;
};

/// Returns the faults of a bag and of its messages, one line each.
[[nodiscard]] std::vector<std::string> bag_notes(const std::string& name, const BagReader& bag,
                                                 const MessageFaults& faults);

}  // namespace penumbra::io
