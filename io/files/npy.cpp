// SPDX-License-Identifier: Apache-2.0
// Format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/camera/intrinsics.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/npy.hpp>

namespace penumbra::io {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are copied as they lie");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t max_header = 4096;  // a plain array's header has about a hundred bytes
constexpr std::size_t alignment = 64;     // of the first sample, by the format

struct Header {
  std::string type;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

// Reads the Python literal of a header: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : rest_(text) {}

  bool parse(Header& header) {
    bool type = false, order = false, shape = false;
    if (!take("{")) return false;
    while (!take("}")) {
      std::string key;
      if (!quoted(key) || !take(":")) return false;
      if (key == "descr" && !type) {
        type = quoted(header.type);
        if (!type) return false;
      } else if (key == "fortran_order" && !order) {
        order = boolean(header.fortran_order);
        if (!order) return false;
      } else if (key == "shape" && !shape) {
        shape = numbers(header.shape);
        if (!shape) return false;
      } else {
        return false;
      }
      if (!take(",") && !ahead('}')) return false;
    }
    skip_space();
    return rest_.empty() && type && order && shape;
  }

 private:
  void skip_space() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
  }

  bool ahead(char wanted) {
    skip_space();
    return !rest_.empty() && rest_.front() == wanted;
  }

  bool take(std::string_view wanted) {
    skip_space();
    if (!rest_.starts_with(wanted)) return false;
    rest_.remove_prefix(wanted.size());
    return true;
  }

  bool quoted(std::string& text) {
    const char* quote = ahead('\'') ? "'" : "\"";
    if (!take(quote)) return false;
    const std::size_t end = rest_.find(*quote);
    if (end == std::string_view::npos) return false;
    text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return true;
  }

  bool boolean(bool& value) {
    value = take("True");
    return value || take("False");
  }

  bool numbers(std::vector<std::uint64_t>& values) {
    if (!take("(")) return false;
    while (!take(")")) {
      skip_space();
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
      if (error != std::errc()) return false;
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
      values.push_back(value);
      if (!take(",") && !ahead(')')) return false;
    }
    return true;
  }

  std::string_view rest_;
};

// The header's text, behind magic, version and length; or why there is none.
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

std::string check(const Header& header) {
  if (header.type != "<f4")
    return "holds '" + header.type + "'; depths must be '<f4' (little-endian float32, metres)";
  if (header.fortran_order) return "is in Fortran order; C order (row by row) is wanted";
  if (header.shape.size() != 2)
    return "has " + std::to_string(header.shape.size()) +
           " dimensions; 2 (height, width) are wanted";
  for (const std::uint64_t n : header.shape)
    if (n < 1 || n > Intrinsics::max_size)
      return "has a side of " + std::to_string(n) + " pixels; 1 to " +
             std::to_string(Intrinsics::max_size) + " are possible";
  return {};
}

}  // namespace

FileResult read_npy(const std::filesystem::path& file, Image<float>& image,
                    std::optional<ImageSize> wanted) {
  InputFile input;
  if (FileResult opened = input.open(file); !opened.ok()) return opened;
  std::string text;
  if (const std::string fault = read_header_text(input, text); !fault.empty())
    return FileResult::bad(file, fault);
  Header header;
  if (!HeaderParser(text).parse(header)) return FileResult::bad(file, "has a damaged header");
  if (const std::string fault = check(header); !fault.empty()) return FileResult::bad(file, fault);

  const ImageSize size{static_cast<int>(header.shape[1]), static_cast<int>(header.shape[0])};
  if (wanted && size != *wanted) return FileResult::bad(file, wrong_size(size, *wanted));
  const std::uint64_t bytes = header.shape[0] * header.shape[1] * sizeof(float);
  if (bytes > input.size()) return FileResult::bad(file, "ends before its last row");
  if (image.width() != size.width || image.height() != size.height)
    image = Image<float>(size.width, size.height);
  if (input.read(image.data(), bytes) != bytes)
    return FileResult::bad(file, "ends before its last row");
  char more = 0;
  if (input.read(&more, 1) != 0) return FileResult::bad(file, "has bytes behind its last row");
  return {};
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
