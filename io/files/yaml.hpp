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

/// A value of a YAML file that knows where it stands: everything that throws, throws InputError
/// with file, line and key ("recording.yaml:12: camera.tolerance: ...").
class YamlNode {
 public:
  /// Returns the file's one document. Doubled keys, aliases, keys that are no plain texts, several
  /// documents, more than a million lines, commas and brackets and files above
  /// FileLimit::text are errors.
  [[nodiscard]] static YamlNode read(const std::filesystem::path& file);

  /// The same from text; `file` is for messages.
  [[nodiscard]] static YamlNode parse(const std::string& text, const std::filesystem::path& file);

  /// Every document of a text, in order, at least one; one of nothing but its mark (---) is null.
  [[nodiscard]] static std::vector<YamlNode> parse_all(const std::string& text,
                                                       const std::filesystem::path& file);

  [[nodiscard]] const std::string& key() const { return key_; }  ///< in its map; else empty
  [[nodiscard]] bool is_null() const { return kind_ == Kind::null; }
  [[nodiscard]] bool is_map() const { return kind_ == Kind::map; }
  [[nodiscard]] bool is_list() const { return kind_ == Kind::list; }

  /// A map's value of `key`; at() throws if there is none, find() answers null.
  [[nodiscard]] const YamlNode* find(std::string_view key) const;
  [[nodiscard]] const YamlNode& at(std::string_view key) const;

  /// Throws for a key of this map that is not among `known`.
  void allow_only(std::initializer_list<std::string_view> known) const;

  /// Values of a map or list, in the file's order.
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

  /// Throws for this value: `what` says what is wrong and what would be right.
  [[noreturn]] void fail(const std::string& what) const;

  /// Runs `call`; an InputError that it throws is told as a fault of this value.
  template <typename F>
  auto blamed_for(const F& call) const {
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
