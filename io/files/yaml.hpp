// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/error.hpp>

namespace penumbra::io {

/// A value of a YAML file. Members throw InputError with file, line and key
/// ("recording.yaml:12: camera.tolerance: ...").
class YamlNode {
 public:
  /// Reads a file with one document. Errors are: doubled keys, aliases, keys that are not plain
  /// texts, several documents, more than a million lines, commas and brackets, and files above
  /// FileLimit::text.
  [[nodiscard]] static YamlNode read(const std::filesystem::path& file);

  /// The same from text; `file` is for messages.
  [[nodiscard]] static YamlNode parse(const std::string& text, const std::filesystem::path& file);

  /// Returns all documents of a text, at least one. An empty document after its mark (---) is null.
  [[nodiscard]] static std::vector<YamlNode> parse_all(const std::string& text,
                                                       const std::filesystem::path& file);

  [[nodiscard]] const std::string& key() const { return key_; }  ///< in its map; else empty
  [[nodiscard]] bool is_null() const { return kind_ == Kind::null; }
  [[nodiscard]] bool is_map() const { return kind_ == Kind::map; }
  [[nodiscard]] bool is_list() const { return kind_ == Kind::list; }

  /// Returns a map's value of `key`. Without one at() throws, and find() returns null.
  [[nodiscard]] const YamlNode* find(std::string_view key) const;
  [[nodiscard]] const YamlNode& at(std::string_view key) const;

  /// Throws for a key of this map that is not among `known`.
  void allow_only(std::span<const std::string_view> known) const;
  void allow_only(std::initializer_list<std::string_view> known) const {
    allow_only(std::span(known.begin(), known.size()));
  }

  /// Return the values of a map or list, in the file's order.
  [[nodiscard]] std::span<const YamlNode> entries() const;
  [[nodiscard]] std::span<const YamlNode> items() const;

  [[nodiscard]] const std::string& text() const;           ///< not empty
  [[nodiscard]] const std::string& text_or_empty() const;  ///< '' is a text, nothing is none
  [[nodiscard]] double number() const;                     ///< finite
  [[nodiscard]] std::int64_t integer() const;
  [[nodiscard]] bool boolean() const;  ///< true or false, nothing else
  [[nodiscard]] std::vector<double> numbers() const;
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;
  [[nodiscard]] std::vector<std::string> texts() const;

  /// Throws for this value. `what`: what is wrong, and what would be right.
  [[noreturn]] void fail(const std::string& what) const;

  /// Runs `call`. An InputError that it throws becomes a fault of this value.
  template <typename F>
  auto with_context(const F& call) const {
    try {
      return call();
    } catch (const InputError& fault) {
      fail(fault.what());
    }
  }

 private:
  enum class Kind { null, scalar, list, map };
  friend class YamlBuilder;

  [[nodiscard]] std::string described() const;

  std::shared_ptr<const std::string> file_;
  std::string key_;
  std::string path_;  // keys from the root, with dots
  int line_ = 0;      // from 1
  Kind kind_ = Kind::null;
  std::string text_;
  bool quoted_ = false;
  std::vector<YamlNode> children_;
};

}  // namespace penumbra::io
