// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace penumbra::app {

/// Removes what an earlier `run` wrote into a folder: report.json and images by frame number. What
/// is not there is no fault. Throws InputError, with nothing removed, where such images stand
/// without a report that says that they are a run's, lie behind a link, or report.json is not
/// Penumbra's; and where something cannot be removed, or `folder` is no folder.
void remove_former_run(const std::filesystem::path& folder);

/// Removes the file that `option` is to write; what is no regular file (/dev/null) stays. Throws
/// InputError for a folder.
void remove_former_file(const std::string& option, const std::filesystem::path& file);

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
