// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <mutex>
#include <string_view>

#include <dds/ddsrt/log.h>

#include <io/dds/graph_log.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t most_lines = 100;

struct GraphLog {
  std::mutex mutex;
  std::deque<std::string> lines;
};

GraphLog& graph_log() {
  static auto* const log = new GraphLog;  // Cyclone DDS may still log while the program ends
  return *log;
}

void keep_line(void*, const dds_log_data_t* data) {
  const std::string_view text(data->message);
  GraphLog& log = graph_log();
  const std::lock_guard lock(log.mutex);
  if (log.lines.size() == most_lines) log.lines.pop_front();
  log.lines.emplace_back(text.substr(0, text.find('\n')));
}

}  // namespace

void keep_logged_lines() { dds_set_log_sink(keep_line, nullptr); }

std::vector<std::string> take_logged_lines() {
  GraphLog& log = graph_log();
  const std::lock_guard lock(log.mutex);
  std::vector<std::string> lines(log.lines.begin(), log.lines.end());
  log.lines.clear();
  return lines;
}

}  // namespace penumbra::io
