// SPDX-License-Identifier: Apache-2.0
// What a whole frame costs in C++, for python_overhead.py: reads the number of passes over a
// recording's frames from each line of stdin and answers each frame's fastest time, milliseconds.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <limits>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>

#include <io/frame_reader.hpp>
#include <io/recording.hpp>
#include <io/recording_source.hpp>

namespace {

using namespace penumbra;

std::vector<io::FrameData> read_frames(const io::Recording& recording, const Robot& robot) {
  const io::FrameReader reader(recording, robot);
  std::vector<io::FrameData> frames(reader.size());
  for (std::size_t i = 0; i < frames.size(); ++i) reader.read(i, false, frames[i]);
  return frames;
}

double time_frame(Pipeline& pipeline, const io::FrameData& data) {
  const auto start = std::chrono::steady_clock::now();
  const FrameReport& report = pipeline.process(io::frame_of(data));
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  if (!has_pose(report.status)) throw InputError(report.message);
  return time.count();
}

void answer(Pipeline& pipeline, const std::vector<io::FrameData>& frames, int passes) {
  std::vector<double> fastest(frames.size(), std::numeric_limits<double>::infinity());
  for (int pass = 0; pass < passes; ++pass)
    for (std::size_t i = 0; i < frames.size(); ++i)
      fastest[i] = std::min(fastest[i], time_frame(pipeline, frames[i]));
  for (const double time : fastest) std::cout << time << ' ';
  std::cout << std::endl;
}

void run(const char* folder) {
  const auto recording = io::Recording::open(folder);
  const Robot robot = Robot::load(recording.urdf, recording.robot);
  const auto frames = read_frames(recording, robot);
  Pipeline pipeline(robot, recording.camera.camera, recording.pipeline_config());
  for (int passes = 0; std::cin >> passes;) answer(pipeline, frames, passes);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw InputError("usage: python_overhead RECORDING");
  run(argv[1]);
} catch (const InputError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
