// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/poses/robot_pose.hpp>

#include <io/assembly/bag_options.hpp>
#include <io/assembly/input_topic.hpp>
#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// A topic that is taken.
struct TopicUse {
  std::string role;  ///< "depth"
  std::string name;
  std::string type;
  std::string why;
  std::optional<std::uint64_t> messages = {};  ///< if the bag has a count
  std::string robot = {};                      ///< InputTopic::robot
};

/// The topics to read from a bag, by role.
struct BagTopics {
  PoseSource poses = PoseSource::joints;
  bool has_depth = true;
  TopicUse depth;  ///< the judged images; without depth: of colour
  TopicUse camera_info;
  std::optional<TopicUse> color;
  std::optional<TopicUse> color_info;  ///< if depth is registered to the color camera
  std::vector<TopicUse> clouds;        ///< of a bag that is read for them; no images then
  std::vector<TopicUse> joints, transforms, targets, attached, plans, descriptions;

  /// Returns all topics, in the order in which they are printed.
  [[nodiscard]] std::vector<TopicUse> all() const;
  /// Returns the role of a topic of the bag, or nothing if it is not used.
  [[nodiscard]] std::optional<TopicRole> role_of(const BagTopic& topic) const;
  /// Returns InputTopic::robot of a topic of the bag.
  [[nodiscard]] std::string robot_of(const BagTopic& topic) const;
};

/// Several topics match and the user named none of them.
class AmbiguousTopics : public InputError {
  using InputError::InputError;
};

/// Returns the topics of the camera alone, as choose_topics does.
[[nodiscard]] BagTopics choose_camera_topics(const std::string& source,
                                             std::span<const BagTopic> topics,
                                             const BagOptions& options, bool with_color);

/// Returns the name of the camera_info topic next to an image topic.
[[nodiscard]] std::string camera_info_topic(const std::string& image_topic);

/// Chooses by names and types; ignores topics without messages. `with_color`: pictures are drawn.
/// Throws InputError that names the bag, the candidates and the option that chooses, where there is
/// none or more than one.
[[nodiscard]] BagTopics choose_topics(const std::string& bag, std::span<const BagTopic> topics,
                                      const BagOptions& options, bool with_color);

}  // namespace penumbra::io
