// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_map>
#include <utility>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <penumbra/base/whole_file-inl.hpp>

#include <io/files/names.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>
#include <io/files/yaml.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t max_depth = 16;
constexpr std::ptrdiff_t max_marks = 1'000'000;  // a token each, which takes 200 bytes
constexpr std::size_t max_quoted = 60;           // letters of the file that a message repeats

std::string quoted(const std::string& text) {
  std::string shown = "'";
  for (const char c : text.substr(0, max_quoted))
    shown += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  return shown + (text.size() > max_quoted ? "...'" : "'");
}

}  // namespace

// Builds the tree from yaml-cpp's events. Unlike its nodes, they show doubled keys and aliases.
class YamlBuilder : public YAML::EventHandler {
 public:
  explicit YamlBuilder(const std::filesystem::path& file)
      : file_(std::make_shared<const std::string>(file.string())) {
    root_.file_ = file_;
    root_.line_ = 1;
  }

  YamlNode& root() { return root_; }

  /// Letters of the text before the document.
  [[nodiscard]] int start() const { return start_.pos; }

  void OnDocumentStart(const YAML::Mark& mark) override { start_ = mark; }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    add(mark, YamlNode::Kind::null, "", false);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "aliases (*name) are not read; write the value out");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    if (!open_.empty() && open_.back().node->is_map() && !key_) {
      take_key(mark, value);
    } else {
      add(mark, YamlNode::Kind::scalar, value, tag == "!");
    }
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark, YamlNode::Kind::list);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark, YamlNode::Kind::map);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(*file_ + ":" + std::to_string(mark.line + 1) + ": " + what);
  }

  void take_key(const YAML::Mark& mark, const std::string& key) {
    key_line_ = mark.line + 1;
    const auto [first, is_new] = open_.back().key_lines.emplace(key, key_line_);
    if (!is_new)
      fail(mark, "key " + quoted(key) + " is there already, in line " +
                     std::to_string(first->second) + "; keep one");
    key_ = key;
  }

  // Pointers to parents stay valid: a list of children only grows while its last child is closed.
  YamlNode& add(const YAML::Mark& mark, YamlNode::Kind kind, const std::string& text,
                bool is_quoted) {
    YamlNode* node = &root_;
    if (!open_.empty()) {
      YamlNode& parent = *open_.back().node;
      if (parent.is_map() && !key_) fail(mark, "a key must be a plain text");
      node = &parent.children_.emplace_back();
      node->path_ = parent.path_;
      if (parent.is_map()) {
        node->key_ = *key_;
        node->path_ += (parent.path_.empty() ? "" : ".") + *key_;
      } else {
        node->path_ += "[" + std::to_string(parent.children_.size() - 1) + "]";
      }
    }
    node->file_ = file_;
    node->line_ = key_ ? key_line_ : mark.line + 1;
    node->kind_ = kind;
    node->text_ = text;
    node->quoted_ = is_quoted;
    key_.reset();
    return *node;
  }

  void enter(const YAML::Mark& mark, YamlNode::Kind kind) {
    if (open_.size() == max_depth)
      fail(mark, "values are nested more than " + std::to_string(max_depth) + " deep");
    open_.push_back({&add(mark, kind, "", false), {}});
  }

  /// A map or list whose end is not there yet.
  struct Open {
    YamlNode* node = nullptr;
    std::unordered_map<std::string, int> key_lines;  // of a map
  };

  std::shared_ptr<const std::string> file_;
  YamlNode root_;
  std::vector<Open> open_;
  std::optional<std::string> key_;
  int key_line_ = 0;
  YAML::Mark start_;
};

YamlNode YamlNode::read(const std::filesystem::path& file) {
  return parse(read_whole_file(file, FileLimit::text), file);
}

YamlNode YamlNode::parse(const std::string& text, const std::filesystem::path& file) {
  std::vector<YamlNode> documents = parse_all(text, file);
  if (documents.size() > 1) documents[1].fail("has more than one document (---)");
  return std::move(documents.front());
}

