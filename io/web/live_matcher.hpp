// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include <io/ros_frames/result_encoder.hpp>
#include <io/web/live_frame.hpp>

namespace penumbra::io {

/// Brings together what belongs to one image: the image with the robot's pose at its stamp, and
/// what one program published of it, by stamp. Newest wins. Knows no thread and no clock: `now` is
/// nanoseconds of a steady clock.
class LiveMatcher {
 public:
  /// Images that wait for their results, and results that wait for their image.
  static constexpr std::size_t most_waiting = 16;
  /// How long virtual depth and overlay are waited for once labels and targets are there; with one
  /// of a robot whose pose is unknown no virtual depth comes.
  static constexpr std::int64_t companion_wait = 60'000'000;

  /// What is subscribed to beside labels and targets.
  struct Wanted {
    bool virtual_depth = false, overlay = false;
  };

  void add(LiveJob job);
  /// `program`: who says so, a number; what two programs say is never put into one frame.
  void add(TargetsMessage targets, std::uint64_t program);
  void add(Result result, KeptImage image, std::uint64_t program);

  /// The newest image of which all has come that is wanted; those before it are forgotten. Nothing:
  /// there is none (yet).
  [[nodiscard]] std::shared_ptr<LiveFrame> take(const Wanted& wanted, std::int64_t now);

  /// Images that were labelled, whether they were shown or not.
  [[nodiscard]] std::uint64_t labelled() const { return labelled_; }

 private:
  /// Of one program.
  struct Published {
    LiveResults results;
    std::optional<std::int64_t> ready_since;
  };
  struct Entry {
    std::optional<LiveJob> job;
    std::map<std::uint64_t, Published> published;  // by program
    std::optional<std::uint64_t> number;           // once it is labelled
  };
  Entry& entry(std::int64_t stamp);
  [[nodiscard]] static bool is_complete(Published& published, const Wanted& wanted,
                                        std::int64_t now);
  /// The results of the first program of which all is there; null: none is.
  [[nodiscard]] static LiveResults* complete(Entry& entry, const Wanted& wanted, std::int64_t now);
  std::shared_ptr<LiveScene> scene_of(const LiveJob& job);

  std::map<std::int64_t, Entry> entries_;  // by stamp
  std::shared_ptr<LiveSetup> setup_;
  std::shared_ptr<LiveScene> scene_;
  std::uint64_t scenes_ = 0, labelled_ = 0;
};

}  // namespace penumbra::io
