// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <io/cloud/cloud_points.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/result_folder.hpp>
#include <io/files/sink.hpp>
#include <io/inputs/run_input.hpp>
#include <io/mcap/writer.hpp>

namespace penumbra::io {

/// Returns what a run's folder holds: clouds/, in files of the input's names, and report.json.
/// Throws InputError if it holds the input, or clouds that the report would not be of.
[[nodiscard]] ResultFolderOptions cloud_results(const RunInput& input,
                                                const std::filesystem::path& output, bool force);

/// The results of a recording in `folder`, which is of cloud_results() and must outlive this.
[[nodiscard]] std::unique_ptr<Sink> open_cloud_folder(ResultFolder& folder, const CloudOutput& how);

/// The results of a bag's sensors: a bag with the topics /penumbra/TOPIC and, if there are targets,
/// /penumbra/TOPIC/targets. The file appears with finish().
class CloudBag {
 public:
  explicit CloudBag(const std::filesystem::path& file)
      : pending_(file), writer_(pending_.part(), {.profile = "ros2"}) {}

  /// Returns the output of a sensor, which this must outlive.
  [[nodiscard]] std::unique_ptr<Sink> sensor(const std::string& topic, const Robot& robot,
                                             const CloudOutput& how);
  void finish();

 private:
  PendingFile pending_;
  mcap::Writer writer_;
};

}  // namespace penumbra::io
