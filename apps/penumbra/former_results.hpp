// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <penumbra/base/error.hpp>

namespace penumbra::app {

/// Looks at what an earlier `run` wrote into a folder: report.json, report.html and images by frame
/// number. What is not there is no fault. Throws InputError where such images stand without a
/// report that says that they are a run's, lie behind a link, or report.json is not Penumbra's; and
/// where `folder` is no folder. Touches nothing.
void check_former_run(const std::filesystem::path& folder);

/// Throws InputError where a report.html stands in the folder that is not of a run.
void check_former_page(const std::filesystem::path& folder);

/// Removes it. Throws as check_former_run() does, with nothing removed, and where something cannot
/// be removed.
void remove_former_run(const std::filesystem::path& folder);

/// Runs a command: to the message of what it throws `left()` is added, which says what of earlier
/// results still stands.
template <typename Run, typename Left>
int run_or_tell_left(const Run& run, const Left& left) {
  try {
    return run();
  } catch (const InputError& error) {
    throw InputError(error.what() + left());
  } catch (const DeviceError& error) {
    throw DeviceError(error.what() + left());
  }
}

/// Removes the images of a run that throws: as there will be no report, nothing would tell whose
/// they are. The folder is one that remove_former_run() was called for.
class UnfinishedRun {
 public:
  explicit UnfinishedRun(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~UnfinishedRun();
  UnfinishedRun(const UnfinishedRun&) = delete;
  UnfinishedRun& operator=(const UnfinishedRun&) = delete;

  void finish() { finished_ = true; }

 private:
  std::filesystem::path folder_;
  bool finished_ = false;
};

}  // namespace penumbra::app
