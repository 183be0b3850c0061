// SPDX-License-Identifier: Apache-2.0
// One frame of a recording, from files to an answer: what of this view is real, and what is robot?
// Link Penumbra::penumbra and Penumbra::io, which reads the recording's files. A node of your own
// has its Camera, its depth and its joints from its drivers and fills the same Frame; examples 02
// and 03 need Penumbra::penumbra alone.
#include <cstdlib>
#include <iostream>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <io/files/frame_reader.hpp>
#include <io/files/recording.hpp>

using namespace penumbra;

namespace {

void run(const std::filesystem::path& folder, std::size_t number) {
  const io::Recording recording = io::Recording::open(folder);
  Robot robot = recording.load_robot();
  const io::FrameReader frames(recording, robot);
  Pipeline pipeline(std::move(robot), recording.camera.camera, recording.pipeline_config());

  const Frame frame = frames.read(number, /*with_color=*/false);
  const FrameReport& report = pipeline.process(frame);
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
