// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

// The metadata.yaml that `ros2 bag record` writes next to a recording's files when it ends.
struct BagMetadata {
  std::vector<std::filesystem::path> files;  //< in the order of recording; some may be missing
  // Number of messages by topic and type.
  std::map<std::pair<std::string, std::string>, std::uint64_t> messages;
  std::map<std::pair<std::string, std::string>, OfferedQos> qos;  //< by topic and type
};

// Up to version 3, paths begin with the recording's folder.
std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& name) {
  std::filesystem::path beside = folder / name;
  std::filesystem::path above = folder.parent_path() / name;
  std::error_code ignored;
  if (!std::filesystem::exists(beside, ignored) && std::filesystem::exists(above, ignored))
    return above;
  return beside;
}

void refuse_compression(const YamlNode& information) {
  const YamlNode* mode = information.find("compression_mode");
  if (mode == nullptr || mode->is_null()) return;
  const std::string& name = mode->text_or_empty();
  if (name.empty() || name == "NONE" || name == "none") return;
  if (name == "FILE" || name == "file") return;  // each is a *.zstd
  mode->fail("'" + name +
             "' is not read; 'ros2 bag convert' makes a bag without it, or with "
             "compressed chunks of MCAP");
}

// Reads a metadata.yaml of any version. Throws InputError with file and line for missing or invalid
// entries, for recordings without files, and for recordings with compressed messages.
BagMetadata read_bag_metadata(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::read(file);
  const YamlNode& information = root.at("rosbag2_bagfile_information");
  refuse_compression(information);
  BagMetadata metadata;
  const YamlNode& paths = information.at("relative_file_paths");
  for (const std::string& name : paths.texts())
    metadata.files.push_back(file_of(file.parent_path(), name));
  if (metadata.files.empty()) paths.fail("names no file; a recording has one at least");
  const YamlNode* topics = information.find("topics_with_message_count");
  if (topics == nullptr || topics->is_null()) return metadata;
  for (const YamlNode& topic : topics->items()) {
    const YamlNode& about = topic.at("topic_metadata");
    const std::int64_t count = topic.at("message_count").integer();
    if (count < 0) topic.at("message_count").fail("is negative; messages are counted from 0");
    const std::pair name_and_type(about.at("name").text(), about.at("type").text());
    metadata.messages[name_and_type] += static_cast<std::uint64_t>(count);
    if (const YamlNode* qos = about.find("offered_qos_profiles"))
      merge(read_offered_qos(*qos), metadata.qos[name_and_type]);
  }
  return metadata;
}

// One file of a recording. It is open only while its messages are due.
struct BagPart {
  std::filesystem::path file;
  std::int64_t start_time = 0;
  std::unique_ptr<BagReader> reader;
  BagMessage waiting;               // its next message
  std::vector<std::size_t> topics;  // index of the recording's topic for each topic of the file
  std::size_t copied_faults = 0;
};

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
                       ": holds no bag: neither metadata.yaml nor *.mcap nor *.db3");
    std::sort(files.begin(), files.end());
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
      const std::pair name_and_type(found[i].name, found[i].type);
      BagTopic& topic = topics_[part.topics.emplace_back(add_topic(found[i], topics_))];
      if (!metadata_) continue;
      topic.messages.reset();
      if (const auto count = metadata_->messages.find(name_and_type);
          count != metadata_->messages.end())
        topic.messages = count->second;
      if (const auto qos = metadata_->qos.find(name_and_type); qos != metadata_->qos.end())
        merge(qos->second, topic.qos);
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

}  // namespace penumbra::io
