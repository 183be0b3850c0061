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
#include <io/web/live_matcher.hpp>
#include <io/web/stored_view.hpp>

namespace penumbra::io {

/// Serves the page and what is judged live: to each client the newest frame, when it is ready for
/// one. All by any thread.
class LiveView final : public WebHandler {
 public:
  struct Diagnostic {
    std::string level, message;
  };

  /// `input`: what the page is told that it shows.
  explicit LiveView(std::string input);

  /// The newest frame; `now`: nanoseconds of a steady clock. Then the server is to be woken.
  void publish(std::shared_ptr<const LiveFrame> frame, const Robot& robot, std::int64_t now);
  /// What penumbra live says of itself, and what is amiss here.
  void tell(std::vector<Diagnostic> diagnostics, std::vector<std::string> missing);

  [[nodiscard]] std::size_t clients() const;
  /// What the clients want, all together.
  [[nodiscard]] bool is_wanted(Part part) const;

  [[nodiscard]] WebAnswer answer(const WebRequest& request) override;
  [[nodiscard]] std::unique_ptr<WebChannel> open_channel(const std::string& path) override;

 private:
  class Client;
  /// What a client is sent of the moment.
  struct Moment {
    std::shared_ptr<const LiveFrame> frame;
    double rate = 0;  // frames in a second
    std::vector<Diagnostic> diagnostics;
    std::vector<std::string> missing;
  };
  [[nodiscard]] Moment newest() const;
  [[nodiscard]] std::string session() const;
  [[nodiscard]] Scene scene() const;

  const std::string input_;
  mutable std::mutex mutex_;
  std::shared_ptr<const LiveFrame> frame_;
  std::deque<std::int64_t> published_;  // when, of the last two seconds; the last two in any case
  std::optional<Scene> scene_;
  std::vector<std::string> links_;
  std::vector<Diagnostic> diagnostics_;
  std::vector<std::string> missing_;
  std::size_t clients_ = 0;
  std::array<std::size_t, part_count> wanted_{};  // by how many clients
};

}  // namespace penumbra::io
