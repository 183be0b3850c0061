# SPDX-License-Identifier: Apache-2.0
"""The launch file's restarts, with stand-ins for ROS 2's launch (Humble's names and arguments)."""
import importlib.util
import sys
import types
from types import SimpleNamespace as Context


def stand_in(name, **members):
    module = types.ModuleType(name)
    vars(module).update(members)
    sys.modules[name] = module


class Action:
    def __init__(self, **arguments):
        vars(self).update(arguments)


class Configuration:
    def __init__(self, name):
        self.name = name

    def perform(self, context):
        return {"program": "penumbra", "depth_topic": "/d", "arguments": "--pose 'a b'"}[self.name]


def launch_file(path):
    stand_in("launch", LaunchDescription=lambda entities: entities)
    stand_in("launch.actions", ExecuteProcess=Action, TimerAction=Action, OpaqueFunction=Action,
             DeclareLaunchArgument=lambda name, **arguments: Action(name=name, **arguments))
    stand_in("launch.substitutions", LaunchConfiguration=Configuration)
    spec = importlib.util.spec_from_file_location("live_launch", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main(path):
    running, ending = Context(is_shutdown=False), Context(is_shutdown=True)
    start = launch_file(path).generate_launch_description()[-1].function
    [process] = start(running)
    command = ["penumbra", "live", "--depth-topic", "/d", "--pose", "a b"]
    assert process.cmd == command, process.cmd
    assert not getattr(process, "respawn", False), "respawn asks for no exit status"
    for _ in range(2):  # the process that was started again, too
        for status in (0, 2):
            assert not process.on_exit(Context(returncode=status), running), status
        for status in (1, -6, -9):
            [timer] = process.on_exit(Context(returncode=status), running)
            [again] = timer.actions
            assert timer.period > 0 and again.cmd == command
            assert not process.on_exit(Context(returncode=status), ending), "it would not end"
        process = again


if __name__ == "__main__":
    main(sys.argv[1])
