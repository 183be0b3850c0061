// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/web/live_matcher.hpp>

namespace penumbra::io {

LiveMatcher::Entry& LiveMatcher::entry(std::int64_t stamp) {
  // A clock that jumped back would leave all that follows behind what is kept.
  constexpr std::int64_t clock_jump = 1'000'000'000;
  if (!entries_.empty() && stamp < entries_.rbegin()->first - clock_jump) entries_.clear();
  Entry& found = entries_[stamp];
  if (entries_.size() > most_waiting && entries_.begin()->first != stamp)
    entries_.erase(entries_.begin());
  return found;
}

void LiveMatcher::add(LiveJob job) {
  Entry& to = entry(job.pose.stamp);
  job.targets = {};  // they live no longer than the next job
  to.job = std::move(job);
}

void LiveMatcher::add(TargetsMessage targets, std::uint64_t program) {
  LiveResults& results = entry(targets.header.stamp).published[program].results;
  results.targets = std::move(targets);
}

void LiveMatcher::add(Result result, KeptImage image, std::uint64_t program) {
  Entry& to = entry(image.header().stamp);
  LiveResults& results = to.published[program].results;
  if (result == Result::labels) {
    if (!to.number) to.number = labelled_++;
    results.labels = std::move(image);
  } else if (result == Result::virtual_depth) {
    results.virtual_depth = std::move(image);
  } else if (result == Result::overlay) {
    results.overlay = std::move(image);
  }
}

bool LiveMatcher::is_complete(Published& published, const Wanted& wanted, std::int64_t now) {
  const LiveResults& results = published.results;
  if (!results.targets || !results.labels) return false;
  if (!published.ready_since) published.ready_since = now;
  const bool has_depth =
      !wanted.virtual_depth || results.virtual_depth || !has_live_pose(results.targets->status);
  const bool has_all = has_depth && (!wanted.overlay || results.overlay);
  return has_all || now - *published.ready_since >= companion_wait;
}

LiveResults* LiveMatcher::complete(Entry& entry, const Wanted& wanted, std::int64_t now) {
  if (!entry.job) return nullptr;
  for (auto& [program, published] : entry.published)
    if (is_complete(published, wanted, now)) return &published.results;
  return nullptr;
}

std::shared_ptr<LiveScene> LiveMatcher::scene_of(const LiveJob& job) {
  if (job.setup != setup_) {
    setup_ = job.setup;
    scene_ = std::make_shared<LiveScene>(*setup_, ++scenes_);
  }
  return scene_;
}

std::shared_ptr<LiveFrame> LiveMatcher::take(const Wanted& wanted, std::int64_t now) {
  for (auto at = entries_.rbegin(); at != entries_.rend(); ++at) {
    Entry& found = at->second;
    LiveResults* const results = complete(found, wanted, now);
    if (results == nullptr) continue;
    auto scene = scene_of(*found.job);
    auto frame = std::make_shared<LiveFrame>(std::move(scene), std::move(*found.job),
                                             std::move(*results), *found.number);
    entries_.erase(entries_.begin(), at.base());
    return frame;
  }
  return nullptr;
}

}  // namespace penumbra::io
