// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace penumbra {

/// The user's input is at fault. The message is one line that names the file, the element, what is
/// wrong and what would be right; line breaks in pieces of the input become spaces. The command
/// line prints it and exits with status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::string message);
};

/// The graphics device failed. Nothing that it was to draw is to be trusted, and whoever threw this
/// draws no more: make another one. The command line exits with status 1.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace penumbra
