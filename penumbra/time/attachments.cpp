// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include <penumbra/time/pose_history.hpp>

namespace penumbra {
namespace {

constexpr std::int64_t always = std::numeric_limits<std::int64_t>::min();

}  // namespace

void Attachments::attach(std::int64_t stamp, AttachedBody body) {
  for (Change& known : changes_)
    if (body.mesh && known.is_attached && !known.body.mesh && known.body.name == body.name &&
        known.body.link == body.link)
      known.body = body;
  add({stamp, std::move(body), true});
}

void Attachments::detach(std::int64_t stamp, std::string_view name) {
  add({stamp, {.name = std::string(name), .link = {}, .mesh = {}}, false});
}

void Attachments::add(Change change) {
  const auto later = [](std::int64_t stamp, const Change& other) { return stamp < other.stamp; };
  changes_.insert(std::upper_bound(changes_.begin(), changes_.end(), change.stamp, later),
                  std::move(change));
  if (changes_.size() > max_changes) merge(max_changes / 2);
}

void Attachments::restart() { merge(changes_.size()); }

/// Replaces the first changes by the bodies that are attached after them.
void Attachments::merge(std::size_t count) {
  if (count == 0) return;
  std::vector<AttachedBody> bodies;
  at(changes_[count - 1].stamp, bodies);
  std::vector<Change> merged;
  merged.reserve(changes_.size());
  for (AttachedBody& body : bodies) merged.push_back({always, std::move(body), true});
  const std::int64_t last = changes_[count - 1].stamp;
  for (Change& change : changes_)
    if (change.stamp > last) merged.push_back(std::move(change));
  changes_ = std::move(merged);
}

std::optional<std::int64_t> Attachments::last_change(std::string_view name) const {
  const auto is_of_body = [&](const Change& change) { return change.body.name == name; };
  const auto last = std::find_if(changes_.rbegin(), changes_.rend(), is_of_body);
  return last == changes_.rend() ? std::nullopt : std::optional(last->stamp);
}

void Attachments::at(std::int64_t stamp, std::vector<AttachedBody>& bodies) const {
  bodies.clear();
  for (const Change& change : changes_) {
    if (change.stamp > stamp) break;
    std::erase_if(bodies, [&](const AttachedBody& body) { return body.name == change.body.name; });
    if (change.is_attached) bodies.push_back(change.body);
  }
}

}  // namespace penumbra
