// SPDX-License-Identifier: Apache-2.0
// SQLite bags for tests, made with the tables of ROS 2's recorder.
#pragma once

#include "mcap_files.hpp"

#include <sqlite3.h>

#include <io/bag/bag_reader.hpp>

namespace penumbra::test {

/// A database that is written to.
class BagDatabase {
 public:
  explicit BagDatabase(const std::filesystem::path& file) {
    std::filesystem::remove(file);
    if (sqlite3_open(file.c_str(), &database_) != SQLITE_OK)
      throw std::runtime_error("no database");
  }
  BagDatabase(const BagDatabase&) = delete;
  BagDatabase& operator=(const BagDatabase&) = delete;
  ~BagDatabase() { sqlite3_close(database_); }

  void run(const std::string& text) {
    char* fault = nullptr;
    sqlite3_exec(database_, text.c_str(), nullptr, nullptr, &fault);
    if (fault != nullptr) ADD_FAILURE() << fault << " of " << text;
    sqlite3_free(fault);
  }

  /// The tables of Humble, or of Iron and later.
  void make_tables(bool with_definitions, bool with_index = true) {
    run("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
        "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,"
        " metadata TEXT NOT NULL);"
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
        " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL" +
        std::string(with_definitions ? ", type_description_hash TEXT NOT NULL);" : ");") +
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
        " timestamp INTEGER NOT NULL, data BLOB NOT NULL);");
    if (with_index) run("CREATE INDEX timestamp_idx ON messages (timestamp ASC);");
    if (with_definitions)
      run("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,"
          " encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,"
          " type_description_hash TEXT NOT NULL);");
    columns_ = with_definitions ? ", ''" : "";
  }

  void topic(int id, const std::string& name, const std::string& type,
             const std::string& qos = "") {
    run("INSERT INTO topics VALUES(" + std::to_string(id) + ", '" + name + "', '" + type +
        "', 'cdr', '" + qos + "'" + columns_ + ")");
  }

  void message(int topic, std::int64_t time, const std::string& data) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string hex;
    for (const unsigned char byte : data) hex += {digits[byte >> 4], digits[byte & 15]};
    run("INSERT INTO messages(topic_id, timestamp, data) VALUES(" + std::to_string(topic) + ", " +
        std::to_string(time) + ", x'" + hex + "')");
  }

 private:
  sqlite3* database_ = nullptr;
  std::string columns_;
};

struct BagContent {
  std::vector<io::BagTopic> topics;
  std::vector<RecordedMessage> messages;  ///< schema: the topic's type; sequence is 0
  std::vector<std::string> faults;
};

inline BagContent read_bag(const std::filesystem::path& path) {
  BagContent all;
  const auto bag = io::open_bag(path);
  for (io::BagMessage message; bag->next(message);) {
    const io::BagTopic& topic = bag->topics()[message.topic];
    all.messages.push_back({topic.name, topic.type, 0, message.log_time, message.publish_time,
                            bytes_of(message.data)});
  }
  all.topics.assign(bag->topics().begin(), bag->topics().end());
  all.faults.assign(bag->faults().begin(), bag->faults().end());
  for (const auto& fault : all.faults) EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
  return all;
}

/// As ROS 2's recorder writes it, but for the topics' many settings.
inline std::string metadata_yaml(const std::string& storage, const std::vector<std::string>& files,
                                 const std::string& topics = " []",
                                 const std::string& compression = "") {
  std::string text =
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: " + storage +
      "\n  duration:\n    nanoseconds: 1\n  starting_time:\n"
      "    nanoseconds_since_epoch: 2\n  message_count: 3\n"
      "  topics_with_message_count:" +
      topics +
      "\n  compression_format: \"\"\n"
      "  compression_mode: \"" +
      compression + "\"\n  relative_file_paths:\n";
  for (const auto& file : files) text += "    - " + file + "\n";
  return text;
}

}  // namespace penumbra::test
