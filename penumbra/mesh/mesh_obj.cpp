// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <penumbra/mesh/mesh_formats-inl.hpp>
#include <penumbra/mesh/mesh_polygon-inl.hpp>
#include <penumbra/mesh/mesh_text-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

/// The next word of a line; empty before a comment too.
std::string_view take_item(std::string_view& line) {
  const std::string_view word = take_word(line);
  return word.starts_with('#') ? std::string_view() : word;
}

/// Reads vertices, faces, lines and points. A face may stand before its vertices, so faces become
/// triangles at the end.
class ObjReader {
 public:
  void read_line(std::string_view line) {
    ++line_;
    const std::string_view keyword = take_word(line);
    if (keyword == "v") vertex(line);
    if (keyword == "f") face(line);
    if (keyword == "l" || keyword == "p") corners(line);
  }

  /// Throws where what the file names is not there; notes what it holds and does not name.
  TriangleMesh finish(bool has_end, std::string& oddity) {
    if (highest_ > vertex_count())
      damaged("OBJ, line " + std::to_string(highest_line_) + ": a corner names vertex " +
              std::to_string(highest_) + " of " + std::to_string(vertex_count()));
    std::vector<bool> used(mesh_.vertices.size());
    for (const std::uint32_t corner : corners_) used[corner] = true;
    const auto unused = std::count(used.begin(), used.end(), false);
    if (unused > 0)
      oddity = std::to_string(unused) + " of its " + std::to_string(vertex_count()) +
               " vertices are part of no face";
    // Either alone is what sound files of careless exporters show, so that a file cut behind a line
    // passes with a note; a cut inside a line nearly always shows both.
    if (!has_end && unused > 0)
      throw FormatError("OBJ: " + oddity +
                        " and the last line has no end; it is truncated: export or copy it again");
    if (!has_end) oddity = "its last line has no end";
    for (const Face& face : faces_)
      append_polygon(std::span(corners_).subspan(face.first, face.size), mesh_);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::int64_t vertex_count() const {
    return static_cast<std::int64_t>(mesh_.vertices.size());
  }

  void vertex(std::string_view line) {
    Eigen::Vector3d place;
    for (double& coordinate : place) coordinate = number(take_item(line), "three coordinates");
    std::size_t more = 0;
    double last = 0.0;
    for (std::string_view word = take_item(line); !word.empty(); word = take_item(line), ++more)
      last = number(word, "a colour's number");
    // A weight of curves in the format's own words, a divisor to some readers.
    if (more == 1 && last != 1.0)
      throw FormatError("OBJ, line " + std::to_string(line_) +
                        ": a vertex has a fourth coordinate, which is not 1; export it with three");
    mesh_.vertices.push_back(place.cast<float>());
  }

  void face(std::string_view line) {
    const std::size_t first = corners_.size();
    corners(line);
    faces_.push_back({first, corners_.size() - first});
    if (faces_.back().size < 3) fail("", "a face's third corner");
  }

  void corners(std::string_view line) {
    for (std::string_view word = take_item(line); !word.empty(); word = take_item(line)) {
      const auto number = parse_number<std::int64_t>(word.substr(0, word.find('/')));
      if (!number || *number == 0 || *number < -vertex_count()) fail(word, "a vertex's number");
      const std::int64_t index = *number < 0 ? vertex_count() + 1 + *number : *number;
      if (index > highest_) {
        highest_ = index;
        highest_line_ = line_;
      }
      corners_.push_back(static_cast<std::uint32_t>(index - 1));
    }
  }

  [[nodiscard]] double number(std::string_view word, const char* wanted) const {
    const auto number = parse_number<double>(word);
    if (!number || !std::isfinite(*number)) fail(word, wanted);
    return *number;
  }

  [[noreturn]] void fail(std::string_view word, const char* wanted) const {
    const std::string found =
        word.empty() ? "the line ends" : "'" + std::string(word.substr(0, 40)) + "' stands";
    damaged("OBJ, line " + std::to_string(line_) + ": " + found + " where " + wanted +
            " should stand");
  }

  struct Face {
    std::size_t first;
    std::size_t size;
  };

  std::int64_t line_ = 0;
  std::int64_t highest_ = 0;  // of the corners' numbers, which begin with 1
  std::int64_t highest_line_ = 0;
  std::vector<std::uint32_t> corners_;  // of faces, lines and points
  std::vector<Face> faces_;
  TriangleMesh mesh_;
};

/// Calls f(line) for every line; one that ends with a backslash goes on in the next.
template <typename F>
void for_each_line(std::string_view bytes, F&& f) {
  std::string joined;
  while (!bytes.empty()) {
    const std::string_view line = take_line(bytes);
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

}  // namespace

TriangleMesh read_obj(std::string_view bytes, std::string& oddity) {
  ObjReader reader;
  for_each_line(bytes, [&](std::string_view line) { reader.read_line(line); });
  return reader.finish(bytes.ends_with('\n') || bytes.ends_with('\r'), oddity);
}

}  // namespace penumbra::mesh_formats
