// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <io/mcap/records.hpp>

namespace penumbra::io::mcap {

/// The faults of a file, each once, in the order of discovery. If there are very many, only the
/// first are kept.
class FaultLog {
 public:
  static constexpr std::size_t most = 1000;

  void add(std::uint64_t offset, const std::string& what) {
    if (faults_.size() > most) return;
    const auto same = [&](const Fault& f) { return f.offset == offset && f.what == what; };
    if (std::any_of(faults_.begin(), faults_.end(), same)) return;
    if (faults_.size() == most)
      faults_.push_back({offset, "from here on: more faults, which are not listed"});
    else
      faults_.push_back({offset, what});
  }

  [[nodiscard]] const std::vector<Fault>& all() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace penumbra::io::mcap
