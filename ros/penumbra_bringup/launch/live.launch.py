# SPDX-License-Identifier: Apache-2.0
"""Starts `penumbra live`, which has to be on the PATH.

ros2 launch penumbra_bringup live.launch.py depth_topic:=/camera/camera/depth/image_rect_raw \
    arguments:="--package ur_description=/opt/ros/humble/share/ur_description"
"""
import shlex

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration


def start(context):
    depth_topic = LaunchConfiguration("depth_topic").perform(context)
    command = [LaunchConfiguration("program").perform(context), "live"]
    if depth_topic:
        command += ["--depth-topic", depth_topic]
    command += shlex.split(LaunchConfiguration("arguments").perform(context))
    return [ExecuteProcess(cmd=command, name="penumbra_live", output="screen",
                           respawn=True, respawn_delay=2.0)]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("program", default_value="penumbra"),
        DeclareLaunchArgument("depth_topic", default_value="",
                              description="found by type and name if empty"),
        DeclareLaunchArgument("arguments", default_value="",
                              description="further arguments of penumbra live"),
        OpaqueFunction(function=start),
    ])
