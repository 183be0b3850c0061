// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <apps/penumbra/arguments.hpp>

namespace penumbra::app {

// Exit statuses next to 0.
inline constexpr int device_failed = 1, nothing_judged = 2;

/// Each command returns its exit status. Throws InputError where the user's input is at fault.
[[nodiscard]] int execute(const RunArguments& arguments);
[[nodiscard]] int execute(const io::InitOptions& options);
[[nodiscard]] int execute(const RenderArguments& arguments);
[[nodiscard]] int execute(const InspectArguments& arguments);
[[nodiscard]] int execute(const DoctorArguments& arguments);
[[nodiscard]] int execute(const SimulateArguments& arguments);
[[nodiscard]] int execute(const TopicsArguments& arguments);
[[nodiscard]] int execute(const PlayArguments& arguments);
[[nodiscard]] int execute(const LiveArguments& arguments);
[[nodiscard]] int execute(const ViewArguments& arguments);
[[nodiscard]] int execute(const TuneArguments& arguments);
[[nodiscard]] int execute(const CalibrateArguments& arguments);
[[nodiscard]] int execute(const ViewPlanningArguments& arguments);
[[nodiscard]] int execute(const CloudArguments& arguments);
[[nodiscard]] int execute(const LookAheadArguments& arguments);

}  // namespace penumbra::app
