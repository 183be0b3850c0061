// SPDX-License-Identifier: Apache-2.0
// Clouds in, clouds without the robot out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <penumbra/cloud/cloud_pipeline.hpp>
#include <penumbra/cloud/cloud_tuning.hpp>

#include <io/assembly/bag_topics.hpp>
#include <io/assembly/camera_mount.hpp>
#include <io/cloud/cloud_points.hpp>
#include <io/cloud/cloud_summary.hpp>
#include <io/run/run_input.hpp>

namespace penumbra::io {

struct CloudRunOptions {
  InputOptions input;            ///< a recording folder with `frames.cloud`, or a bag
  std::filesystem::path output;  ///< empty: write nothing
  bool tune = false;             ///< measure the sensors' rules, without output
  /// Called once, before clouds. `sensors`: their names. May be null, as on_cloud.
  std::function<void(const Robot&, std::span<const std::string> sensors)> on_begin;
  /// Called for each labelled cloud. `index`: of the sensor's clouds. `fault`: why this one is not
  /// labelled, if not empty. Arguments are valid during the call only.
  std::function<void(std::size_t sensor, std::uint64_t index, const PointsView& points,
                     const CloudReport& report, const std::string& fault)>
      on_cloud;
  /// What options change of the recording's rule, or of the default, in their order.
  std::vector<std::function<void(CloudRule&)>> rule_changes;
  CloudOutput how;
  bool use_times = true;     ///< see CloudInputOptions
  bool has_rays = true;      ///< see CloudInputOptions
  std::string sensor_frame;  ///< likewise; of bags
  int threads = 1;
  bool force = false;  ///< also a folder with other files
};

struct CloudRunResult {
  std::vector<CloudSummary> sensors;
  std::vector<CloudTuning> tunings;  ///< of each sensor, if asked for
  std::vector<std::string> notes;
  bool is_stopped = false;  ///< by `go_on`
};

/// Labels all clouds of an input and writes them: of a recording into OUT/clouds, in files of the
/// same names, next to report.json; of a bag into a bag (*.mcap), in topics /penumbra/TOPIC.
/// `print` gets the used topics; stops if `go_on` returns false. Throws InputError that names the
/// file.
[[nodiscard]] CloudRunResult run_clouds(const CloudRunOptions& options, const LineSink& print,
                                        const std::function<bool()>& go_on);

/// The robot of a bag, and its sensors that measure points.
struct BagClouds {
  Robot robot;
  BagTopics topics;
  std::vector<CameraMount> mounts;  ///< of each of topics.clouds
  std::vector<TransformMessage> static_transforms;
};
[[nodiscard]] BagClouds open_bag_clouds(const InputOptions& options, const LineSink& print);

}  // namespace penumbra::io
