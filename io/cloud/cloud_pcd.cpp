// SPDX-License-Identifier: Apache-2.0
// Format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html
#include <cstring>
#include <map>
#include <span>
#include <utility>

#include <io/cloud/cloud_formats-inl.hpp>

namespace penumbra::io::cloud_formats {
namespace {

using PcdWords = std::vector<std::string_view>;
using PcdLines = std::map<std::string_view, PcdWords>;  // by their first word

/// Takes the lines up to DATA.
PcdLines take_pcd_header(std::string_view& rest) {
  PcdLines lines;
  for (;;) {
    if (rest.empty()) damaged("PCD: no line DATA in the first 65536 bytes");
    std::string_view line = take_line(rest);
    const std::string_view keyword = take_word(line);
    if (keyword.empty() || keyword.starts_with('#')) continue;
    PcdWords& words = lines[keyword];
    words.clear();
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line))
      words.push_back(word);
    if (keyword == "DATA") return lines;
  }
}

std::uint64_t pcd_number(std::string_view word, const char* keyword) {
  const auto number = parse_number<std::uint64_t>(word);
  if (!number) damaged(std::string("PCD: ") + keyword + " " + in_quotes(word) + " is no count");
  return *number;
}

std::uint64_t pcd_number(PcdLines& lines, const char* keyword) {
  const PcdWords& words = lines[keyword];
  if (words.size() != 1) damaged(std::string("PCD: no line ") + keyword + " with one number");
  return pcd_number(words[0], keyword);
}

void add_pcd_fields(PcdLines& lines, PointCloud2Message& cloud) {
  const PcdWords &names = lines["FIELDS"], &sizes = lines["SIZE"], &types = lines["TYPE"];
  PcdWords& counts = lines["COUNT"];
  if (counts.empty()) counts.assign(names.size(), "1");
  if (sizes.size() != names.size() || types.size() != names.size() || counts.size() != names.size())
    damaged("PCD: FIELDS, SIZE, TYPE and COUNT have different lengths");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const char kind = types[i].size() == 1 ? types[i][0] : '?';
    add_field(cloud, std::string(names[i]),
              datatype_of(kind, pcd_number(sizes[i], "SIZE"), names[i]),
              pcd_number(counts[i], "COUNT"));
  }
}

/// Decodes what liblzf compressed: runs of bytes, and references back to decoded ones.
Bytes decode_lzf(std::span<const std::byte> in, std::size_t size) {
  Bytes out;  // grows as it is decoded, as `size` may lie
  std::size_t at = 0;
  const auto take = [&] {
    if (at == in.size()) damaged("PCD: the compressed points end within a reference");
    return std::to_integer<std::size_t>(in[at++]);
  };
  while (at < in.size() && out.size() <= size) {
    const std::size_t control = take();
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > in.size() - at) damaged("PCD: the compressed points end within a run");
      const auto run = in.subspan(at, length);
      out.insert(out.end(), run.begin(), run.end());
      at += length;
      continue;
    }
    const std::size_t length = 2 + (control < 224 ? control >> 5U : 7 + take());
    const std::size_t distance = 1 + ((control & 31U) << 8U) + take();
    if (distance > out.size()) damaged("PCD: the compressed points refer to before their first");
    for (std::size_t i = 0; i < length; ++i) {  // may overlap
      const std::byte value = out[out.size() - distance];
      out.push_back(value);
    }
  }
  if (out.size() != size) damaged("PCD: the points do not decompress to the size in the file");
  return out;
}

StoredCloud take_compressed(PointCloud2Message cloud, std::span<const std::byte> body) {
  std::array<std::uint32_t, 2> sizes{};  // compressed, decompressed
  if (body.size() < sizeof sizes) damaged("PCD: it ends before the compressed points");
  std::memcpy(sizes.data(), body.data(), sizeof sizes);
  body = body.subspan(sizeof sizes);
  if (sizes[0] > body.size())
    damaged("PCD: the compressed points take " + std::to_string(sizes[0]) + " bytes, and " +
            std::to_string(body.size()) + " follow");
  check_end(body.subspan(sizes[0]));
  if (sizes[1] != total_bytes(cloud))
    damaged("PCD: the points decompress to " + std::to_string(sizes[1]) +
            " bytes; the header says " + std::to_string(total_bytes(cloud)));
  StoredCloud stored = take_binary(std::move(cloud), decode_lzf(body.first(sizes[0]), sizes[1]), 0);
  make_points(stored);
  return stored;
}

}  // namespace

StoredCloud parse_pcd(Bytes bytes) {
  std::string_view rest = text_of(bytes).substr(0, most_header_bytes);
  const std::size_t header_part = rest.size();
  PcdLines lines = take_pcd_header(rest);
  const std::size_t offset = header_part - rest.size();
  PointCloud2Message cloud;
  add_pcd_fields(lines, cloud);
  set_size(cloud, pcd_number(lines, "WIDTH"), pcd_number(lines, "HEIGHT"));
  if (lines.contains("POINTS") &&
      pcd_number(lines, "POINTS") != std::uint64_t{cloud.width} * cloud.height)
    damaged("PCD: POINTS is not WIDTH x HEIGHT");
  const std::string data(lines["DATA"].empty() ? "" : lines["DATA"][0]);
  if (data == "ascii") return take_text(std::move(cloud), text_of(bytes).substr(offset));
  if (data == "binary") return take_binary(std::move(cloud), std::move(bytes), offset);
  if (data == "binary_compressed")
    return take_compressed(std::move(cloud), std::span(bytes).subspan(offset));
  damaged("PCD: unknown DATA " + in_quotes(data));
}

std::string format_pcd(const PointCloud2Message& cloud) {
  std::string names, sizes, types, counts;
  std::vector<Piece> pieces;
  for (const PointFieldMessage& field : cloud.fields) {
    const NumberType& type = number_types[field.datatype];
    names += ' ' + field.name;
    sizes += ' ' + std::to_string(type.size);
    types += {' ', type.kind};
    counts += ' ' + std::to_string(field.count);
    pieces.push_back({field.offset, type.size * field.count});
  }
  std::string file = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + names +
                     "\nSIZE" + sizes + "\nTYPE" + types + "\nCOUNT" + counts + "\nWIDTH " +
                     std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height) +
                     "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                     std::to_string(std::uint64_t{cloud.width} * cloud.height) + "\nDATA binary\n";
  append_pieces(cloud, pieces, file);
  return file;
}

}  // namespace penumbra::io::cloud_formats
