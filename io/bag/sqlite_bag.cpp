// SPDX-License-Identifier: Apache-2.0
// Reads the tables of any version of rosbag2_storage_sqlite3: `topics`, `messages` and, since Iron,
// `message_definitions`.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include <sqlite3.h>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/printable.hpp>

namespace penumbra::io {
namespace {

constexpr std::string_view sqlite_magic{"SQLite format 3\0", 16};
constexpr std::size_t page_size_at = 16;  // https://www.sqlite.org/fileformat.html, big-endian
using FileStart = std::array<char, page_size_at + 2>;

// A row takes about 40 steps of SQLite's virtual machine and has at least about 30 bytes. Only
// pages with cyclic references take more.
constexpr std::uint64_t steps_per_byte = 16;
constexpr std::uint64_t steps_at_least = 10'000'000;
constexpr int steps_at_once = 1000;

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  return none ? 0 : size;
}

std::filesystem::path with_suffix(std::filesystem::path file, const char* suffix) {
  file += suffix;
  return file;
}

// Returns the URI of a file for SQLite: https://www.sqlite.org/uri.html
std::string uri_of(const std::filesystem::path& file, bool immutable) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).lexically_normal().string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '_' || c == '-') {
      uri += c;
    } else {
      std::array<char, 4> code{};
      std::snprintf(code.data(), code.size(), "%%%02X", byte);
      uri += code.data();
    }
  }
  return uri + (immutable ? "?mode=ro&immutable=1" : "?mode=ro");
}

int count_down(void* left) {
  auto& steps = *static_cast<std::uint64_t*>(left);
  return steps == 0 || --steps == 0 ? 1 : 0;
}

// Records a fault if the file ends within a page: SQLite fills the rest with zeros, and messages in
// it too.
void check_pages(const std::filesystem::path& file, std::uint64_t size, const FileStart& start) {
  const auto high = static_cast<unsigned char>(start[page_size_at]);
  const auto low = static_cast<unsigned char>(start[page_size_at + 1]);
  const std::uint64_t page = high == 0 && low == 1 ? 65536 : 256ULL * high + low;
  if (page == 0 || size % page == 0) return;
  throw InputError(file.string() +
                   ": is cut inside a page; the part before it is readable after "
                   "'truncate -s " +
                   std::to_string(size - size % page) + "' of a copy");
}

// A read-only, untrusted database file. Its size bounds the time and memory that reading takes.
class SqliteDatabase {
 public:
  // Throws InputError that names the file if it is not a database. A killed recorder leaves a
  // journal next to its file, which has to be read too. Without a journal, no file is written next
  // to the recording.
  explicit SqliteDatabase(const std::filesystem::path& file) : file_(file) {
    InputFile input;
    input.open(file).require();
    file_size_ = input.size();
    FileStart start{};
    if (input.read(start.data(), start.size()) != start.size() ||
        !std::string_view(start.data(), start.size()).starts_with(sqlite_magic))
      throw InputError(file.string() + ": is not an SQLite database, as *.db3 bags are");

    const bool has_journal =
        size_of(with_suffix(file, "-wal")) + size_of(with_suffix(file, "-journal")) > 0;
    if (!has_journal) check_pages(file, file_size_, start);
    if (open(!has_journal)) return;
    const std::string first = failure();
    if (has_journal && open(true)) {
      fault_ = "the journal next to it cannot be read (" + first + ") and is ignored";
      return;
    }
    // With this setting a truncated file can be read: its size may differ from the one in its
    // first page.
    if (!answers("PRAGMA writable_schema=ON") || !answers("SELECT count(*) FROM sqlite_master"))
      throw InputError(file.string() + ": cannot be read: " + first);
    fault_ = "is cut or damaged (" + first + "); the readable part is read";
  }
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  [[nodiscard]] sqlite3* get() const { return database_.get(); }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  // Returns what is wrong with a readable file, or an empty text.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  // Returns SQLite's message of its last failure.
  [[nodiscard]] std::string failure() const { return printable(sqlite3_errmsg(get())); }
  [[nodiscard]] bool has_column(const char* table, const char* name) const {
    return sqlite3_table_column_metadata(get(), nullptr, table, name, nullptr, nullptr, nullptr,
                                         nullptr, nullptr) == SQLITE_OK;
  }

 private:
  bool open(bool immutable) {
    constexpr int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX;
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(uri_of(file_, immutable).c_str(), &opened, flags, nullptr);
    database_.reset(opened);
    if (result != SQLITE_OK) return false;
    for (const int setting : {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER,
                              SQLITE_DBCONFIG_ENABLE_VIEW})
      sqlite3_db_config(opened, setting, 0, nullptr);
    const std::uint64_t most_bytes = std::clamp<std::uint64_t>(file_size_, 1 << 20, 1 << 30);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(most_bytes));
    steps_left_ = (steps_at_least + steps_per_byte * file_size_) / steps_at_once;
    sqlite3_progress_handler(opened, steps_at_once, count_down, &steps_left_);
    return answers("SELECT count(*) FROM sqlite_master");
  }

  bool answers(const char* query) {
    return database_ && sqlite3_exec(get(), query, nullptr, nullptr, nullptr) == SQLITE_OK;
  }

  std::filesystem::path file_;
  std::uint64_t file_size_ = 0;
  std::uint64_t steps_left_ = 0;  // thousands of steps of SQLite's virtual machine
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_{nullptr, sqlite3_close};
  std::string fault_;
};

