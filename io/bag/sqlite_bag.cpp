// SPDX-License-Identifier: Apache-2.0
// Reads the tables of any version of rosbag2_storage_sqlite3: `topics`, `messages` and, since Iron,
// `message_definitions`.
#include <map>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/bag/offered_qos.hpp>
#include <io/bag/sqlite_database.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_faults = 1000;

using BagOrder = std::pair<std::int64_t, std::int64_t>;  // timestamp, row

class SqliteBag final : public BagReader {
 public:
  explicit SqliteBag(const std::filesystem::path& file) : database_(with_tables(file)) {
    if (!database_->fault().empty()) add_fault(database_->fault());
    read_topics();
    // There are two queries: the first reads the index only or sorts numbers, and a damaged row
    // does not affect the other rows.
    order_.emplace(*database_, "SELECT timestamp, rowid FROM messages ORDER BY timestamp, rowid");
    row_.emplace(*database_, "SELECT topic_id, data FROM messages WHERE rowid = ?");
  }

  [[nodiscard]] std::span<const BagTopic> topics() const override { return topics_; }
  [[nodiscard]] std::span<const std::string> faults() const override { return faults_; }

  bool next(BagMessage& message) override {
    while (const auto place = next_place())
      if (read(*place, message)) return true;
    return false;
  }

 private:
  static std::unique_ptr<SqliteDatabase> with_tables(const std::filesystem::path& file) {
    auto database = std::make_unique<SqliteDatabase>(file);
    for (const char* table : {"topics", "messages"})
      if (!database->has_table(table))
        throw InputError(file.string() + ": has no table '" + table + "', as bags of ROS 2 have");
    return database;
  }

  void read_topics() {
    const auto definitions = read_definitions();
    const auto qos = read_qos();
    SqliteQuery query(*database_,
                      "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    auto step = query.step();
    for (; step == SqliteQuery::Step::row; step = query.step()) {
      const auto id = query.integer(0);
      auto name = query.text(1), type = query.text(2), encoding = query.text(3);
      if (!id || !name || !type || !encoding) {
        add_fault("a topic's row is damaged; left out");
        continue;
      }
      const auto own = definitions.find(*type);
      std::string definition =
          own != definitions.end() ? own->second : definition_or_built_in(*type, {}, {});
      topic_of_[*id] = topics_.size();
      topics_.push_back({std::move(*name), std::move(*type), std::move(definition),
                         std::move(*encoding), std::nullopt});
      if (const auto stored = qos.find(*id); stored != qos.end())
        topics_.back().qos = stored->second;
    }
    if (step == SqliteQuery::Step::failed)
      add_fault("its topics cannot all be read: " + database_->failure());
  }

  [[nodiscard]] std::map<std::int64_t, OfferedQos> read_qos() const {
    std::map<std::int64_t, OfferedQos> all;
    if (!database_->has_column("topics", "offered_qos_profiles")) return all;
    SqliteQuery query(*database_, "SELECT id, offered_qos_profiles FROM topics");
    while (query.step() == SqliteQuery::Step::row) {
      const auto id = query.integer(0);
      const auto profiles = query.text(1);
      if (id && profiles) all.emplace(*id, read_offered_qos(*profiles));
    }
    return all;
  }

  [[nodiscard]] std::map<std::string, std::string> read_definitions() const {
    std::map<std::string, std::string> definitions;
    if (!database_->has_table("message_definitions")) return definitions;
    SqliteQuery query(
        *database_,
        "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
    while (query.step() == SqliteQuery::Step::row) {
      auto type = query.text(0), encoding = query.text(1), text = query.text(2);
      if (type && encoding && text && *encoding == "ros2msg" && !text->empty())
        definitions.emplace(std::move(*type), std::move(*text));
    }
    return definitions;
  }

  // Returns the position of the next message, or nothing at the end or if the order itself is
  // damaged.
  [[nodiscard]] std::optional<BagOrder> next_place() {
    if (ended_) return std::nullopt;
    const auto step = order_->step();
    if (step == SqliteQuery::Step::row) {
      const auto time = order_->integer(0), row = order_->integer(1);
      if (time && row && (!last_ || *last_ < BagOrder{*time, *row})) {
        last_ = BagOrder{*time, *row};
        return last_;
      }
      add_fault("the messages' times are damaged; the rest is left out");
    } else if (step == SqliteQuery::Step::failed) {
      add_fault("is damaged after " +
                (last_ ? "the message of " + std::to_string(last_->first) + " ns" : "its topics") +
                " (" + database_->failure() + "); the rest is left out");
    }
    ended_ = true;
    return std::nullopt;
  }

  [[nodiscard]] bool read(const BagOrder& place, BagMessage& message) {
    const std::string which = "message " + std::to_string(place.second) + " ";
    row_->restart(place.second);
    const auto step = row_->step();
    if (step != SqliteQuery::Step::row) {
      add_fault(which + "cannot be read" +
                (step == SqliteQuery::Step::failed ? " (" + database_->failure() + ")" : "") +
                "; left out");
      return false;
    }
    const auto topic = topic_of_.find(row_->integer(0).value_or(-1));
    const auto data = row_->blob(1);
    if (topic == topic_of_.end() || !data) {
      add_fault(which + (data ? "is of a topic that the bag does not define" : "holds no bytes") +
                "; left out");
      return false;
    }
    message = {topic->second, place.first, place.first, *data};
    return true;
  }

  void add_fault(const std::string& what) {
    if (faults_.size() > most_faults) return;
    faults_.push_back(database_->file().string() + ": " +
                      (faults_.size() == most_faults ? "more faults, which are not listed" : what));
  }

  std::unique_ptr<SqliteDatabase> database_;
  std::vector<BagTopic> topics_;
  std::map<std::int64_t, std::size_t> topic_of_;
  std::vector<std::string> faults_;
  std::optional<SqliteQuery> order_;
  std::optional<SqliteQuery> row_;
  std::optional<BagOrder> last_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<BagReader> open_sqlite_bag(const std::filesystem::path& file) {
  return std::make_unique<SqliteBag>(file);
}

}  // namespace penumbra::io
