#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a frame costs through Python beside C++ alone.

usage: PYTHONPATH=BUILD/python:BUILD/bench bench/python_overhead.py RECORDING [--rounds N] [--check]

A call is: a Frame made of arrays, and Pipeline.process. The recording's
frames are judged from Python and from C++ in turns, by the same pipeline, so that all memory lies
alike: that moves a frame's time by more than the calls cost. Of each frame the fastest of a round's
passes counts; each round makes a new pipeline; of the rounds the median counts. `beside` is what a call
takes beside the stages that C++ times within it. --check: exit status 1 where Python costs more than it
may.
"""

import argparse
import statistics
import sys
import time

import cpp_alone
import penumbra

ROUNDS = 10
PASSES = 100  # some of them meet the machine at rest
# Percent of C++'s time that a call from Python may cost more. Measured are 3 %; one copy of a
# 1280x720 depth image would be more than the limit.
LARGEST = 5.0


def call(pipeline, depth, joints):
    """Milliseconds: of all, and beside the stages."""
    start = time.perf_counter()
    report = pipeline.process(penumbra.Frame(depth, joints, stamp=None))
    took = 1e3 * (time.perf_counter() - start)
    assert report.status is penumbra.FrameStatus.ok
    times = report.timing
    return took, took - times.kinematics - times.render - times.classify


def mean_of_fastest(passes):
    """Of the frames, each by its fastest pass."""
    return statistics.mean(map(min, zip(*passes)))


def measure(pipeline, frames):
    """Milliseconds a frame: of C++, of Python, and of Python beside the stages."""
    arrays = [(frame.depth, frame.joints) for frame in frames]
    in_cpp, in_python = [], []
    for _ in range(PASSES):
        in_cpp.append(cpp_alone.frame_times(pipeline, frames))
        in_python.append([call(pipeline, *frame) for frame in arrays])
    whole = [[took for took, _ in calls] for calls in in_python]
    beside = [[rest for _, rest in calls] for calls in in_python]
    return [mean_of_fastest(passes) for passes in (in_cpp, whole, beside)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("recording")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--check", action="store_true")
    given = parser.parse_args()
    recording = penumbra.Recording.open(given.recording)
    robot = penumbra.Robot.load(recording.urdf, recording.robot)
    frames = [read.frame for read in penumbra.FrameReader(recording, robot, color=False)]
    more, rounds = [], []
    for _ in range(given.rounds):
        pipeline = penumbra.Pipeline(robot, recording.camera.camera, recording.pipeline_config())
        rounds.append(measure(pipeline, frames))
        more.append(100 * (rounds[-1][1] / rounds[-1][0] - 1))
    cpp, python, beside = (statistics.median(times) for times in zip(*rounds))
    size = pipeline.intrinsics
    low, middle, high = statistics.quantiles(more) if len(more) > 1 else 3 * more
    print(f"{len(frames)} frames of {size.width}x{size.height}, {pipeline.renderer.isa}, median of "
          f"{given.rounds} rounds: C++ {cpp:.4f} ms, Python {python:.4f} ms a frame, {middle:.1f} % more "
          f"(quartiles {low:.1f} to {high:.1f} %); beside the stages {1e3 * beside:.1f} us")
    if given.check and middle > LARGEST:
        sys.exit(f"a call from Python may cost {LARGEST} % more than one of C++")


if __name__ == "__main__":
    main()
