// SPDX-License-Identifier: Apache-2.0
// Reports that outlive the call that made them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <penumbra/pipeline/target.hpp>

namespace penumbra::python {

struct OwnedBlame {
  std::string link;
  double fraction;
};

/// A judgement whose `blame` is in `blamed`.
struct OwnedJudgement : Judgement {
  OwnedJudgement(const Judgement& of, std::span<const std::string> links);
  std::vector<OwnedBlame> blamed;
};

struct OwnedTargetReport {
  OwnedTargetReport(const TargetReport& of, std::span<const std::string> links);
  std::string name;
  std::optional<std::int64_t> stamp;
  Verdict verdict;
  std::string reason;
  std::optional<OwnedJudgement> judgement;
  std::optional<Eigen::Vector3d> point;
  std::optional<HandledTarget> handled;
  std::optional<Outcome> estimate;
};

}  // namespace penumbra::python
