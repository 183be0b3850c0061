// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include <penumbra/cloud/cloud_pipeline.hpp>
#include <penumbra/cloud/cloud_tuning.hpp>

#include <io/assembly/cloud_input.hpp>

namespace penumbra::io {

/// Labels the clouds that a CloudInput gives out. Serves one thread at a time.
class CloudWorker {
 public:
  /// `poses`: guards the robot's poses, which other threads change meanwhile; null: nobody does.
  explicit CloudWorker(CloudInputOptions options, std::mutex* poses = nullptr)
      : options_(std::move(options)), mutex_(poses) {}

  /// Returns the report, valid until the next call. A cloud that cannot be labelled is unknown with
  /// its source_message. A new setup takes as long as a CloudPipeline's construction; throws
  /// InputError as that.
  [[nodiscard]] const CloudReport& label(const ReceivedCloud& cloud);

  /// Adds a cloud to a measurement of the sensor's rule: CloudTuner::add. Throws like label().
  bool measure(const ReceivedCloud& cloud, CloudTuner& tuner);

 private:
  /// Calls `use` with the cloud's scan, and where the robot was.
  void with_scan(const ReceivedCloud& cloud,
                 const std::function<void(const Scan&, const PoseAt&)>& use);
  void follow(const std::shared_ptr<CloudSetup>& setup);

  CloudInputOptions options_;
  std::mutex* mutex_;
  std::shared_ptr<CloudSetup> setup_;
  std::optional<PoseLookup> lookup_;
  std::optional<CloudPipeline> pipeline_;
};

}  // namespace penumbra::io
