// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>
#include <utility>

#include <penumbra/pipeline/frame.hpp>

#include <io/live/diagnostic_changes.hpp>

namespace penumbra::io {
namespace {

/// Returns a message without its numbers. Joints that contradict each other all give the same kind,
/// because the joints change while an arm moves.
std::string kind_of(std::string_view message) {
  const std::string_view disagree = to_string(FrameStatus::poses_disagree);
  if (message.starts_with(disagree)) return std::string(disagree);
  std::string kind(message);
  std::erase_if(kind, [](char c) {
    return std::string_view("+-.0123456789").find(c) != std::string_view::npos;
  });
  return kind;
}

}  // namespace

std::vector<std::string> DiagnosticChanges::update(const DiagnosticArrayMessage& message) {
  std::vector<std::string> lines;
  std::map<std::string, std::string> now;
  const std::map<std::string, std::string> former = reported_.value_or(now);
  for (const DiagnosticStatusMessage& status : message.status) {
    std::string poses;
    for (const auto& [key, value] : status.values) {
      if (key == calibration_poses_key) poses = value;
      if (key != calibration_key) continue;
      const std::string kind = kind_of(value) + poses;
      if (std::exchange(calibrations_[status.name], kind) != kind)
        lines.push_back(status.name + ": calibration: " + value);
    }
    if (status.level == DiagnosticStatusMessage::ok) continue;
    std::string kind = kind_of(status.message);
    const auto found = former.find(status.name);
    if (found == former.end() || found->second != kind)
      lines.push_back(status.name + ": " + status.message);
    now[status.name] = std::move(kind);
  }
  for (const auto& [name, kind] : former)
    if (!now.empty() && !now.contains(name)) lines.push_back(name + ": recovered");
  if (now.empty() && (!reported_ || !reported_->empty())) {
    std::string program, all;
    for (const DiagnosticStatusMessage& status : message.status) {
      const std::size_t subject = status.name.rfind(": ") + 2;  // after the program's name
      program = status.name.substr(0, subject);
      all += (all.empty() ? "" : "; ") + status.name.substr(subject) + " " + status.message;
    }
    lines.push_back(program + "no faults: " + all);
  }
  reported_ = std::move(now);
  return lines;
}

}  // namespace penumbra::io
