// SPDX-License-Identifier: Apache-2.0
#include <penumbra/tracking/track.hpp>

namespace penumbra {

std::string_view to_string(Source source) {
  switch (source) {
    case Source::measured:
      return "measured";
    case Source::predicted:
      return "predicted";
    case Source::held:
      return "held";
    case Source::lost:
      break;
  }
  return "lost";
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::accepted:
      return "accepted";
    case Outcome::refused_verdict:
      return "refused_verdict";
    case Outcome::refused_gate:
      return "refused_gate";
    case Outcome::refused_late:
      return "refused_late";
    case Outcome::refused_invalid:
      break;
  }
  return "refused_invalid";
}

}  // namespace penumbra
