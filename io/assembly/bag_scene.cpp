// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/bag_scene.hpp>

namespace penumbra::io {
namespace {

/// Returns the bag's faults for the end of an error message: the missing data may be in a damaged
/// part.
std::string damages_of(const BagInbox& inbox) {
  std::string damages;
  for (const std::string& note : inbox.notes()) damages += "; " + note;
  return damages;
}

BagTopics topics_of(const BagInbox& inbox, const BagOptions& options, bool with_color) {
  try {
    return choose_topics(inbox.name(), inbox.topics(), options, with_color);
  } catch (const InputError& error) {
    throw InputError(error.what() + damages_of(inbox));
  }
}

}  // namespace

BagSceneReader::BagSceneReader(const std::filesystem::path& bag, const BagOptions& options,
                               bool with_color)
    : inbox_(bag), topics_(topics_of(inbox_, options, with_color)) {}

void BagSceneReader::read_robot_and_camera() {
  if (read_until([this](const BagScene&) { return lacking().empty(); })) return;
  throw InputError(inbox_.name() + ": " + lacking() + " has no message that can be read" +
                   damages_of(inbox_));
}

bool BagSceneReader::read_until(const std::function<bool(const BagScene&)>& found) {
  BagMessage message;
  while (!found(scene_)) {
    if (!inbox_.next(message)) return false;
    take(message);
  }
  return true;
}

void BagSceneReader::take(const BagMessage& message) {
  const BagTopic& topic = inbox_.topic_of(message);
  const auto is = [&](const TopicUse& use) {
    return topic.name == use.name && topic.type == use.type;
  };
  if (is(topics_.depth) && !scene_.depth_frame) {
    if (topic.type == message_type<ImageMessage>())
      take_depth<ImageMessage>(message);
    else
      take_depth<CompressedImageMessage>(message);
  }
  if (is(topics_.camera_info)) take_info(message, scene_.camera_info);
  if (topics_.color_info && is(*topics_.color_info)) take_info(message, scene_.color_info);
  if (topics_.description && is(*topics_.description) && !scene_.description)
    if (StringMessage text; inbox_.decode(message, text)) scene_.description = std::move(text.data);
  for (const TopicUse& use : topics_.transforms)
    if (is(use)) take_transforms(message, use.name.ends_with("static"));
}

template <typename M>
void BagSceneReader::take_depth(const BagMessage& message) {
  if (M image; inbox_.decode(message, image)) scene_.depth_frame = image.header.frame_id;
}

void BagSceneReader::take_info(const BagMessage& message, std::optional<CameraInfoMessage>& info) {
  if (info) return;
  if (CameraInfoMessage found; inbox_.decode(message, found)) info = std::move(found);
}

void BagSceneReader::take_transforms(const BagMessage& message, bool is_static) {
  TfMessage found;
  if (!inbox_.decode(message, found)) return;
  for (TransformMessage& transform : found.transforms) {
    scene_.frames.add(transform.header.frame_id, transform.child_frame_id);
    if (is_static) scene_.static_transforms.push_back(std::move(transform));
  }
}

std::string BagSceneReader::lacking() const {
  if (topics_.description && !scene_.description) return topics_.description->name;
  if (!scene_.depth_frame) return topics_.depth.name;
  if (!scene_.camera_info) return topics_.camera_info.name;
  if (topics_.color_info && !scene_.color_info) return topics_.color_info->name;
  return {};
}

}  // namespace penumbra::io
