// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>

#include <penumbra/robot/mesh_formats-inl.hpp>
#include <penumbra/robot/mesh_text-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

/// Walks an OBJ file's vertices and faces, with the line for messages.
class ObjCheck {
 public:
  void line(std::string_view line) {
    ++line_;
    const std::string_view keyword = take_word(line);
    if (keyword == "v") vertex(line);
    if (keyword == "f") face(line);
  }

  void finish() const {
    if (highest_ > vertices_)
      throw FormatError("OBJ, line " + std::to_string(highest_line_) + ": a face names vertex " +
                        std::to_string(highest_) + " of " + std::to_string(vertices_) +
                        "; it is truncated or damaged; export or copy it again");
  }

 private:
  void vertex(std::string_view line) {
    ++vertices_;
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = take_word(line);
      if (!parse_number<double>(word)) fail(word, "three coordinates");
    }
  }

  void face(std::string_view line) {
    int corners = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto index = parse_number<std::int64_t>(word.substr(0, word.find('/')));
      if (!index || *index == 0 || *index < -vertices_) fail(word, "a vertex's number");
      if (*index > highest_) {
        highest_ = *index;
        highest_line_ = line_;
      }
      ++corners;
    }
    if (corners < 3) fail("", "a face's third corner");
  }

  [[noreturn]] void fail(std::string_view word, const char* wanted) const {
    const std::string found =
        word.empty() ? "the line ends" : "'" + std::string(word.substr(0, 40)) + "' stands";
    throw FormatError("OBJ, line " + std::to_string(line_) + ": " + found + " where " + wanted +
                      " should stand; it is truncated or damaged; export or copy it again");
  }

  std::int64_t line_ = 0;
  std::int64_t vertices_ = 0;
  std::int64_t highest_ = 0;
  std::int64_t highest_line_ = 0;
};

}  // namespace

void check_obj(std::string_view bytes) {
  ObjCheck check;
  std::string joined;
  while (!bytes.empty()) {
    std::string_view line = take_line(bytes);
    if (!joined.empty() || line.ends_with('\\')) {
      joined += line;
      if (joined.ends_with('\\') && !bytes.empty()) {  // the line goes on in the next
        joined.back() = ' ';
        continue;
      }
      check.line(joined);
      joined.clear();
    } else {
      check.line(line);
    }
  }
  check.finish();
}

}  // namespace penumbra::mesh_formats
