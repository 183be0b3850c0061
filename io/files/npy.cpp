// SPDX-License-Identifier: Apache-2.0
// Format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/camera/intrinsics.hpp>

#include <io/files/depth_pixels-inl.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/npy.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::io {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are copied unchanged");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t max_header = 4096;  // a plain array's header has about a hundred bytes
constexpr std::size_t alignment = 64;     // of the first sample, by the format

struct Header {
  std::string type, order;
  std::vector<std::uint64_t> shape;
};

/// Reads the Python literal of a header: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}
std::optional<Header> parse(const std::string& text) {
  const auto value = [&](const std::string& key, const char* pattern) {
    std::smatch found;
    std::regex_search(text, found, std::regex("['\"]" + key + "['\"]\\s*:\\s*" + pattern));
    return found.size() == 2 ? std::optional(found.str(1)) : std::nullopt;
  };
  const auto type = value("descr", "['\"]([^'\"]*)['\"]");
  const auto order = value("fortran_order", "(True|False)");
  const auto shape = value("shape", "\\(([0-9, ]*)\\)");
  if (!type || !order || !shape) return std::nullopt;
  Header header{*type, *order, {}};
  const std::regex number("[0-9]+");
  for (std::sregex_iterator at(shape->begin(), shape->end(), number), end; at != end; ++at)
    header.shape.push_back(parse_number<std::uint64_t>(at->str()).value_or(0));
  return header;
}

/// Reads the header's text after magic, version and length. Returns what is wrong, or nothing.
std::string read_header_text(InputFile& input, std::string& text) {
  std::array<unsigned char, 12> start{};
  if (input.read(start.data(), 8) != 8 ||
      !std::equal(magic.begin(), magic.end(), start.begin(),
                  [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; }))
    return "is not a NumPy file";
  const int major = start[6];
  if (major < 1 || major > 3 || start[7] != 0)
    return "has NumPy format version " + std::to_string(major) + "." + std::to_string(start[7]) +
           "; 1.0, 2.0 and 3.0 are read";
  const std::size_t length_bytes = major == 1 ? 2 : 4;
  if (input.read(&start[8], length_bytes) != length_bytes) return "ends in its header";
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) length |= std::size_t{start[8 + i]} << (8 * i);
  if (length > max_header)
    return "has a header of " + std::to_string(length) + " bytes; a depth image's has about 100";
  text.resize(length);
  return input.read(text.data(), length) == length ? "" : "ends in its header";
}

std::string check_shape(const Header& header) {
  if (header.order == "True") return "is in Fortran order; expected C order (row by row)";
  if (header.shape.size() != 2)
    return "has " + std::to_string(header.shape.size()) + " dimensions; expected 2 (height, width)";
  for (const std::uint64_t n : header.shape)
    if (n < 1 || n > Intrinsics::max_size)
      return "has a side of " + std::to_string(n) + " pixels; 1 to " +
             std::to_string(Intrinsics::max_size) + " are possible";
  return {};
}

/// Reads and checks what stands before the pixels.
FileResult read_header(const std::filesystem::path& file, InputFile& input, Header& header) {
  if (FileResult opened = input.open(file); !opened.ok()) return opened;
  std::string text;
  if (const std::string fault = read_header_text(input, text); !fault.empty())
    return FileResult::bad(file, fault);
  const std::optional<Header> parsed = parse(text);
  if (!parsed) return FileResult::bad(file, "has a damaged header");
  header = *parsed;
  if (header.shape.size() == 3 && header.shape.back() == 1) header.shape.pop_back();
  const std::string fault = check_shape(header);
  return fault.empty() ? FileResult{} : FileResult::bad(file, fault);
}

template <typename T>
FileResult read_pixels(const std::filesystem::path& file, InputFile& input, const Header& header,
                       std::optional<ImageSize> wanted, Image<T>& image) {
  const ImageSize size{static_cast<int>(header.shape[1]), static_cast<int>(header.shape[0])};
  if (wanted && size != *wanted) return FileResult::bad(file, wrong_size(size, *wanted));
  const std::uint64_t bytes = header.shape[0] * header.shape[1] * sizeof(T);
  if (bytes > input.size()) return FileResult::bad(file, "ends before its last row");
  image.fit(size.width, size.height);
  if (input.read(image.data(), bytes) != bytes)
    return FileResult::bad(file, "ends before its last row");
  char more = 0;
  if (input.read(&more, 1) != 0) return FileResult::bad(file, "has bytes after its last row");
  return {};
}

template <typename T>
FileResult read_depth_of(const std::filesystem::path& file, InputFile& input, const Header& header,
                         std::optional<ImageSize> wanted, std::optional<double> scale,
                         SharedDepth& depth) {
  Image<T> pixels;
  FileResult result = read_pixels(file, input, header, wanted, pixels);
  if (result.ok()) depth = shared_depth_of(std::move(pixels), scale);
  return result;
}

}  // namespace

FileResult read_npy(const std::filesystem::path& file, Image<float>& image,
                    std::optional<ImageSize> wanted) {
  InputFile input;
  Header header;
  if (FileResult read = read_header(file, input, header); !read.ok()) return read;
  if (header.type != "<f4")
    return FileResult::bad(file, "holds '" + header.type + "'; expected '<f4'");
  return read_pixels(file, input, header, wanted, image);
}

FileResult read_npy_depth(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                          std::optional<double> scale, SharedDepth& depth) {
  InputFile input;
  Header header;
  if (FileResult read = read_header(file, input, header); !read.ok()) return read;
  const auto read_as = [&]<typename T>(T) {
    return read_depth_of<T>(file, input, header, wanted, scale, depth);
  };
  if (header.type == "<f4") return read_as(float{});
  if (header.type == "<f8") return read_as(double{});
  if (header.type == "<u2") return read_as(std::uint16_t{});
  if (header.type == "<i2") return read_as(std::int16_t{});
  if (header.type == "<u4") return read_as(std::uint32_t{});
  if (header.type == "<i4") return read_as(std::int32_t{});
  if (header.type == "<u8") return read_as(std::uint64_t{});
  if (header.type == "<i8") return read_as(std::int64_t{});
  return FileResult::bad(file, "holds '" + header.type +
                                   "'; expected float32 or float64 (metres), or integers of 16 to "
                                   "64 bits (millimetres), little-endian");
}

void write_npy(const std::filesystem::path& file, ImageView<const float> image) {
  std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                     std::to_string(image.height) + ", " + std::to_string(image.width) + "), }";
  const std::size_t before = magic.size() + 4;
  const std::size_t whole = (before + text.size() + 1 + alignment - 1) / alignment * alignment;
  text.resize(whole - before - 1, ' ');
  text += '\n';

  std::string start(magic);
  start +=
      {'\x01', '\x00', static_cast<char>(text.size() & 0xff), static_cast<char>(text.size() >> 8)};
  OutputFile output(file);
  output.write((start + text).data(), whole);
  if (image.stride == image.width) {
    output.write(image.data, static_cast<std::size_t>(image.width) *
                                 static_cast<std::size_t>(image.height) * sizeof(float));
  } else {
    for (int v = 0; v < image.height; ++v)
      output.write(image.row(v), static_cast<std::size_t>(image.width) * sizeof(float));
  }
  output.close();
}

}  // namespace penumbra::io
