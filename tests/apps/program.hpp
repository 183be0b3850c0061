// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/temporary_folder.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::test {

using Words = std::vector<std::string>;

/// What a program did. A program that is killed or does not end in time has another status than
/// any of its own.
struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// Runs the command line `penumbra` with these arguments, at most 60 s, with NAME=VALUE added to
/// its environment.
[[nodiscard]] Outcome penumbra(const Words& arguments, const Words& environment = {});

/// What happens to a program that makes a file too large: the same as on a full disk, or the same
/// as kill -9 does.
enum class TooLarge { fails, kills };

/// Runs it silently. `bytes`: of each file at most. Returns the status, or 128 + the signal's
/// number.
[[nodiscard]] int penumbra_within(std::size_t bytes, TooLarge what, const Words& arguments);

/// Runs it and sends it Ctrl-C `when` it has printed enough, or as soon as anything else is so.
[[nodiscard]] Outcome penumbra_interrupted(const Words& arguments,
                                           const std::function<bool(const Outcome&)>& when);

/// An environment in which EGL finds no driver.
inline const Words no_egl_driver = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"};

[[nodiscard]] std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& content);

/// Replaces the first `from` in a file; fails the test if there is none.
void edit_file(const std::filesystem::path& file, const std::string& from, const std::string& to);

/// Names the cases of a test by themselves.
inline constexpr auto name_of = [](const auto& test) { return test.param.name; };

[[nodiscard]] std::size_t count_lines(const std::string& text);

}  // namespace penumbra::test
