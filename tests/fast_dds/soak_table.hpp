// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iomanip>
#include <sstream>
#include <string>

namespace penumbra::test {

inline std::string fixed(double value, int digits = 1) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// The rows of a Markdown table.
class SoakTable {
 public:
  explicit SoakTable(const std::string& title) { text_ << "| " << title << " | |\n|---|---:|\n"; }
  template <typename T>
  void add(const std::string& what, const T& value) {
    text_ << "| " << what << " | " << value << " |\n";
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

}  // namespace penumbra::test