std::vector<YamlNode> YamlNode::parse_all(const std::string& text,
                                          const std::filesystem::path& file) {
  constexpr std::string_view marks = "[]{},:-?\n";
  if (std::count_if(text.begin(), text.end(),
                    [&](char c) { return marks.find(c) != std::string_view::npos; }) > max_marks)
    throw InputError(file.string() + ": has more than " + std::to_string(max_marks) +
                     " lines, commas and brackets; check that it is the right file");
  std::vector<YamlNode> documents;
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    for (int last = -1;;) {
      YamlBuilder builder(file);
      if (!parser.HandleNextDocument(builder)) break;
      // A stray closing bracket is no document, and the parser does not step over it.
      if (builder.start() <= last) builder.root().fail("is not YAML: a mark that closes nothing");
      last = builder.start();
      documents.push_back(std::move(builder.root()));
    }
    if (documents.empty()) YamlBuilder(file).root().fail("is empty");
  } catch (const YAML::Exception& fault) {
    throw InputError(file.string() + ":" + std::to_string(fault.mark.line + 1) +
                     ": is not YAML: " + printable(fault.msg));
  }
  return documents;
}

const YamlNode* YamlNode::find(std::string_view key) const {
  for (const YamlNode& child : entries())
    if (child.key_ == key) return &child;
  return nullptr;
}

const YamlNode& YamlNode::at(std::string_view key) const {
  if (const YamlNode* child = find(key)) return *child;
  fail("key '" + std::string(key) + "' is missing");
}

void YamlNode::allow_only(std::span<const std::string_view> known) const {
  const YamlNode* first = nullptr;
  std::string others;
  for (const YamlNode& child : entries()) {
    if (std::find(known.begin(), known.end(), child.key_) != known.end()) continue;
    if (first != nullptr) others += (others.empty() ? "" : ", ") + child.key_;
    if (first == nullptr) first = &child;
  }
  if (first == nullptr) return;
  first->fail("unknown key" + (others.empty() ? "" : " (unknown, too: " + printable(others) + ")") +
              near_names(first->key_, known));
}

std::span<const YamlNode> YamlNode::entries() const {
  if (kind_ != Kind::map) fail("is " + described() + "; expected keys with values");
  return children_;
}

std::span<const YamlNode> YamlNode::items() const {
  if (kind_ != Kind::list) fail("is " + described() + "; expected a list");
  return children_;
}

const std::string& YamlNode::text() const {
  if (kind_ != Kind::scalar || text_.empty()) fail("is " + described() + "; expected a text");
  return text_or_empty();
}

const std::string& YamlNode::text_or_empty() const {
  if (kind_ != Kind::scalar) fail("is " + described() + "; expected a text");
  if (text_.find('\0') != std::string::npos) fail("holds a character 0");
  return text_;
}

double YamlNode::number() const {
  if (kind_ == Kind::scalar && !quoted_)
    if (const auto value = parse_number<double>(text_)) return *value;
  fail("is " + described() + "; expected a finite number");
}

std::int64_t YamlNode::integer() const {
  if (kind_ == Kind::scalar && !quoted_)
    if (const auto value = parse_number<std::int64_t>(text_)) return *value;
  fail("is " + described() + "; expected a whole number");
}

bool YamlNode::boolean() const {
  if (kind_ == Kind::scalar && !quoted_) {
    if (text_ == "true" || text_ == "True" || text_ == "TRUE") return true;
    if (text_ == "false" || text_ == "False" || text_ == "FALSE") return false;
  }
  fail("is " + described() + "; expected true or false");
}

std::vector<double> YamlNode::numbers() const {
  std::vector<double> values;
  for (const YamlNode& item : items()) values.push_back(item.number());
  return values;
}

std::vector<double> YamlNode::numbers(std::size_t count) const {
  std::vector<double> values = numbers();
  if (values.size() != count)
    fail("has " + std::to_string(values.size()) + " values; expected " + std::to_string(count));
  return values;
}

std::vector<std::string> YamlNode::texts() const {
  std::vector<std::string> values;
  for (const YamlNode& item : items()) values.push_back(item.text());
  return values;
}

void YamlNode::fail(const std::string& what) const {
  throw InputError(*file_ + ":" + std::to_string(line_) + ": " +
                   (path_.empty() ? "" : without_controls(path_) + ": ") + what);
}

std::string YamlNode::described() const {
  switch (kind_) {
    case Kind::null:
      return "empty";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
    case Kind::scalar:
      break;
  }
  return quoted(text_);
}

}  // namespace penumbra::io
