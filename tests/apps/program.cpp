// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::test {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

int status_of(int wait_status) {
  return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
}

/// Calls `prepare` in the new process.
template <typename Prepare>
pid_t start_program(const Words& arguments, const fs::path& out, const fs::path& err,
                    const Prepare& prepare) {
  std::vector<char*> words = {const_cast<char*>(PENUMBRA_PROGRAM)};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const pid_t child = fork();
  if (child != 0) return child;
  dup2(open(out.c_str(), O_WRONLY), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY), STDERR_FILENO);
  prepare();
  execv(PENUMBRA_PROGRAM, words.data());
  _exit(127);
}

}  // namespace

Words split(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
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
  auto help = helps.find(command);
  if (help == helps.end()) {
    helps[command];  // the call below asks for no help
    helps[command] = penumbra({command, "--help"}).out;
    help = helps.find(command);
  }
  const std::size_t bags = help->second.find("\nOf bags:");
  std::set<std::string> options;
  const std::regex option("\n  (?:-[a-zA-Z],)?(--[a-z0-9-]+)");
  for (std::sregex_iterator found(help->second.begin(), help->second.end(), option), end;
       found != end; ++found)
    if (!is_folder || static_cast<std::size_t>(found->position()) < bags)
      options.insert((*found)[1]);
  return options;
}

/// Fails the test if stderr names an option ("--frame-prefix", or "set frame_prefix") that the
/// command does not have. Options of others follow their names: 'penumbra calibrate --search'.
void expect_remedies_exist(const Words& arguments, const std::string& err) {
  if (arguments.size() < 2 || arguments[0].starts_with('-')) return;
  const bool is_folder =
      fs::is_directory(arguments[1]) && fs::exists(fs::path(arguments[1]) / "recording.yaml");
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
  std::string command = "env";
  for (const std::string& variable : environment) command += " " + quoted(variable);
  command += " timeout 3600 " + quoted(program);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command +=
      " </dev/null >" + quoted(folder.path() / "out") + " 2>" + quoted(folder.path() / "err");
  const int status = std::system(command.c_str());
  const std::string err = read_file(folder.path() / "err");
  if (program == PENUMBRA_PROGRAM) expect_remedies_exist(arguments, err);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder.path() / "out"), err};
}

double peak_memory_mb(const Words& arguments) {
  const pid_t child = start_program(arguments, "/dev/null", "/dev/null", [] {});
  int status = -1;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

int penumbra_within(std::size_t bytes, TooLarge what, const Words& arguments) {
  const pid_t child = start_program(arguments, "/dev/null", "/dev/null", [&] {
    const rlimit none{0, 0}, most{bytes, bytes};
    setrlimit(RLIMIT_CORE, &none);
    setrlimit(RLIMIT_FSIZE, &most);
    signal(SIGXFSZ, what == TooLarge::fails ? SIG_IGN : SIG_DFL);
  });
  int status = 0;
  waitpid(child, &status, 0);
  return status_of(status);
}

Outcome penumbra_interrupted(const Words& arguments,
                             const std::function<bool(const Outcome&)>& when) {
  const TemporaryFolder folder;
  const auto outcome = [&](int status) -> Outcome {
    return {status_of(status), read_file(folder.path() / "out"), read_file(folder.path() / "err")};
  };
  for (const char* const name : {"out", "err"}) write_file(folder.path() / name, "");
  const pid_t child = start_program(arguments, folder.path() / "out", folder.path() / "err", [] {});
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0 && !when(outcome(0)))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGINT);
  waitpid(child, &status, 0);
  return outcome(status);
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
