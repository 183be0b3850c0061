// SPDX-License-Identifier: Apache-2.0
// A detection in every frame: is it the object or the robot, which link hides it, and where is the
// object meanwhile?
#include <cmath>
#include <iostream>
#include <optional>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/session/session.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

namespace {

constexpr PixelBox detected{460, 172, 38, 98};  // a detector's answer: a cylinder on the table

/// Stands in for a perception system that believes its depth image: the point at the box's middle,
/// in the optical frame. While the robot hides the object, that is a point of the robot. Nothing
/// where the image has a hole: depth 0 is no depth.
std::optional<Eigen::Vector3d> perceive(const Frame& frame, const Intrinsics& camera) {
  const int u = 479, v = 221;
  const double z = 1e-3 * std::get<ImageView<const std::uint16_t>>(frame.depth.view)(u, v);
  if (z == 0.0) return std::nullopt;
  return Eigen::Vector3d{(u - camera.cx()) / camera.fx() * z, (v - camera.cy()) / camera.fy() * z,
                         z};
}

Target target_of(const std::optional<Eigen::Vector3d>& point) {
  Target target;
  target.name = "cylinder";
  target.shape = RegionTarget{.region = detected, .expected_depth = 1.87};
  target.depth_margin = 0.10;              // metres: the depth is of its middle
  target.handling = PointTrackerConfig{};  // held while it is hidden
  target.estimate = TargetEstimate{.value = std::monostate()};  // not detected in this frame
  if (point) target.estimate->value = *point;
  return target;
}

void tell(const FrameReport& report, const std::optional<Eigen::Vector3d>& raw) {
  const TargetReport& target = report.targets[0];
  std::cout << "frame " << report.index << ": " << to_string(target.verdict);
  if (target.judgement && !target.judgement->blame.empty()) {
    const Blame& blame = target.judgement->blame.front();
    std::cout << ", " << std::lround(100 * blame.fraction) << " % behind " << blame.name;
  }
  if (target.estimate)
    std::cout << "; estimate " << to_string(*target.estimate) << " (" << raw->z() << " m away)";
  else
    std::cout << "; no estimate";
  if (target.handled && target.handled->position)
    std::cout << "; " << to_string(target.handled->source) << " at "
              << target.handled->position->transpose() << ", " << target.handled->age << " s old";
  std::cout << '\n';
}

void run(const std::filesystem::path& folder) {
  const io::Recording recording = io::Recording::open(folder);
  Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  Session session(std::move(robot), recording.camera.camera, recording.pipeline_config());

  int refused = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame frame = frames.read(i, /*with_color=*/false);
    const std::optional<Eigen::Vector3d> raw = perceive(frame, recording.camera.camera.intrinsics);
    frame.targets = {target_of(raw)};
    const FrameReport& report = session.process(frame);
    tell(report, raw);
    if (report.targets[0].estimate == Outcome::refused_verdict) ++refused;
  }
  std::cout << refused << " of " << frames.size() << " estimates refused\n";
}

}  // namespace

int main(int argc, char** argv) try {
  run(argc > 1 ? argv[1] : "examples/arm_over_table");
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