// A query. step() goes through its rows. Columns are counted from 0; a value of another type is
// nothing; texts and bytes are valid until the next step.
class SqliteQuery {
 public:
  enum class Step { row, done, failed };

  // Throws InputError that names the database's file if it lacks these columns or tables. The
  // database must outlive this.
  SqliteQuery(const SqliteDatabase& database, const char* text) {
    if (sqlite3_prepare_v2(database.get(), text, -1, &statement_, nullptr) != SQLITE_OK)
      throw InputError(database.file().string() +
                       ": is not a bag that can be read: " + database.failure());
  }
  ~SqliteQuery() { sqlite3_finalize(statement_); }
  SqliteQuery(const SqliteQuery&) = delete;
  SqliteQuery& operator=(const SqliteQuery&) = delete;

  // Restarts the query with a value for its "?".
  void restart(std::int64_t value) {
    sqlite3_reset(statement_);
    sqlite3_bind_int64(statement_, 1, value);
  }

  Step step() {
    const int result = sqlite3_step(statement_);
    if (result == SQLITE_ROW) return Step::row;
    return result == SQLITE_DONE ? Step::done : Step::failed;
  }

  [[nodiscard]] std::optional<std::int64_t> integer(int column) const {
    if (sqlite3_column_type(statement_, column) != SQLITE_INTEGER) return std::nullopt;
    return sqlite3_column_int64(statement_, column);
  }
  [[nodiscard]] std::optional<std::string> text(int column) const {
    const auto bytes = bytes_of(column, SQLITE_TEXT);
    if (!bytes) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  }
  [[nodiscard]] std::optional<std::span<const std::byte>> blob(int column) const {
    return bytes_of(column, SQLITE_BLOB);
  }

 private:
  [[nodiscard]] std::optional<std::span<const std::byte>> bytes_of(int column, int type) const {
    if (sqlite3_column_type(statement_, column) != type) return std::nullopt;
    const void* bytes = sqlite3_column_blob(statement_, column);
    const int size = sqlite3_column_bytes(statement_, column);
    return std::span(static_cast<const std::byte*>(bytes),
                     bytes == nullptr ? 0 : static_cast<std::size_t>(size));
  }

  sqlite3_stmt* statement_ = nullptr;
};

constexpr std::size_t most_faults = 1000;

using BagOrder = std::pair<std::int64_t, std::int64_t>;  // timestamp, row

class SqliteBag final : public BagReader {
 public:
  explicit SqliteBag(const std::filesystem::path& file) : database_(file) {
    for (const char* table : {"topics", "messages"}) check_has_table(table);
    if (!database_.fault().empty()) add_fault(database_.fault());
    read_topics();
    // There are two queries: the first reads the index only or sorts numbers, and a damaged row
    // does not affect the other rows.
    order_.emplace(database_, "SELECT timestamp, rowid FROM messages ORDER BY timestamp, rowid");
    row_.emplace(database_, "SELECT topic_id, data FROM messages WHERE rowid = ?");
  }

  [[nodiscard]] std::span<const BagTopic> topics() const override { return topics_; }
  [[nodiscard]] std::span<const std::string> faults() const override { return faults_; }

  bool next(BagMessage& message) override {
    while (const auto place = next_place())
      if (read(*place, message)) return true;
    return false;
  }

 private:
  // Views do not count.
  void check_has_table(const char* name) const {
    if (!has_table(name))
      throw InputError(database_.file().string() + ": has no table '" + name +
                       "', as bags of ROS 2 have");
  }

  [[nodiscard]] bool has_table(const char* name) const {
    SqliteQuery query(database_,
                      "SELECT name FROM sqlite_master WHERE type = 'table' "
                      "AND sql NOT LIKE 'CREATE VIRTUAL%'");
    while (query.step() == SqliteQuery::Step::row)
      if (query.text(0) == name) return true;
    return false;
  }

  void read_topics() {
    const auto definitions = read_definitions();
    const auto qos = read_qos();
    SqliteQuery query(database_,
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
      add_fault("its topics cannot all be read: " + database_.failure());
  }

  [[nodiscard]] std::map<std::int64_t, OfferedQos> read_qos() const {
    std::map<std::int64_t, OfferedQos> all;
    if (!database_.has_column("topics", "offered_qos_profiles")) return all;
    SqliteQuery query(database_, "SELECT id, offered_qos_profiles FROM topics");
    while (query.step() == SqliteQuery::Step::row) {
      const auto id = query.integer(0);
      const auto profiles = query.text(1);
      if (id && profiles) all.emplace(*id, read_offered_qos(*profiles));
    }
    return all;
  }

  [[nodiscard]] std::map<std::string, std::string> read_definitions() const {
    std::map<std::string, std::string> definitions;
    if (!has_table("message_definitions")) return definitions;
    SqliteQuery query(
        database_,
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
                " (" + database_.failure() + "); the rest is left out");
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
                (step == SqliteQuery::Step::failed ? " (" + database_.failure() + ")" : "") +
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
    faults_.push_back(database_.file().string() + ": " +
                      (faults_.size() == most_faults ? "more faults, which are not listed" : what));
  }

  SqliteDatabase database_;
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
