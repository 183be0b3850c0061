// SPDX-License-Identifier: Apache-2.0
// Format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/camera/camera.hpp>

#include <io/files/depth_pixels.hpp>
#include <io/files/disk_file.hpp>
#include <io/files/npy.hpp>
#include <io/files/numbers.hpp>

namespace penumbra::io {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are copied unchanged");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t max_header = 4096;  // a plain array's header has about a hundred bytes
constexpr std::size_t alignment = 64;     // of the first sample, by the format

/// Reads the Python literal of a header: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}
bool parse_literal(const std::string& text, NpyHeader& header) {
  const auto value = [&](const std::string& key, const char* pattern) {
    std::smatch found;
    std::regex_search(text, found, std::regex("['\"]" + key + "['\"]\\s*:\\s*" + pattern));
    return found.size() == 2 ? std::optional(found.str(1)) : std::nullopt;
  };
  const auto type = value("descr", "['\"]([^'\"]*)['\"]");
  const auto order = value("fortran_order", "(True|False)");
  const auto shape = value("shape", "\\(([0-9, ]*)\\)");
  if (!type || !order || !shape) return false;
  header.type = *type;
  header.is_fortran = *order == "True";
  header.shape.clear();
  const std::regex number("[0-9]+");
  for (std::sregex_iterator at(shape->begin(), shape->end(), number), end; at != end; ++at)
    header.shape.push_back(parse_number<std::uint64_t>(at->str()).value_or(0));
  return true;
}

std::string check_shape(const NpyHeader& header) {
  if (header.is_fortran) return "is in Fortran order; expected C order (row by row)";
  if (header.shape.size() != 2)
    return "has " + std::to_string(header.shape.size()) + " dimensions; expected 2 (height, width)";
  for (const std::uint64_t n : header.shape)
    if (n < 1 || n > Intrinsics::max_size)
      return "has a side of " + std::to_string(n) + " pixels; 1 to " +
             std::to_string(Intrinsics::max_size) + " are possible";
  return {};
}

/// Reads and checks what stands before the pixels.
FileResult read_header(const std::filesystem::path& file, InputFile& input, NpyHeader& header) {
  if (FileResult opened = input.open(file); !opened.ok()) return opened;
  std::array<std::byte, max_header + 12> start{};
  const std::size_t size = input.read(start.data(), start.size());
  std::string fault = parse_npy_header(std::span(start).first(size), header);
  if (header.shape.size() == 3 && header.shape.back() == 1) header.shape.pop_back();
  if (fault.empty()) fault = check_shape(header);
  return fault.empty() ? FileResult{} : FileResult::bad(file, fault);
}

template <typename T>
FileResult read_pixels(const std::filesystem::path& file, InputFile& input, const NpyHeader& header,
                       std::optional<ImageSize> wanted, Image<T>& image) {
  const ImageSize size{static_cast<int>(header.shape[1]), static_cast<int>(header.shape[0])};
  if (wanted && size != *wanted) return FileResult::bad(file, wrong_size(size, *wanted));
  const std::uint64_t bytes = header.shape[0] * header.shape[1] * sizeof(T);
  if (header.size + bytes > input.size()) return FileResult::bad(file, "ends before its last row");
  if (header.size + bytes < input.size())
    return FileResult::bad(file, "has bytes after its last row");
  image.fit(size.width, size.height);
  if (input.read_at(header.size, image.data(), bytes) != bytes)
    return FileResult::bad(file, "ends before its last row");
  return {};
}

template <typename T>
FileResult read_depth_of(const std::filesystem::path& file, InputFile& input,
                         const NpyHeader& header, std::optional<ImageSize> wanted,
                         std::optional<double> scale, SharedDepth& depth) {
  Image<T> pixels;
  FileResult result = read_pixels(file, input, header, wanted, pixels);
  if (result.ok()) depth = shared_depth_of(std::move(pixels), scale);
  return result;
}

}  // namespace

std::string parse_npy_header(std::span<const std::byte> file, NpyHeader& header) {
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(file[i]); };
  const bool is_npy = file.size() >= 8 && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
  if (!is_npy) return "is not a NumPy file";
  if (byte(6) < 1 || byte(6) > 3 || byte(7) != 0)
    return "has NumPy format version " + std::to_string(byte(6)) + "." + std::to_string(byte(7)) +
           "; 1.0, 2.0 and 3.0 are read";
  const std::size_t begin = byte(6) == 1 ? 10 : 12;
  if (file.size() < begin) return "ends in its header";
  std::size_t length = 0;
  for (std::size_t i = begin; i-- > 8;) length = length << 8U | byte(i);
  if (length > max_header)
    return "has a header of " + std::to_string(length) + " bytes; a plain array's has about 100";
  if (length > file.size() - begin) return "ends in its header";
  header.size = begin + length;
  const std::string text(reinterpret_cast<const char*>(&file[begin]), length);
  return parse_literal(text, header) ? "" : "has no header of a plain array";
}

std::string npy_header(std::string_view type, std::span<const std::uint64_t> shape) {
  std::string text = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  text += "), }";
  const std::size_t before = magic.size() + 4;
  const std::size_t whole = (before + text.size() + 1 + alignment - 1) / alignment * alignment;
  text.resize(whole - before - 1, ' ');
  text += '\n';
  std::string start(magic);
  start +=
      {'\x01', '\x00', static_cast<char>(text.size() & 0xff), static_cast<char>(text.size() >> 8)};
  return start + text;
}

FileResult read_npy(const std::filesystem::path& file, Image<float>& image,
                    std::optional<ImageSize> wanted) {
  InputFile input;
  NpyHeader header;
  if (FileResult read = read_header(file, input, header); !read.ok()) return read;
  if (header.type != "<f4")
    return FileResult::bad(file, "holds '" + header.type + "'; expected '<f4'");
  return read_pixels(file, input, header, wanted, image);
}

FileResult read_npy_depth(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                          std::optional<double> scale, SharedDepth& depth) {
  InputFile input;
  NpyHeader header;
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
  const std::array shape{static_cast<std::uint64_t>(image.height),
                         static_cast<std::uint64_t>(image.width)};
  const std::string start = npy_header("<f4", shape);
  OutputFile output(file);
  output.write(start.data(), start.size());
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
