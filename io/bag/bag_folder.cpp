// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/bag/bag_metadata.hpp>
#include <io/bag/natural_order.hpp>
#include <io/bag/offered_qos.hpp>

namespace penumbra::io {
namespace {

// One file of a recording. It is open only while its messages are due.
struct BagPart {
  std::filesystem::path file;
  std::int64_t start_time = 0;
  std::unique_ptr<BagReader> reader;
  BagMessage waiting;               // its next message
  std::vector<std::size_t> topics;  // index of the recording's topic for each topic of the file
  std::size_t copied_faults = 0;
};

/// Returns the bags in a folder, in no order.
std::vector<std::filesystem::path> bags_in(const std::filesystem::path& folder,
                                           std::error_code& fault) {
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end;
       entry.increment(fault))
    if (is_bag_file(entry->path())) files.push_back(entry->path());
  return files;
}

class BagFolder final : public BagReader {
 public:
  explicit BagFolder(const std::filesystem::path& folder) {
    std::string refusal;
    for (const auto& file : files_of(folder)) inspect(file, refusal);
    if (!any_read_) throw InputError(refusal);
    std::stable_sort(parts_.begin(), parts_.end(), [](const BagPart& a, const BagPart& b) {
      return a.start_time < b.start_time;
    });
  }

  [[nodiscard]] std::span<const BagTopic> topics() const override { return topics_; }
  [[nodiscard]] std::span<const std::string> faults() const override { return faults_; }

  bool next(BagMessage& message) override {
    if (current_) advance(parts_[*current_]);
    current_ = earliest();
    while (next_part_ < parts_.size() &&
           (!current_ || parts_[next_part_].start_time <= parts_[*current_].waiting.log_time)) {
      open_.push_back(next_part_);
      reopen(parts_[next_part_++]);
      current_ = earliest();
    }
    if (!current_) return false;
    const BagPart& part = parts_[*current_];
    message = part.waiting;
    message.topic = part.topics[message.topic];
    return true;
  }

 private:
  std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
    const auto metadata_file = folder / "metadata.yaml";
    if (std::filesystem::exists(metadata_file)) {
      metadata_ = read_bag_metadata(metadata_file);
      return metadata_->files;
    }
    std::error_code fault;
    std::vector<std::filesystem::path> files = bags_in(folder, fault);
    if (fault) throw InputError(folder.string() + ": cannot be read: " + fault.message());
    if (files.empty())
      throw InputError(folder.string() +
                       ": holds no recording: neither metadata.yaml nor *.mcap "
                       "nor *.db3");
    std::sort(files.begin(), files.end(), natural_less);
    faults_.push_back(metadata_file.string() +
                      ": is missing (was the recorder killed?); all bags "
                      "of the folder are read");
    return files;
  }

  // Reads the topics and start time of a file and closes it. The file is opened again when its
  // messages are due, so that few files are open at a time.
  void inspect(const std::filesystem::path& file, std::string& refusal) {
    BagPart part{.file = file,
                 .start_time = 0,
                 .reader = {},
                 .waiting = {},
                 .topics = {},
                 .copied_faults = 0};
    try {
      part.reader = open_bag_file(file);
    } catch (const InputError& error) {
      if (refusal.empty()) refusal = error.what();
      faults_.emplace_back(std::string(error.what()) + "; its part of the recording is left out");
      return;
    }
    any_read_ = true;
    const bool any = part.reader->next(part.waiting);
    take_topics(part);
    take_faults(part);
    part.reader.reset();
    part.start_time = part.waiting.log_time;
    if (any) parts_.push_back(std::move(part));
  }

  void reopen(BagPart& part) {
    try {
      part.reader = open_bag_file(part.file);
    } catch (const InputError& error) {
      faults_.emplace_back(error.what());
      return;
    }
    advance(part);
  }

  void advance(BagPart& part) {
    if (!part.reader) return;
    const bool any = part.reader->next(part.waiting);
    take_faults(part);
    if (part.reader->topics().size() > part.topics.size()) take_topics(part);
    if (!any) part.reader.reset();
  }

  void take_topics(BagPart& part) {
    const auto found = part.reader->topics();
    for (std::size_t i = part.topics.size(); i < found.size(); ++i) {
      BagTopic topic = found[i];
      const auto count = std::exchange(topic.messages, std::nullopt);
      const OfferedQos qos = topic.qos;
      auto known = std::find_if(topics_.begin(), topics_.end(),
                                [&](const BagTopic& other) { return other.is_same_topic(topic); });
      const bool first = known == topics_.end();
      if (first) known = topics_.insert(known, std::move(topic));
      merge(qos, known->qos);
      if (first) set_qos(*known);
      count_messages(*known, count, first);
      part.topics.push_back(static_cast<std::size_t>(known - topics_.begin()));
    }
  }

  void set_qos(BagTopic& topic) const {
    if (!metadata_) return;
    const auto stored = metadata_->qos.find({topic.name, topic.type});
    if (stored != metadata_->qos.end()) merge(stored->second, topic.qos);
  }

  void count_messages(BagTopic& topic, const std::optional<std::uint64_t>& count, bool first) {
    if (metadata_) {
      const auto stored = metadata_->messages.find({topic.name, topic.type});
      if (stored != metadata_->messages.end()) topic.messages = stored->second;
    } else if (first) {
      topic.messages = count;
    } else if (topic.messages && count) {
      *topic.messages += *count;
    } else {
      topic.messages.reset();
    }
  }

  void take_faults(BagPart& part) {
    const auto found = part.reader->faults();
    for (; part.copied_faults < found.size(); ++part.copied_faults)
      faults_.push_back(found[part.copied_faults]);
  }

  // Returns the open file with the earliest message.
  [[nodiscard]] std::optional<std::size_t> earliest() {
    std::erase_if(open_, [&](std::size_t i) { return parts_[i].reader == nullptr; });
    std::optional<std::size_t> first;
    for (const std::size_t i : open_)
      if (!first || parts_[i].waiting.log_time < parts_[*first].waiting.log_time) first = i;
    return first;
  }

  std::optional<BagMetadata> metadata_;
  std::vector<BagTopic> topics_;
  std::vector<std::string> faults_;
  std::vector<BagPart> parts_;          // by start time
  std::size_t next_part_ = 0;           // not yet opened again
  std::vector<std::size_t> open_;       // indices of parts, rising
  std::optional<std::size_t> current_;  // the file of the last returned message
  bool any_read_ = false;
};

}  // namespace

std::unique_ptr<BagReader> open_bag_folder(const std::filesystem::path& folder) {
  return std::make_unique<BagFolder>(folder);
}

bool is_bag_folder(const std::filesystem::path& folder) {
  std::error_code fault;
  if (std::filesystem::exists(folder / "recording.yaml", fault)) return false;
  if (std::filesystem::exists(folder / "metadata.yaml", fault)) return true;
  return !bags_in(folder, fault).empty();
}

}  // namespace penumbra::io
