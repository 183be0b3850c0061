// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

namespace penumbra {
namespace {

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

}  // namespace

InputError::InputError(std::string message) : std::runtime_error(one_line(std::move(message))) {}

}  // namespace penumbra
