// SPDX-License-Identifier: Apache-2.0
// A detection in every frame: is it hidden, by which link, and where is the object meanwhile?
#include <iostream>

#include <penumbra/session/session.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

int main(int argc, char** argv) try {
  const auto recording = io::Recording::open(argc > 1 ? argv[1] : "examples/arm_over_table");
  const Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  Session session(robot, recording.camera.camera, recording.pipeline_config());

  // A detector's answer. Its point is held while it is hidden.
  const Target cylinder{
      .name = "cylinder",
      .shape = RegionTarget{.region = PixelBox{460, 172, 38, 98}, .expected_depth = 1.87},
      .depth_margin = 0.10,  // metres: the depth is of its middle
      .handling = PointTrackerConfig{}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame frame = frames.read(i, /*with_color=*/false);
    frame.targets = {cylinder};
    const TargetReport& target = session.process(frame).targets[0];
    std::cout << "frame " << i << ": " << to_string(target.verdict);
    if (target.judgement && !target.judgement->blame.empty())
      std::cout << " behind " << target.judgement->blame[0].name;
    if (target.handled && target.handled->position)
      std::cout << "; " << to_string(target.handled->source) << " at "
                << target.handled->position->transpose();
    std::cout << '\n';
  }
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
