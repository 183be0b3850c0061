// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace penumbra {

/// A fault in the user's input. The message names the file, the element, the fault and a remedy in
/// one line; control characters become spaces. The command line prints it and exits with status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::string message) : std::runtime_error(one_line(std::move(message))) {}

 private:
  static std::string one_line(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
  }
};

/// The graphics device failed. Its images are invalid, and the renderer must be created again. The
/// command line exits with status 1.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace penumbra
