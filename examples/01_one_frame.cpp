// SPDX-License-Identifier: Apache-2.0
// One frame of a recording: what of this view is real, and what is robot? A node of your own fills
// the same Frame from its drivers.
#include <cstdlib>
#include <iostream>

#include <penumbra/base/error.hpp>
#include <penumbra/session/session.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

int main(int argc, char** argv) try {
  const auto recording = io::Recording::open(argc > 1 ? argv[1] : "examples/arm_over_table");
  const Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  Session session(robot, recording.camera.camera, recording.pipeline_config());

  const Frame frame = frames.read(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 6,
                                  /*with_color=*/false);
  const FrameReport& report = session.process(frame);
  if (report.status != FrameStatus::ok) throw InputError(report.message);

  std::cout << "robot " << report.pixels.robot.value() << " pixels: front " << report.pixels.front
            << ", occluded " << report.pixels.occluded << ", unknown " << report.pixels.unknown
            << ", beyond " << report.pixels.beyond << '\n';
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
