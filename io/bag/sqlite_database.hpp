// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace penumbra::io {

/// A read-only, untrusted database file. Its size bounds the time and memory that reading takes.
class SqliteDatabase {
 public:
  /// Throws InputError that names the file if it is not a database.
  explicit SqliteDatabase(const std::filesystem::path& file);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  [[nodiscard]] sqlite3* get() const { return database_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// Returns what is wrong with a readable file, or an empty text.
  [[nodiscard]] const std::string& fault() const { return fault_; }

  /// Returns whether this table exists. Views do not count.
  [[nodiscard]] bool has_table(const std::string& name) const;
  [[nodiscard]] bool has_column(const std::string& table, const std::string& name) const;

  /// Returns SQLite's message of its last failure.
  [[nodiscard]] std::string failure() const;

 private:
  [[nodiscard]] bool open(bool immutable);
  void close();
  void limit();

  std::filesystem::path file_;
  std::uint64_t file_size_ = 0;
  std::uint64_t steps_left_ = 0;  // thousands of steps of SQLite's virtual machine
  sqlite3* database_ = nullptr;
  std::string fault_;
};

/// A query. step() returns its rows one by one.
class SqliteQuery {
 public:
  enum class Step { row, done, failed };

  /// Throws InputError that names the database's file if it lacks these columns or tables. The
  /// database must outlive this.
  SqliteQuery(const SqliteDatabase& database, const std::string& text);
  ~SqliteQuery();
  SqliteQuery(const SqliteQuery&) = delete;
  SqliteQuery& operator=(const SqliteQuery&) = delete;

  /// Restarts the query with a value for its "?".
  void restart(std::int64_t value);
  [[nodiscard]] Step step();

  // Return a column of the row, counted from 0, or nothing if the value is of another type. Valid
  // until the next step.
  [[nodiscard]] std::optional<std::int64_t> integer(int column) const;
  [[nodiscard]] std::optional<std::string> text(int column) const;
  [[nodiscard]] std::optional<std::span<const std::byte>> blob(int column) const;

 private:
  sqlite3_stmt* statement_ = nullptr;
};

}  // namespace penumbra::io
