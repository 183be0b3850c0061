// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>

#include <penumbra/mesh/mesh_formats.hpp>

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies");

namespace penumbra::mesh_formats {
namespace {

constexpr std::size_t header_size = 84;  // 80 bytes of text, the count of triangles
constexpr std::size_t facet_size = 50;   // normal, three corners, 16 bits of attributes

std::uint32_t count_in_header(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

std::uint64_t binary_size(std::uint64_t facets) { return header_size + facet_size * facets; }

TriangleMesh read_binary(std::string_view bytes) {
  const std::uint32_t count = count_in_header(bytes);
  TriangleMesh mesh;
  mesh.vertices.resize(std::size_t{3} * count);
  mesh.triangles.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const char* const corners = bytes.data() + header_size + facet_size * i + 12;
    std::memcpy(mesh.vertices[std::size_t{3} * i].data(), corners, 36);
    mesh.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
  }
  return mesh;
}

bool is_keyword(std::string_view word, std::string_view lower_case) {
  return std::equal(
      word.begin(), word.end(), lower_case.begin(), lower_case.end(),
      [](char c, char lower) { return (c >= 'A' && c <= 'Z' ? c + 32 : c) == lower; });
}

/// The words of an ASCII STL, with the line for messages.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  std::string_view next() {
    const std::string_view before = rest_;
    const std::string_view word = take_word(rest_);
    const auto skipped = before.substr(0, before.size() - rest_.size() - word.size());
    line_ += std::count(skipped.begin(), skipped.end(), '\n');
    return word;
  }

  void expect(std::string_view keyword) { expect(keyword, next()); }

  void expect(std::string_view keyword, std::string_view word) const {
    if (!is_keyword(word, keyword)) fail(word, std::string(keyword));
  }

  float number() {
    const std::string_view word = next();
    const auto value = parse_number<double>(word);
    if (!value) fail(word, "a number");
    return static_cast<float>(*value);
  }

  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

  [[noreturn]] void fail(std::string_view word, const std::string& expected) const {
    damaged("ASCII STL, line " + std::to_string(line_) + ": " +
            (word.empty() ? "the file ends" : in_quotes(word)) + " instead of " + expected);
  }

 private:
  std::string_view rest_;
  std::ptrdiff_t line_ = 1;
};

/// Reads what follows "facet". Ignores the normal, which is often wrong and sometimes NaN.
void read_facet(Words& words, TriangleMesh& mesh) {
  words.expect("normal");
  for (int i = 0; i < 3; ++i)
    if (words.next().empty()) words.fail("", "a number");
  words.expect("outer");
  words.expect("loop");
  for (int corner = 0; corner < 3; ++corner) {
    words.expect("vertex");
    const float x = words.number();
    const float y = words.number();
    const float z = words.number();
    mesh.vertices.emplace_back(x, y, z);
  }
  words.expect("endloop");
  words.expect("endfacet");
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({last - 3, last - 2, last - 1});
}

TriangleMesh read_ascii(std::string_view text) {
  TriangleMesh mesh;
  Words words(text);
  std::string_view word = words.next();
  while (!word.empty()) {  // some exporters write several solids
    words.expect("solid", word);
    words.skip_line();
    for (word = words.next(); is_keyword(word, "facet"); word = words.next())
      read_facet(words, mesh);
    words.expect("endsolid", word);
    words.skip_line();
    word = words.next();
  }
  return mesh;
}

bool looks_like_ascii(std::string_view bytes) {
  Words words(bytes);
  if (!is_keyword(words.next(), "solid")) return false;
  return bytes.substr(0, 4096).find('\0') == std::string_view::npos;
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes) {
  const bool has_header = bytes.size() >= header_size;
  // The size decides: binary files whose header begins with "solid" exist.
  if (has_header && bytes.size() == binary_size(count_in_header(bytes))) return read_binary(bytes);
  if (looks_like_ascii(bytes)) return read_ascii(bytes);
  if (!has_header) damaged("STL of less than 84 bytes that does not begin with 'solid'");
  // More bytes may be triangles that a damaged count leaves out.
  const std::uint32_t count = count_in_header(bytes);
  damaged("binary STL: its header promises " + std::to_string(count) + " triangles, which are " +
          std::to_string(binary_size(count)) + " bytes, but the file has " +
          std::to_string(bytes.size()) + " bytes");
}

}  // namespace penumbra::mesh_formats
