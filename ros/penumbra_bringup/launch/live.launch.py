# SPDX-License-Identifier: Apache-2.0
"""Starts `penumbra live`, which has to be on the PATH.

ros2 launch penumbra_bringup live.launch.py depth_topic:=/camera/camera/depth/image_rect_raw \
    arguments:="--package ur_description=/opt/ros/humble/share/ur_description"

It is started again if it fails, but for status 2: its arguments or its input are at fault, which
trying again does not mend.
"""
import shlex

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, TimerAction
from launch.substitutions import LaunchConfiguration

RESTART_DELAY = 2.0  # seconds
NOT_RESTARTED = (0, 2)  # it was asked to end; its configuration is at fault


def process_of(command):
    def restart(event, context):
        if event.returncode in NOT_RESTARTED or context.is_shutdown:
            return None
        return [TimerAction(period=RESTART_DELAY, actions=[process_of(command)])]

    return ExecuteProcess(cmd=command, name="penumbra_live", output="screen", on_exit=restart)


def start(context):
    depth_topic = LaunchConfiguration("depth_topic").perform(context)
    command = [LaunchConfiguration("program").perform(context), "live"]
    if depth_topic:
        command += ["--depth-topic", depth_topic]
    command += shlex.split(LaunchConfiguration("arguments").perform(context))
    return [process_of(command)]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("program", default_value="penumbra"),
        DeclareLaunchArgument("depth_topic", default_value="",
                              description="found by type and name if empty"),
        DeclareLaunchArgument("arguments", default_value="",
                              description="further arguments of penumbra live"),
        OpaqueFunction(function=start),
    ])
