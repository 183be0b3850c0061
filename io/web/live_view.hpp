// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <io/web/live_frame.hpp>
#include <io/web/stored_view.hpp>

namespace penumbra::io {

/// Serves the page and the frames of a camera, or the scans of a sensor, that are judged live. Each
/// client gets the newest one when it is ready for it. Any thread may call all members. The mutex
/// is held only while pointers and texts are copied, so the judging thread never waits for a
/// client.
class LiveView final : public WebHandler {
 public:
  struct Diagnostic {
    std::string level, message;
  };

  /// `input`: its name, which the page shows. `of_clouds`: a sensor's that measures points.
  explicit LiveView(std::string input, bool of_clouds = false);

  /// Shows also how far this calibration is. Call it before show().
  void watch(const RunningCalibration& calibration) { calibration_ = &calibration; }

  /// Takes the newest frame, like FrameWatcher::take. Copies only the parts that clients want, and
  /// nothing without a client. Returns whether clients have to be woken. `now`: nanoseconds of a
  /// steady clock.
  bool show(const AssembledFrame& job, const FrameReport& report, const Drift& drift,
            std::int64_t now);
  /// Sets the diagnostics of `penumbra live` and the list of missing data.
  void set_diagnostics(std::vector<Diagnostic> diagnostics, std::vector<std::string> missing);

  /// Returns whether a client needs this part.
  [[nodiscard]] bool needs(Part part) const;

  [[nodiscard]] WebAnswer answer(const WebRequest& request) override;
  [[nodiscard]] std::unique_ptr<WebChannel> open_channel(const std::string& path) override;

 private:
  class Client;
  /// The current content for a client.
  struct Moment {
    std::shared_ptr<const LiveScene> scene;  // null: no frame was judged yet
    std::shared_ptr<const LiveFrame> frame;
    double rate = 0;  // frames per second
    Drift drift;
    std::vector<Diagnostic> diagnostics;
    std::vector<std::string> missing;
  };
  [[nodiscard]] Moment now() const;
  [[nodiscard]] std::string session() const;
  [[nodiscard]] Scene scene() const;

  const std::string input_;
  const bool of_clouds_;
  const RunningCalibration* calibration_ = nullptr;
  mutable std::mutex mutex_;
  std::shared_ptr<const LiveFrame> frame_;  // null without a client
  std::deque<std::int64_t> judged_at_;      // in the last two seconds, at least two
  Drift drift_;                             // of the newest frame
  std::weak_ptr<const void> setup_;         // the setup of scene_
  std::shared_ptr<const LiveScene> scene_;
  std::vector<Diagnostic> diagnostics_;
  std::vector<std::string> missing_;
  std::size_t clients_ = 0;
  std::array<std::size_t, part_count> needed_{};  // number of clients that need each part
};

}  // namespace penumbra::io
