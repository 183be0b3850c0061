// SPDX-License-Identifier: Apache-2.0
// Clouds in, clouds without the robot out.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <penumbra/tuning/cloud_tuning.hpp>

#include <io/cloud/cloud_points.hpp>
#include <io/files/pending_file.hpp>
#include <io/files/result_folder.hpp>
#include <io/files/run_output.hpp>
#include <io/mcap/writer.hpp>
#include <io/run/run_input.hpp>

namespace penumbra::io {

/// A recording folder with `frames.cloud`, or a bag, and how its clouds are read.
struct CloudRunOptions {
  InputOptions input;
  /// What options change of the recording's rule, or of the default, in their order.
  std::vector<std::function<void(CloudRule&)>> rule_changes;
  bool use_times = true;     ///< see CloudInputOptions
  bool has_rays = true;      ///< see CloudInputOptions
  std::string sensor_frame;  ///< likewise; of bags
  int threads = 1;
};

/// Opens the sensors of an input that measure points; `print` gets the used topics of a bag. Throws
/// InputError that names the file.
[[nodiscard]] std::vector<RunInput> open_clouds(const CloudRunOptions& options,
                                                const LineSink& print);

/// Measures a sensor's rule in some of its clouds: enough, and not all of one moment. Calls `go_on`
/// after each cloud and stops if it returns false.
[[nodiscard]] CloudTuning tune_clouds(const RunInput& input, const std::function<bool()>& go_on);

/// Returns what a run's folder holds: clouds/, in files of the input's names, and report.json.
/// Throws InputError if it holds the input, or clouds that the report would not be of.
[[nodiscard]] ResultFolderOptions cloud_results(const RunInput& input,
                                                const std::filesystem::path& output, bool force);

/// The results of a recording in `folder`, which is of cloud_results(). `source`: of the frames.
/// Both must outlive this.
[[nodiscard]] std::unique_ptr<RunOutput> open_cloud_folder(ResultFolder& folder,
                                                           const FrameSource& source,
                                                           const CloudOutput& how);

/// The results of a bag's sensors: a bag with the topics /penumbra/TOPIC and, if there are targets,
/// /penumbra/TOPIC/targets. The file appears with finish().
class CloudBag {
 public:
  explicit CloudBag(const std::filesystem::path& file)
      : pending_(file), writer_(pending_.part(), {.profile = "ros2"}) {}

  /// Returns the output of a sensor. `source`: of its frames. Both must outlive it.
  [[nodiscard]] std::unique_ptr<RunOutput> sensor(const std::string& topic,
                                                  const FrameSource& source,
                                                  const CloudOutput& how);
  void finish();

 private:
  PendingFile pending_;
  mcap::Writer writer_;
};

}  // namespace penumbra::io
