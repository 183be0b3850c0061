// SPDX-License-Identifier: Apache-2.0
#include "study_page.hpp"

#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

#include <penumbra/base/error.hpp>

namespace penumbra::study {

std::string number(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::ostringstream out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const std::string& cell : rows[i]) out << "| " << cell << ' ';
    out << "|\n";
    if (i > 0) continue;
    out << "|---";
    for (std::size_t j = 1; j < rows[i].size(); ++j) out << "|---:";
    out << "|\n";
  }
  return out.str();
}

void write_file(const std::filesystem::path& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary);
  out << content;
  if (!out.flush()) throw InputError(file.string() + ": cannot be written");
}

void update_page(const std::filesystem::path& page, const std::string& study,
                 const std::string& content) {
  std::ostringstream old;
  old << std::ifstream(page, std::ios::binary).rdbuf();
  const std::string text = old.str();
  const std::string first = "<!-- begin: " + study + " -->\n";
  const auto begin = text.find(first), end = text.find("<!-- end: " + study + " -->");
  if (begin == std::string::npos || end == std::string::npos)
    throw InputError(page.string() + ": has no markers of " + study);
  write_file(page, text.substr(0, begin + first.size()) + content + text.substr(end));
}

int main_of(const char* name, int placements,
            void (*run)(const std::filesystem::path&, const std::filesystem::path&, int), int argc,
            char** argv) {
  if (argc < 3 || argc > 4) {
    std::cerr << "usage: " << name << " RECORDING REPOSITORY [PLACEMENTS IN EACH FRAME]\n";
    return 2;
  }
  try {
    run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : placements);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace penumbra::study
