// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include "../support/child_process.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <fcntl.h>
#include <gtest/gtest.h>

namespace penumbra::test {
Words split(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

Words operator+(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

namespace {

/// Returns the options of a command: all, or those that an input takes. A recording folder takes
/// no options of bags, but has keys.
std::set<std::string> options_of(const std::string& command, bool is_folder) {
  static std::map<std::string, std::string> helps;
  std::string& all = helps[command];
  if (all.empty()) all = penumbra({command, "--help"}).out;
  const std::string help = is_folder ? all.substr(0, all.find("\nOf bags:")) : all;
  std::set<std::string> options;
  const std::regex option("\n  (?:-[a-zA-Z],)?(--[a-z0-9-]+)");
  for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found)
    options.insert((*found)[1]);
  return options;
}

/// Fails the test if stderr names an option ("--frame-prefix", or "set frame_prefix") that the
/// command does not have. Options of others follow their names: 'penumbra calibrate --search'.
/// Other programs' commands stand in backquotes.
void expect_remedies_exist(const Words& arguments, const std::string& all) {
  if (arguments.size() < 2 || arguments[0].starts_with('-')) return;
  const bool is_folder =
      fs::is_directory(arguments[1]) && fs::exists(fs::path(arguments[1]) / "recording.yaml");
  const std::string err = std::regex_replace(all, std::regex("`(?!penumbra|-)[^`]*`"), "");
  const std::regex remedy(
      "penumbra ([a-z-]+)|(--[a-z][a-z0-9-]+)|\\b(?:set|change|multiply) ([a-z]+_[a-z_]+)");
  std::string command = arguments[0];
  for (std::sregex_iterator found(err.begin(), err.end(), remedy), end; found != end; ++found) {
    if ((*found)[1].matched) {
      command = (*found)[1];
      continue;
    }
    std::string option = (*found)[2].matched ? (*found)[2].str() : "--" + (*found)[3].str();
    std::ranges::replace(option, '_', '-');
    const auto is_given = [&](const std::string& word) { return word.starts_with(option); };
    if (std::ranges::any_of(arguments, is_given)) continue;
    if (is_folder && (*found)[3].matched &&
        read_file(PENUMBRA_SOURCE_DIR "/docs/recording.md").find("." + (*found)[3].str() + "`") !=
            std::string::npos)
      continue;
    EXPECT_TRUE(options_of(arguments[0], is_folder).contains(option) ||
                options_of(command, false).contains(option))
        << "penumbra " << command << " has no " << option << ": " << err;
  }
}

}  // namespace

Outcome penumbra(const Words& arguments, const Words& environment, const fs::path& program) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out", err = folder.path() / "err";
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0644);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0644);
  const pid_t process = start_process(
      Words{"/usr/bin/env"} + environment + Words{"timeout", "3600", program} + arguments, files);
  int status = 0;
  waitpid(process, &status, 0);
  const Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                        read_file(out), read_file(err)};
  if (program == PENUMBRA_PROGRAM) expect_remedies_exist(arguments, outcome.err);
  return outcome;
}

int penumbra_within(std::size_t bytes, TooLarge what, const Words& arguments) {
  const std::string line = std::string(what == TooLarge::fails ? "trap '' XFSZ; " : "") +
                           "exec prlimit --core=0 --fsize=" + std::to_string(bytes) +
                           " \"$0\" \"$@\" >/dev/null 2>&1";
  return penumbra(Words{"-c", line, PENUMBRA_PROGRAM} + arguments, {}, "/bin/sh").status;
}

Outcome succeed(Outcome outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome;
}

void expect_failed(const Outcome& outcome, const Words& named) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  expect_has(outcome.err, named);
}

void expect_refused(const Outcome& outcome, const Words& named) {
  expect_failed(outcome, named);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
}

void expect_all_refused(const std::function<Outcome(const Words&)>& run,
                        const std::vector<std::pair<Words, std::string>>& lines) {
  for (const auto& [options, named] : lines) expect_refused(run(options), {named});
}

void expect_has(const std::string& text, const Words& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

void expect_lacks(const std::string& text, const Words& words) {
  for (const std::string& word : words)
    EXPECT_EQ(text.find(word), std::string::npos) << word << " is in: " << text;
}

Json read_json(const fs::path& file) { return Json::parse(read_file(file)); }

Words keys(const Json& json) {
  Words names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

void expect_values(const Json& json, const std::vector<std::pair<std::string, Json>>& values) {
  for (const auto& [place, value] : values) {
    const Json::json_pointer pointer(place);
    ASSERT_TRUE(json.contains(pointer)) << place;
    EXPECT_EQ(json.at(pointer), value) << place;
  }
}

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

void write_file(const fs::path& file, const std::string& content) {
  std::ofstream stream(file, std::ios::binary);
  stream << content;
  EXPECT_TRUE(stream.flush()) << file;
}

void edit_file(const fs::path& file, const std::string& from, const std::string& to) {
  std::string content = read_file(file);
  const std::size_t at = content.find(from);
  ASSERT_NE(at, std::string::npos) << file << " has no " << from;
  write_file(file, content.replace(at, from.size(), to));
}

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace penumbra::test
