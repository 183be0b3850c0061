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

/// A database file that is only read, and not trusted: what it takes in time and memory is bounded
/// by its size.
class SqliteDatabase {
 public:
  /// Throws InputError that names the file where it is no database.
  explicit SqliteDatabase(const std::filesystem::path& file);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  [[nodiscard]] sqlite3* get() const { return database_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// What is wrong with the file though it can be read; empty: nothing.
  [[nodiscard]] const std::string& fault() const { return fault_; }

  /// Whether there is such a table; a view is none.
  [[nodiscard]] bool has_table(const std::string& name) const;
  [[nodiscard]] bool has_column(const std::string& table, const std::string& name) const;

  /// What SQLite says of its last failure.
  [[nodiscard]] std::string failure() const;

 private:
  [[nodiscard]] bool open(bool immutable);
  void close();
  void limit();

  std::filesystem::path file_;
  std::uint64_t file_size_ = 0;
  std::uint64_t steps_left_ = 0;  // of SQLite's virtual machine, in thousands
  sqlite3* database_ = nullptr;
  std::string fault_;
};

/// A query whose rows are taken one by one.
class SqliteQuery {
 public:
  enum class Step { row, done, failed };

  /// Throws InputError that names the database's file where it has no such columns or tables. The
  /// database must outlive this.
  SqliteQuery(const SqliteDatabase& database, const std::string& text);
  ~SqliteQuery();
  SqliteQuery(const SqliteQuery&) = delete;
  SqliteQuery& operator=(const SqliteQuery&) = delete;

  /// Begins anew, with a value for the query's one "?".
  void restart(std::int64_t value);
  [[nodiscard]] Step step();

  // A row's columns, from 0; nothing where the value is of another type. Valid until the next step.
  [[nodiscard]] std::optional<std::int64_t> integer(int column) const;
  [[nodiscard]] std::optional<std::string> text(int column) const;
  [[nodiscard]] std::optional<std::span<const std::byte>> blob(int column) const;

 private:
  sqlite3_stmt* statement_ = nullptr;
};

}  // namespace penumbra::io
