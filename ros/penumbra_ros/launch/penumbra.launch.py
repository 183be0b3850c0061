# SPDX-License-Identifier: Apache-2.0
"""Starts a Penumbra node for one camera.

ros2 launch penumbra_ros penumbra.launch.py camera:=/camera/camera targets:=/detections

With container:=NAME the node is loaded into that running container; otherwise it is a process of its
own, which is started again 2 s after a failure, except for one of its parameters (status 2).
"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, TimerAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode

RESTART_DELAY = 2.0  # seconds
USERS_FAULT = 2  # exit status: trying again does not help

ARGUMENTS = {
    "camera": ("/camera/camera", "the camera's namespace, with depth/image_rect_raw below it"),
    "depth_topic": ("", "the depth images, in place of the camera's"),
    "robot_description_topic": ("robot_description", "the URDF"),
    "targets": ("", "topics of targets to judge, separated by commas"),
    "params_file": ("", "parameters as in config/penumbra.yaml"),
    "name": ("penumbra", "the node's name, and the first part of its topics"),
    "namespace": ("", "the node's namespace"),
    "container": ("", "a running component container to load the node into"),
    "use_sim_time": ("false", "true: diagnostics use /clock"),
}


def settings_of(value):
    parameters = [value["params_file"]] if value["params_file"] else []
    topics = {"depth_topic": value["depth_topic"] or value["camera"] + "/depth/image_rect_raw",
              "use_sim_time": value["use_sim_time"] == "true"}
    if value["targets"]:
        topics["target_topics"] = value["targets"].split(",")
    return {"package": "penumbra_ros", "name": value["name"], "namespace": value["namespace"],
            "parameters": parameters + [topics],
            "remappings": [("robot_description", value["robot_description_topic"])]}


def process_of(settings):
    def ended(event, context):
        if event.returncode == 0 or context.is_shutdown:
            return None
        if event.returncode == USERS_FAULT:
            raise RuntimeError("penumbra_node ended with status 2, see its message above")
        return [TimerAction(period=RESTART_DELAY, actions=[process_of(settings)])]

    return Node(executable="penumbra_node", output="screen", on_exit=ended, **settings)


def start(context):
    unknown = set(context.launch_configurations) - set(ARGUMENTS)
    if unknown:
        raise RuntimeError(f"there is no argument '{min(unknown)}'; the arguments are "
                           + ", ".join(ARGUMENTS))
    value = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    settings = settings_of(value)
    if not value["container"]:
        return [process_of(settings)]
    component = ComposableNode(plugin="penumbra_ros::PenumbraNode",
                               extra_arguments=[{"use_intra_process_comms": True}], **settings)
    return [LoadComposableNodes(target_container=value["container"],
                                composable_node_descriptions=[component])]


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in ARGUMENTS.items()]
    return LaunchDescription(declared + [OpaqueFunction(function=start)])
