// SPDX-License-Identifier: Apache-2.0
// One frame of a recording: what of this view is real, and what is robot? Link Penumbra::io. A node
// of your own fills the same Frame from its drivers.
#include <cstdlib>
#include <iostream>

#include <penumbra/base/error.hpp>
#include <penumbra/session/session.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

namespace {

void run(const std::filesystem::path& folder, std::size_t number) {
  const io::Recording recording = io::Recording::open(folder);
  Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  Session session(std::move(robot), recording.camera.camera, recording.pipeline_config());

  const Frame frame = frames.read(number, /*with_color=*/false);
  const FrameReport& report = session.process(frame);
  if (report.status != FrameStatus::ok) throw InputError(report.message);

  std::cout << "robot " << report.pixels.robot.value() << " pixels: front " << report.pixels.front
            << ", occluded " << report.pixels.occluded << ", unknown " << report.pixels.unknown
            << ", beyond " << report.pixels.beyond << '\n';
}

}  // namespace

int main(int argc, char** argv) try {
  run(argc > 1 ? argv[1] : "examples/arm_over_table",
      argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 6);
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
