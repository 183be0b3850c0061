// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <vector>

#include <penumbra/robot/mesh_formats-inl.hpp>
#include <penumbra/robot/mesh_text-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

/// The next word of a line; empty before a comment too.
std::string_view take_item(std::string_view& line) {
  const std::string_view word = take_word(line);
  return word.starts_with('#') ? std::string_view() : word;
}

/// Walks an OBJ file's vertices, faces, lines and points, with the line for messages.
class ObjCheck {
 public:
  void line(std::string_view line) {
    ++line_;
    const std::string_view keyword = take_word(line);
    if (keyword == "v") vertex(line);
    if (keyword == "f") face(line);
    if (keyword == "l" || keyword == "p") corners(line);
  }

  /// Throws where what the file names is not there; what it holds and does not name, in words.
  [[nodiscard]] std::string finish() {
    if (highest_ > vertices_)
      damaged("OBJ, line " + std::to_string(highest_line_) + ": a corner names vertex " +
              std::to_string(highest_) + " of " + std::to_string(vertices_));
    used_.resize(static_cast<std::size_t>(vertices_));
    for (const std::int64_t index : ahead_) used_[static_cast<std::size_t>(index - 1)] = true;
    const auto unused = std::count(used_.begin(), used_.end(), false);
    if (unused == 0) return {};
    return std::to_string(unused) + " of its " + std::to_string(vertices_) +
           " vertices are part of no face";
  }

 private:
  void vertex(std::string_view line) {
    ++vertices_;
    std::size_t count = 0;
    double last = 0.0;
    for (std::string_view word = take_item(line); count < 3 || !word.empty();
         word = take_item(line), ++count) {
      const auto number = parse_number<double>(word);
      if (!number || !std::isfinite(*number))
        fail(word, count < 3 ? "three coordinates" : "a colour's number");
      last = *number;
    }
    // A weight of curves in the format's own words, a divisor to some readers.
    if (count == 4 && last != 1.0)
      throw FormatError("OBJ, line " + std::to_string(line_) +
                        ": a vertex has a fourth coordinate, which is not 1; export it with three");
  }

  void face(std::string_view line) {
    const std::size_t count = corners(line);
    if (count < 3) fail("", "a face's third corner");
    check_corners(count);
  }

  std::size_t corners(std::string_view line) {
    std::size_t count = 0;
    for (std::string_view word = take_item(line); !word.empty(); word = take_item(line), ++count) {
      const auto index = parse_number<std::int64_t>(word.substr(0, word.find('/')));
      if (!index || *index == 0 || *index < -vertices_) fail(word, "a vertex's number");
      use(*index < 0 ? vertices_ + 1 + *index : *index);
    }
    return count;
  }

  void use(std::int64_t index) {
    if (index > highest_) {
      highest_ = index;
      highest_line_ = line_;
    }
    used_.resize(static_cast<std::size_t>(vertices_));
    if (index <= vertices_)
      used_[static_cast<std::size_t>(index - 1)] = true;
    else
      ahead_.push_back(index);
  }

  [[noreturn]] void fail(std::string_view word, const char* wanted) const {
    const std::string found =
        word.empty() ? "the line ends" : "'" + std::string(word.substr(0, 40)) + "' stands";
    damaged("OBJ, line " + std::to_string(line_) + ": " + found + " where " + wanted +
            " should stand");
  }

  std::int64_t line_ = 0;
  std::int64_t vertices_ = 0;
  std::int64_t highest_ = 0;
  std::int64_t highest_line_ = 0;
  std::vector<bool> used_;           // of the vertices so far
  std::vector<std::int64_t> ahead_;  // named before they stand in the file
};

/// Calls f(line) for every line; one that ends with a backslash goes on in the next.
template <typename F>
void for_each_line(std::string_view bytes, F&& f) {
  std::string joined;
  while (!bytes.empty()) {
    const std::string_view line = take_any_line(bytes);
    if (joined.empty() && !line.ends_with('\\')) {
      f(line);
      continue;
    }
    joined += line;
    if (joined.ends_with('\\') && !bytes.empty()) {
      joined.back() = ' ';
      continue;
    }
    f(std::string_view(joined));
    joined.clear();
  }
}

/// The number as Assimp reads it: it takes no word for one that begins with a point.
template <typename Number>
void append_number(std::optional<Number> number, std::string& text) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number.value()).ptr;
  text.append(" ").append(buffer.data(), end);
}

}  // namespace

std::string check_obj(std::string_view bytes) {
  const bool has_end = bytes.ends_with('\n') || bytes.ends_with('\r');
  ObjCheck check;
  for_each_line(bytes, [&](std::string_view line) { check.line(line); });
  std::string unused = check.finish();
  // Either alone is what sound files of careless exporters show, so that a file cut behind a line
  // passes with a note; a cut inside a line nearly always shows both.
  if (!has_end && !unused.empty())
    throw FormatError("OBJ: " + unused +
                      " and the last line has no end; it is truncated: export or copy it again");
  if (!unused.empty()) return unused;
  return has_end ? "" : "its last line has no end";
}

std::string surface_of_obj(std::string_view bytes) {
  std::string surface;
  surface.reserve(bytes.size());
  for_each_line(bytes, [&](std::string_view line) {
    const std::string_view keyword = take_word(line);
    if (keyword != "v" && keyword != "f") return;
    surface += keyword;
    if (keyword == "v")
      for (int i = 0; i < 3; ++i) append_number(parse_number<double>(take_item(line)), surface);
    else
      for (std::string_view word = take_item(line); !word.empty(); word = take_item(line))
        append_number(parse_number<std::int64_t>(word.substr(0, word.find('/'))), surface);
    surface += '\n';
  });
  return surface;
}

}  // namespace penumbra::mesh_formats
