// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <penumbra/base/text.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra::mesh_formats {

using detail::in_quotes;

/// A fault in a file's bytes and its remedy; the caller adds the file's name.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws FormatError for a file that was cut off or altered.
[[noreturn]] inline void damaged(const std::string& what) {
  throw FormatError(what + "; it is truncated or damaged; export or copy it again");
}

/// The most triangles of all instances in a scene.
inline constexpr std::size_t most_triangles = 100'000'000;

[[nodiscard]] TriangleMesh read_stl(std::string_view bytes);
[[nodiscard]] TriangleMesh read_obj(std::string_view bytes);
[[nodiscard]] TriangleMesh read_ply(std::string_view bytes);

/// Reads the scene of a Collada file. Refuses unknown elements in geometry.
[[nodiscard]] TriangleMesh read_collada(std::string_view bytes);

/// Reads the scene of a .gltf or, if `binary`, a .glb file. Opens buffer files next to `file`.
[[nodiscard]] TriangleMesh read_gltf(const std::filesystem::path& file, std::string_view bytes,
                                     bool binary);

/// Appends a part of a scene at its pose; reverses the triangles of a mirrored part. Throws
/// FormatError if the mesh would exceed most_triangles.
void append_placed(const TriangleMesh& part, const Eigen::Affine3d& T_file_part,
                   TriangleMesh& mesh);

/// Appends triangles that cover the polygon of these vertices of `mesh`, which may be concave or
/// not quite plane; none for fewer than three corners. Corners on a line give triangles of zero
/// area, so that every edge keeps its neighbour. The indices must be in range. Throws FormatError
/// for more than 4000 corners.
void append_polygon(std::span<const std::uint32_t> corners, TriangleMesh& mesh);

/// Removes the next word from `text` and returns it; empty at the end.
inline std::string_view take_word(std::string_view& text) {
  const auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end = std::find_if(begin, text.end(), is_space);
  const std::string_view word(begin, end);
  text = std::string_view(end, text.end());
  return word;
}

/// Removes the next line from `text` and returns it without its end: LF, CR LF or CR alone.
inline std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(line.size());
  text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
  return line;
}

/// Parses a number that fills the whole word. Use double to read floats: it holds every value.
template <typename Number>
std::optional<Number> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// Checks an index that a file names and converts it.
template <typename Number>
[[nodiscard]] std::uint32_t vertex_index(Number index, std::size_t count,
                                         const std::string& where) {
  if (index >= Number{0} && index < static_cast<Number>(count) &&
      index == static_cast<Number>(static_cast<std::uint32_t>(index)))
    return static_cast<std::uint32_t>(index);
  damaged(where + ": a face names vertex " + std::to_string(index) + " of " +
          std::to_string(count));
}

}  // namespace penumbra::mesh_formats
