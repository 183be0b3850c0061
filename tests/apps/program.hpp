// SPDX-License-Identifier: Apache-2.0
// Runs the command line `penumbra` and looks at what it wrote.
#pragma once

#include "../support/temporary_folder.hpp"

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace penumbra::test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

[[nodiscard]] Words split(const std::string& text);

[[nodiscard]] std::string joined(const Words& words);  // by commas

[[nodiscard]] Words operator+(Words first, const Words& second);

struct Outcome {
  int status = -1;  ///< 128 + the number of the signal that killed it; 124: it did not end in time
  std::string out;
  std::string err;
};

/// Runs the command line `penumbra`, or another program, with these arguments, at most an hour,
/// with NAME=VALUE added to its environment.
[[nodiscard]] Outcome penumbra(const Words& arguments, const Words& environment = {},
                               const fs::path& program = PENUMBRA_PROGRAM);

/// What happens to a program that makes a file too large: the same as on a full disk, or the same
/// as kill -9 does.
enum class TooLarge { fails, kills };

/// Runs it silently and returns its status. `bytes`: of each file at most.
[[nodiscard]] int penumbra_within(std::size_t bytes, TooLarge what, const Words& arguments);

/// An environment in which EGL finds no driver.
inline const Words no_egl_driver = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"};

/// Fails the test unless the status is 0.
Outcome succeed(Outcome outcome);

/// Fails the test unless the status is 2 and stderr has all these words; if refused, in one line.
void expect_failed(const Outcome& outcome, const Words& named);
void expect_refused(const Outcome& outcome, const Words& named);

/// Options that are refused, each with what the one line names.
void expect_all_refused(const std::function<Outcome(const Words&)>& run,
                        const std::vector<std::pair<Words, std::string>>& lines);

/// Fails the test unless all words are in the text, or if any is.
void expect_has(const std::string& text, const Words& words);
void expect_lacks(const std::string& text, const Words& words);

[[nodiscard]] Json read_json(const fs::path& file);

[[nodiscard]] Words keys(const Json& json);

/// Fails the test unless the JSON has these values at these places ("/frames/0/status").
void expect_values(const Json& json, const std::vector<std::pair<std::string, Json>>& values);

[[nodiscard]] std::string read_file(const fs::path& file);
void write_file(const fs::path& file, const std::string& content);

/// Replaces the first `from` in a file; fails the test if there is none.
void edit_file(const fs::path& file, const std::string& from, const std::string& to);

/// Names the cases of a test by themselves.
inline constexpr auto name_of = [](const auto& test) { return std::string(test.param.name); };

[[nodiscard]] std::size_t count_lines(const std::string& text);

}  // namespace penumbra::test
