// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/diagnosis/diagnosis.hpp>
#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra {

class PlanForecast;
class ScanImage;
class Warnings;
/// Draws a sensor's scans. Defined in the component `cloud`.
[[nodiscard]] std::shared_ptr<ScanImage> make_scan_image(const Robot& robot,
                                                         const CloudConfig& config);

/// A pipeline that watches the frames that it judges: for mistakes in the setup, for a camera that
/// moves, and for what a planned motion will hide. The command line, live topics, the ROS 2 node
/// and Python all judge by this class. Serves one thread at a time.
class Session {
 public:
  /// Throws InputError as Pipeline does.
  Session(Robot robot, const Camera& camera, const PipelineConfig& config = {},
          const DriftLimits& limits = {});
  /// Of a sensor of points. `limits`: ranges of lidars are known to about a centimetre.
  Session(const Robot& robot, const CloudConfig& config,
          const DriftLimits& limits = {.position = 0.02, .rotation = 0.02})
      : Session(Pipeline(robot, config), make_scan_image(robot, config), limits) {}

  /// Judges a frame. Views in the report are valid until the next call.
  const FrameReport& process(const Frame& frame);

  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  [[nodiscard]] Pipeline& pipeline() { return pipeline_; }
  [[nodiscard]] const Pipeline& pipeline() const { return pipeline_; }

  /// Returns a line for each likely mistake in the frames so far. Diagnoses the setup.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Takes a tenth of a second, or about a second if something looks wrong.
  [[nodiscard]] const Diagnosis& diagnosis() const;
  /// Returns how far the camera has moved from its calibration.
  [[nodiscard]] const Drift& drift() const;

  /// Returns what finds the warnings about the frames since the last call, and begins them anew.
  /// For a stream without an end; any thread may call the result.
  [[nodiscard]] std::function<std::vector<std::string>()> take_warnings();

  /// Returns the number of different poses of the robot, up to SetupCheck::most, that warnings are
  /// based on.
  [[nodiscard]] std::size_t poses() const;

  /// Forgets targets, warnings and drift: a new sequence begins.
  void begin_sequence();

 private:
  Session(Pipeline of_scans, std::shared_ptr<ScanImage> scan, const DriftLimits& limits);
  [[nodiscard]] std::unique_ptr<Warnings> new_warnings() const;

  Pipeline pipeline_;
  std::optional<PipelineConfig> config_;  // of a camera; null: scans
  std::optional<Camera> camera_;          // likewise
  std::shared_ptr<ScanImage> scan_;       // null of a camera
  DriftLimits limits_;
  std::unique_ptr<Warnings> warnings_;
  std::optional<CalibrationWatch> watch_;
  std::unique_ptr<PlanForecast> forecast_;  // of a camera
};

}  // namespace penumbra
