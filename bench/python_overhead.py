#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a frame costs through Python beside C++ alone, on the same frames in turns.

usage: PYTHONPATH=BUILD/python bench/python_overhead.py BUILD/bench/python_overhead RECORDING

A call is: a Frame made of arrays, Pipeline.process, and the label image looked at. Of each frame the
fastest of all passes counts, so that what else the machine does matters little. Two programs are never
timed quite alike: `outside` is what a call takes beside the stages that C++ times within it.
"""

import subprocess
import sys
import time

import penumbra

ROUNDS = 20
PASSES = 20


def call(pipeline, depth, joints):
    start = time.perf_counter()
    report = pipeline.process(penumbra.Frame(depth, joints, stamp=None))
    shape = report.labels.shape
    took = 1e3 * (time.perf_counter() - start)
    assert report.status is penumbra.FrameStatus.ok and len(shape) == 2
    times = report.timing
    return took, took - times.kinematics - times.render - times.classify


def main(program, folder):
    recording = penumbra.Recording.open(folder)
    robot = penumbra.Robot.load(recording.urdf, recording.robot)
    frames = [(f.depth, f.frame.joints) for f in penumbra.FrameReader(recording, robot, color=False)]
    pipeline = penumbra.Pipeline(robot, recording.camera.camera, recording.pipeline_config())
    in_python = outside = in_cpp = [float("inf")] * len(frames)
    alone = subprocess.Popen([program, folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    for _ in range(ROUNDS):
        alone.stdin.write(f"{PASSES}\n")
        alone.stdin.flush()
        in_cpp = [min(a, float(b)) for a, b in zip(in_cpp, alone.stdout.readline().split())]
        for _ in range(PASSES):
            took = [call(pipeline, *frame) for frame in frames]
            in_python = [min(a, b) for a, (b, _) in zip(in_python, took)]
            outside = [min(a, b) for a, (_, b) in zip(outside, took)]
    alone.stdin.close()
    alone.wait()
    size = pipeline.intrinsics
    cpp, python = sum(in_cpp) / len(frames), sum(in_python) / len(frames)
    spare = sum(outside) / len(frames)
    print(f"{len(frames)} frames of {size.width}x{size.height}, {pipeline.renderer.isa}: C++ {cpp:.4f} ms, "
          f"Python {python:.4f} ms a frame: {1e3 * (python - cpp):.1f} us more, "
          f"{100 * (python / cpp - 1):.1f} %; outside {1e3 * spare:.1f} us, {100 * spare / cpp:.1f} %")


if __name__ == "__main__":
    main(*sys.argv[1:])
