// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <io/bag/bag_file.hpp>
#include <io/mcap/reader.hpp>

namespace penumbra::io {
namespace {

class McapBag final : public BagReader {
 public:
  explicit McapBag(const std::filesystem::path& file) : file_(file.string()), reader_(file) {
    take_channels();
    take_faults();
  }

  [[nodiscard]] std::span<const BagTopic> topics() const override { return topics_; }
  [[nodiscard]] std::span<const std::string> faults() const override { return faults_; }

  bool next(BagMessage& message) override {
    mcap::Message found;
    const bool any = reader_.next(found);
    if (reader_.faults().size() > faults_.size()) take_faults();
    if (!any) return false;
    if (reader_.channels().size() > topic_of_.size()) take_channels();
    message = {topic_of_.at(found.channel), found.log_time, found.publish_time, found.data};
    return true;
  }

 private:
  // Each publisher of a topic has a channel of its own.
  void take_channels() {
    for (const auto& [id, channel] : reader_.channels())
      if (!topic_of_.contains(id)) topic_of_[id] = add_topic(topic_of(channel), topics_);
  }

  [[nodiscard]] BagTopic topic_of(const mcap::Channel& channel) const {
    BagTopic topic{.name = channel.topic,
                   .type = {},
                   .definition = {},
                   .encoding = channel.message_encoding,
                   .messages = {}};
    if (const auto qos = channel.metadata.find("offered_qos_profiles");
        qos != channel.metadata.end())
      topic.qos = read_offered_qos(qos->second);
    if (const auto schema = reader_.schemas().find(channel.schema_id);
        schema != reader_.schemas().end()) {
      const mcap::Schema& found = schema->second;
      topic.type = found.name;
      topic.definition = definition_or_built_in(found.name, found.encoding, found.data);
    }
    if (reader_.statistics() && !reader_.statistics()->channel_messages.empty()) {
      const auto& counts = reader_.statistics()->channel_messages;
      const auto count = counts.find(channel.id);
      topic.messages = count == counts.end() ? 0 : count->second;
    }
    return topic;
  }

  void take_faults() {
    const auto& found = reader_.faults();
    for (std::size_t i = faults_.size(); i < found.size(); ++i)
      faults_.push_back(file_ + ": byte " + std::to_string(found[i].offset) + ": " + found[i].what);
  }

  std::string file_;
  mcap::Reader reader_;
  std::vector<BagTopic> topics_;
  std::map<std::uint16_t, std::size_t> topic_of_;
  std::vector<std::string> faults_;
};

}  // namespace

std::unique_ptr<BagReader> open_mcap_bag(const std::filesystem::path& file) {
  return std::make_unique<McapBag>(file);
}

}  // namespace penumbra::io
