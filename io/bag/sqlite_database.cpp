// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string_view>

#include <sqlite3.h>

#include <io/bag/sqlite_database.hpp>
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

bool answers(sqlite3* database, const char* query) {
  return sqlite3_exec(database, query, nullptr, nullptr, nullptr) == SQLITE_OK;
}

}  // namespace

// A killed recorder leaves a journal next to its file, which has to be read too. Without a journal,
// no file is written next to the recording.
SqliteDatabase::SqliteDatabase(const std::filesystem::path& file) : file_(file) {
  InputFile input;
  input.open(file).require();
  file_size_ = input.size();
  FileStart start{};
  if (input.read(start.data(), start.size()) != start.size() ||
      !std::string_view(start.data(), start.size()).starts_with(sqlite_magic))
    throw InputError(file.string() + ": is not an SQLite database, as *.db3 bags are");

  const bool journal =
      size_of(with_suffix(file, "-wal")) + size_of(with_suffix(file, "-journal")) > 0;
  if (!journal) check_pages(file, file_size_, start);
  if (open(!journal)) return;
  std::string first = failure();
  if (journal && open(true)) {
    fault_ = "the journal next to it cannot be read (" + first + ") and is ignored";
    return;
  }
  // With this setting a truncated file can be read: its size may differ from the one in its first
  // page.
  if (database_ != nullptr && answers(database_, "PRAGMA writable_schema=ON") &&
      answers(database_, "SELECT count(*) FROM sqlite_master")) {
    fault_ = "is cut or damaged (" + first + "); the readable part is read";
    return;
  }
  close();
  throw InputError(file.string() + ": cannot be read: " + first);
}

SqliteDatabase::~SqliteDatabase() { close(); }

bool SqliteDatabase::open(bool immutable) {
  close();
  constexpr int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(uri_of(file_, immutable).c_str(), &database_, flags, nullptr) != SQLITE_OK)
    return false;
  limit();
  return answers(database_, "SELECT count(*) FROM sqlite_master");
}

void SqliteDatabase::close() {
  sqlite3_close(database_);
  database_ = nullptr;
}

void SqliteDatabase::limit() {
  sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  const std::uint64_t longest = std::clamp<std::uint64_t>(file_size_, 1 << 20, 1 << 30);
  sqlite3_limit(database_, SQLITE_LIMIT_LENGTH, static_cast<int>(longest));
  steps_left_ = (steps_at_least + steps_per_byte * file_size_) / steps_at_once;
  sqlite3_progress_handler(database_, steps_at_once, count_down, &steps_left_);
}

bool SqliteDatabase::has_table(const std::string& name) const {
  SqliteQuery query(*this, "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = '" +
                               name + "' AND sql NOT LIKE 'CREATE VIRTUAL%'");
  return query.step() == SqliteQuery::Step::row && query.integer(0).value_or(0) > 0;
}

bool SqliteDatabase::has_column(const std::string& table, const std::string& name) const {
  return sqlite3_table_column_metadata(database_, nullptr, table.c_str(), name.c_str(), nullptr,
                                       nullptr, nullptr, nullptr, nullptr) == SQLITE_OK;
}

std::string SqliteDatabase::failure() const { return printable(sqlite3_errmsg(database_)); }

SqliteQuery::SqliteQuery(const SqliteDatabase& database, const std::string& text) {
  const int result = sqlite3_prepare_v2(database.get(), text.c_str(), -1, &statement_, nullptr);
  if (result != SQLITE_OK)
    throw InputError(database.file().string() +
                     ": is not a bag that can be read: " + database.failure());
}

SqliteQuery::~SqliteQuery() { sqlite3_finalize(statement_); }

void SqliteQuery::restart(std::int64_t value) {
  sqlite3_reset(statement_);
  sqlite3_bind_int64(statement_, 1, value);
}

SqliteQuery::Step SqliteQuery::step() {
  const int result = sqlite3_step(statement_);
  if (result == SQLITE_ROW) return Step::row;
  return result == SQLITE_DONE ? Step::done : Step::failed;
}

std::optional<std::int64_t> SqliteQuery::integer(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_INTEGER) return std::nullopt;
  return sqlite3_column_int64(statement_, column);
}

std::optional<std::string> SqliteQuery::text(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_TEXT) return std::nullopt;
  const void* text = sqlite3_column_text(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  if (text == nullptr) return std::nullopt;
  return std::string(static_cast<const char*>(text), static_cast<std::size_t>(size));
}

std::optional<std::span<const std::byte>> SqliteQuery::blob(int column) const {
  if (sqlite3_column_type(statement_, column) != SQLITE_BLOB) return std::nullopt;
  const void* bytes = sqlite3_column_blob(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  if (bytes == nullptr) return std::span<const std::byte>{};
  return std::span(static_cast<const std::byte*>(bytes), static_cast<std::size_t>(size));
}

}  // namespace penumbra::io
