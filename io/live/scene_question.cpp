// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/live/scene_question.hpp>

namespace penumbra::io {

void SceneQuestion::follow(bool has_service, bool has_publisher, std::int64_t now) {
  has_service_ = has_service;
  if (!has_service) {
    asked_at_.reset();
    is_answered_ = false;
  }
  if (has_service || !has_publisher) publisher_since_.reset();
  if (!has_service && has_publisher && !publisher_since_) publisher_since_ = now;
  is_service_awaited_ = publisher_since_ && now - *publisher_since_ < patience;
}

bool SceneQuestion::is_due(std::int64_t now) const {
  return has_service_ && !is_answered_ && (!asked_at_ || now - *asked_at_ >= patience);
}

void SceneQuestion::ask(std::int64_t now, std::int64_t stamp) {
  asked_at_ = now;
  asked_stamp_ = stamp;
}

std::optional<std::int64_t> SceneQuestion::answer(std::int64_t stamp) {
  asked_at_.reset();
  if (stamp < asked_stamp_) return std::nullopt;
  is_answered_ = true;
  return std::max<std::int64_t>(asked_stamp_ - longest_latency, 1);
}

}  // namespace penumbra::io
