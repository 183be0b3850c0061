// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Of diagnostics that are made again and again, what is new: a line for each status whose trouble
/// is of another kind than when it was looked at last. How long it lasts, or how often it was, is
/// no news.
class TroubleNews {
 public:
  [[nodiscard]] std::vector<std::string> look(const DiagnosticArrayMessage& message);

 private:
  std::map<std::string, std::string> told_;  // kinds of trouble, by the status's name
};

}  // namespace penumbra::io
