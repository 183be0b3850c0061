// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <stdexcept>

namespace example {
namespace {

constexpr std::size_t longest_number = 64;

template <typename... Format>
std::string text(double value, Format... format) {
  std::array<char, longest_number> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0, format...);
  if (error != std::errc()) throw std::runtime_error("a number is too long");
  return {buffer.data(), end};
}

}  // namespace

std::string shortest(double value) { return text(value); }

std::string shortest(const Eigen::Vector3d& v) {
  return shortest(v.x()) + ' ' + shortest(v.y()) + ' ' + shortest(v.z());
}

std::string fixed(double value, int decimals) {
  const std::string digits = text(value, std::chars_format::fixed, decimals);
  return digits.find_first_not_of("-0.") == std::string::npos && digits[0] == '-' ? digits.substr(1)
                                                                                  : digits;
}

std::string fixed(const Eigen::Vector3d& v, int decimals) {
  return fixed(v.x(), decimals) + ' ' + fixed(v.y(), decimals) + ' ' + fixed(v.z(), decimals);
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace example
