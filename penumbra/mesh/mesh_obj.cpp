// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <penumbra/mesh/mesh_formats.hpp>

namespace penumbra::mesh_formats {
namespace {

/// Returns the next word of a line; empty at its end and before a comment.
std::string_view take_item(std::string_view& line) {
  const std::string_view word = take_word(line);
  return word.starts_with('#') ? std::string_view() : word;
}

/// Reads vertices, faces, lines and points. A face may come before its vertices, so the triangles
/// are made at the end.
class ObjReader {
 public:
  void read_line(std::string_view line) {
    ++line_;
    const std::string_view keyword = take_word(line);
    if (keyword == "v") vertex(line);
    if (keyword == "f") face(line);
    if (keyword == "l" || keyword == "p") corners(line);
  }

  /// `has_end`: the last line is complete.
  TriangleMesh finish(bool has_end) {
    const std::size_t count = mesh_.vertices.size();
    if (highest_ > vertex_count())
      damaged("OBJ, line " + std::to_string(highest_line_) + ": a corner names vertex " +
              std::to_string(highest_) + " of " + std::to_string(count));
    std::vector<bool> used(count);
    for (const std::uint32_t corner : corners_) used[corner] = true;
    const auto unused = std::count(used.begin(), used.end(), false);
    // Either alone occurs in complete files.
    if (!has_end && unused > 0)
      damaged("OBJ: the last line has no end and " + std::to_string(unused) + " of " +
              std::to_string(count) + " vertices are part of no face");
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
    // The format calls it the weight of a curve; some readers divide by it.
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
    damaged("OBJ, line " + std::to_string(line_) + ": " +
            (word.empty() ? "the line ends" : in_quotes(word)) + " instead of " + wanted);
  }

  struct Face {
    std::size_t first;
    std::size_t size;
  };

  std::int64_t line_ = 0;
  std::int64_t highest_ = 0;  // vertex number of a corner, counted from 1
  std::int64_t highest_line_ = 0;
  std::vector<std::uint32_t> corners_;  // of faces, lines and points
  std::vector<Face> faces_;
  TriangleMesh mesh_;
};

/// Calls f(line) for every line; a backslash at the end of a line continues it.
template <typename F>
void for_each_line(std::string_view bytes, F&& f) {
  std::string joined;
  while (!bytes.empty()) {
    std::string_view line = take_line(bytes);
    const bool continues = line.ends_with('\\') && !bytes.empty();
    if (joined.empty() && !continues) {
      f(line);
      continue;
    }
    if (continues) line.remove_suffix(1);
    joined.append(line).append(" ");
    if (continues) continue;
    f(std::string_view(joined));
    joined.clear();
  }
}

}  // namespace

TriangleMesh read_obj(std::string_view bytes) {
  ObjReader reader;
  for_each_line(bytes, [&](std::string_view line) { reader.read_line(line); });
  return reader.finish(bytes.ends_with('\n') || bytes.ends_with('\r'));
}

}  // namespace penumbra::mesh_formats
