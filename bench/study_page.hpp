// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::study {

[[nodiscard]] std::string number(double value, int digits);

/// A table in Markdown: a row of heads, then rows of cells.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows);

/// Throws InputError for a file that cannot be written.
void write_file(const std::filesystem::path& file, const std::string& content);

/// Replaces what lies between a page's markers `<!-- begin: study -->` and `<!-- end: study -->`,
/// each on a line. Throws InputError for a page without them.
void update_page(const std::filesystem::path& page, const std::string& study,
                 const std::string& content);

/// Runs a study with the arguments RECORDING REPOSITORY [PLACEMENTS IN EACH FRAME].
int main_of(const char* name, int placements,
            void (*run)(const std::filesystem::path& recording, const std::filesystem::path& root,
                        int placements),
            int argc, char** argv);

}  // namespace penumbra::study
