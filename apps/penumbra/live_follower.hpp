// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <apps/penumbra/arguments.hpp>
#include <io/dds/participant.hpp>
#include <io/live/live_inbox.hpp>
#include <io/live/name_resolver.hpp>
#include <io/web/live_view.hpp>

namespace penumbra::app {

/// Hears one camera's images, its robot, and what `penumbra live` publishes of them; makes frames
/// of them for the page. For one thread.
class LiveFollower {
 public:
  /// `options` with the one camera. Throws InputError as LiveInbox.
  LiveFollower(io::Participant& graph, const io::LiveOptions& options,
               const io::NameResolver& names, bool reliable, io::LiveView& view);

  /// Subscribes to what the clients want by now, and tells the page what is amiss. To be called a
  /// few times in a second.
  void follow();

  /// Waits for messages, at most that long. Whether there is a new frame.
  [[nodiscard]] bool receive(std::chrono::nanoseconds at_most);

 private:
  static constexpr std::array results = {io::Result::labels, io::Result::targets,
                                         io::Result::virtual_depth, io::Result::overlay};
  [[nodiscard]] bool is_wanted(io::LiveRole role) const;
  [[nodiscard]] bool is_wanted(io::Result result) const;
  void follow_results();
  void take_inputs();
  void take_results();
  void take_result(io::Result result, const io::Sample& sample);
  void take_diagnostics();
  void take_jobs();
  [[nodiscard]] std::vector<std::string> missing() const;
  void tell_rivals(std::vector<io::LiveView::Diagnostic>& told) const;
  /// Empty: somebody does, or that is not listened for.
  [[nodiscard]] std::string nobody_publishes(io::LiveRole role) const;

  io::Participant& graph_;
  io::LiveInbox inbox_;
  bool reliable_;
  io::LiveView& view_;
  io::LiveMatcher matcher_;
  std::vector<std::unique_ptr<io::Subscription>> inputs_;  // of the inbox's topics
  std::array<std::string, results.size()> result_names_, result_types_;
  std::array<std::unique_ptr<io::Subscription>, results.size()> results_;
  std::unique_ptr<io::Subscription> diagnostics_;
  std::string speaker_;  // how the statuses of penumbra live with the same names begin
  std::vector<io::LiveView::Diagnostic> told_;  // by penumbra live, last
  std::chrono::steady_clock::time_point told_at_;
  std::chrono::steady_clock::time_point retry_at_{};  // a robot that could not be made
};

}  // namespace penumbra::app
