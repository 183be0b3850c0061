// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::test {

/// RVL written from its paper: nibbles first, words of them at the end.
class RvlPacker {
 public:
  static std::vector<std::byte> pack(std::span<const std::uint16_t> depths) {
    RvlPacker packer;
    int previous = 0;
    for (std::size_t at = 0; at < depths.size();) {
      const std::size_t zeros = packer.run(depths, at, true);
      const std::size_t others = packer.run(depths, at + zeros, false);
      packer.add(zeros);
      packer.add(others);
      at += zeros;
      for (const std::size_t end = at + others; at < end; ++at) {
        const int difference = depths[at] - previous;
        packer.add(static_cast<std::size_t>(difference < 0 ? -2 * difference - 1 : 2 * difference));
        previous = depths[at];
      }
    }
    return packer.words();
  }

 private:
  static std::size_t run(std::span<const std::uint16_t> depths, std::size_t from, bool of_zeros) {
    std::size_t end = from;
    while (end < depths.size() && (depths[end] == 0) == of_zeros) ++end;
    return end - from;
  }

  void add(std::size_t number) {
    for (; number >= 8; number /= 8) nibbles_.push_back(static_cast<int>(8 + number % 8));
    nibbles_.push_back(static_cast<int>(number));
  }

  [[nodiscard]] std::vector<std::byte> words() {
    while (nibbles_.size() % 8 != 0) nibbles_.push_back(0);
    std::vector<std::byte> bytes;
    for (std::size_t word = 0; word < nibbles_.size(); word += 8)
      for (std::size_t byte = 8; byte > 0; byte -= 2)  // the last nibbles lie in the first byte
        bytes.push_back(
            static_cast<std::byte>(16 * nibbles_[word + byte - 2] + nibbles_[word + byte - 1]));
    return bytes;
  }

  std::vector<int> nibbles_;
};

}  // namespace penumbra::test
