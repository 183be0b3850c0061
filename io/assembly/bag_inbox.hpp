// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <io/assembly/message_faults.hpp>
#include <io/bag/bag_reader.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Reads a bag's messages, and decodes those whose definitions have the fields that are read.
class BagInbox {
 public:
  /// Throws InputError like open_bag.
  explicit BagInbox(const std::filesystem::path& bag) : bag_(open_bag(bag)), name_(bag.string()) {}

  [[nodiscard]] std::span<const BagTopic> topics() const { return bag_->topics(); }
  [[nodiscard]] const std::string& name() const { return name_; }

  bool next(BagMessage& message) { return bag_->next(message); }
  [[nodiscard]] const BagTopic& topic_of(const BagMessage& message) const {
    return bag_->topics()[message.topic];
  }

  /// Whether the message could be decoded; one that could not is counted for notes(), and `fault`
  /// says why. Throws InputError for a definition with other fields than those that are read.
  template <typename M>
  bool decode(const BagMessage& message, M& decoded, std::string* fault = nullptr) {
    const auto what = decoder<M>(message.topic).decode(message.data, decoded);
    if (!what) return true;
    faults_.add(topic_of(message).name, message.log_time, *what);
    if (fault != nullptr) *fault = *what;
    return false;
  }

  /// Counts a message with the fault `what`.
  void add_fault(const std::string& topic, std::int64_t log_time, const std::string& what) {
    faults_.add(topic, log_time, what);
  }

  /// Returns the bag's faults and the number of unusable messages of each topic, one line each.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  template <typename M>
  using Decoders = std::map<std::size_t, Decoder<M>>;

  template <typename M>
  const Decoder<M>& decoder(std::size_t topic) {
    auto& known = std::get<Decoders<M>>(decoders_);
    if (const auto found = known.find(topic); found != known.end()) return found->second;
    return known.emplace(topic, make_decoder<M>(bag_->topics()[topic])).first->second;
  }
  template <typename M>
  [[nodiscard]] Decoder<M> make_decoder(const BagTopic& topic) const;

  std::unique_ptr<BagReader> bag_;
  std::string name_;
  std::tuple<Decoders<ImageMessage>, Decoders<CompressedImageMessage>, Decoders<CameraInfoMessage>,
             Decoders<JointStateMessage>, Decoders<TfMessage>, Decoders<StringMessage>,
             Decoders<Detection2DArrayMessage>, Decoders<Detection3DArrayMessage>,
             Decoders<KeypointsMessage>, Decoders<PoseStampedMessage>>
      decoders_;
  MessageFaults faults_;
};

}  // namespace penumbra::io
