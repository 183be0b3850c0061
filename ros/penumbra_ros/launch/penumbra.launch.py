# SPDX-License-Identifier: Apache-2.0
"""Starts a Penumbra node for cameras, or for clouds and laser scans.

ros2 launch penumbra_ros penumbra.launch.py camera:=/camera/camera targets:=/detections
ros2 launch penumbra_ros penumbra.launch.py cameras:=left=/left/depth/image_rect_raw,wrist=/wrist/depth/image_rect_raw
ros2 launch penumbra_ros penumbra.launch.py clouds:=/ouster/points,/scan

With container:=NAME the node is loaded into that running container; otherwise it is a process of its
own, which is started again 2 s after a failure, except for one of its parameters (status 2).
"""
import difflib
import pathlib
import re

import launch.logging
import yaml
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, TimerAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode

RESTART_DELAY = 2.0  # seconds
USERS_FAULT = 2  # exit status: trying again does not help
CAMERA = "/camera/camera"  # realsense2_camera's namespace
PUSHED = "ros_namespace"  # launch_ros keeps here what PushRosNamespace pushed
LIKE_OURS = 0.8  # similarity of a misspelt name; camera_name, which is another's, has 0.7 of camera

ARGUMENTS = {
    "camera": ("", "namespace of the camera's depth/image_rect_raw; without params_file: "
                   + CAMERA),
    "depth_topic": ("", "the depth images, in place of the camera's"),
    "cameras": ("", "of several cameras NAME=TOPIC, separated by commas: their depth images"),
    "clouds": ("", "topics of PointCloud2 or LaserScan, separated by commas; then a camera must be "
                   "named to be judged"),
    "robot_description_topic": ("robot_description", "the URDF"),
    "targets": ("", "topics of targets to judge, separated by commas"),
    "params_file": ("", "parameters as in config/penumbra.yaml; given arguments override them"),
    "name": ("penumbra", "the node's name, and the first part of its topics"),
    "namespace": ("", "the node's namespace"),
    "autostart": ("", "false: a lifecycle manager configures and activates the node"),
    "container": ("", "a running component container to load the node into"),
    "rviz": ("", "true: start rviz2, too; it shows the first camera"),
    "use_sim_time": ("", "true: diagnostics use /clock"),
}


def settings_of(value):
    parameters = [value["params_file"]] if value["params_file"] else []
    others = parameters or value["clouds"] or value["cameras"]
    camera = value["camera"] or ("" if others else CAMERA)
    given = {}
    for named in value["cameras"].split(",") if value["cameras"] else []:
        name, _, topic = named.partition("=")
        if not (name and topic):
            raise RuntimeError(f"cameras:={value['cameras']}: '{named}' is not NAME=TOPIC")
        given[f"cameras.{name}.depth_topic"] = topic
    if value["depth_topic"] or camera:
        given["depth_topic"] = value["depth_topic"] or camera + "/depth/image_rect_raw"
    for name in ("use_sim_time", "autostart"):
        if value[name]:
            given[name] = value[name].lower() == "true"
    if value["clouds"]:
        given["clouds"] = value["clouds"].split(",")
    if value["targets"]:
        given["target_topics"] = value["targets"].split(",")
    return {"package": "penumbra_ros", "name": value["name"], "namespace": value["namespace"],
            "parameters": parameters + ([given] if given else []),
            "remappings": [("robot_description", value["robot_description_topic"])]}


def process_of(settings):
    def ended(event, context):
        if event.returncode == 0 or context.is_shutdown:
            return None
        if event.returncode == USERS_FAULT:
            raise RuntimeError("penumbra_node ended with status 2, see its message above")
        return [TimerAction(period=RESTART_DELAY, actions=[process_of(settings)])]

    return Node(executable="penumbra_node", output="screen", on_exit=ended, **settings)


def rviz_of(value):
    below = value["name"]
    if value["cameras"]:
        below += "/" + value["cameras"].partition("=")[0]
    shown = ["markers", "points", "mask"]
    config = pathlib.Path(__file__).parent.parent / "rviz/penumbra.rviz"
    return Node(package="rviz2", executable="rviz2", namespace=value["namespace"],
                arguments=["-d", str(config)],
                remappings=[(f"penumbra/{topic}", f"{below}/{topic}") for topic in shown]
                + [("robot_description", value["robot_description_topic"])])


def nodes_of(parameters, path=""):
    """The patterns of the nodes that a file has parameters of."""
    for name, value in parameters.items() if isinstance(parameters, dict) else ():
        if name == "ros__parameters":
            yield path
        else:
            yield from nodes_of(value, f"{path}/{str(name).strip('/')}")


def fault_of_file(file, node):
    """Why a params_file has no parameters of a node; empty: it has some."""
    with open(file) as parameters:
        nodes = list(nodes_of(yaml.safe_load(parameters)))
    wildcards = {"/**": r"(/\w+)*", "*": r"\w+"}  # as rclcpp reads them
    for of in nodes:
        if re.fullmatch(re.sub(r"/\*\*|\*", lambda found: wildcards[found[0]], of), node):
            return ""
    return (f"params_file:={file} has no parameters of {node}"
            + (", but of " + ", ".join(nodes) if nodes else "")
            + ". Is it the params_file of a launch file that includes this one? Then include this "
              "one in a GroupAction with forwarding=False.")


def start(context):
    logger = launch.logging.get_logger("penumbra")
    # A launch file that includes this one has arguments of its own.
    for name in set(context.launch_configurations) - {*ARGUMENTS, PUSHED}:
        for ours in difflib.get_close_matches(name, ARGUMENTS, n=1, cutoff=LIKE_OURS):
            logger.warning(f"there is no argument '{name}'; did you mean '{ours}'?")
    value = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    if value["params_file"]:
        if not pathlib.Path(value["params_file"]).is_file():
            raise RuntimeError(f"params_file:={value['params_file']}: there is no such file")
        pushed = context.launch_configurations.get(PUSHED, "")
        space = value["namespace"] if value["namespace"].startswith("/") else \
            f"{pushed}/{value['namespace']}"
        node = re.sub("/+", "/", f"/{space}/{value['name']}")
        if fault := fault_of_file(value["params_file"], node):
            logger.warning(fault)
    settings = settings_of(value)
    others = [rviz_of(value)] if value["rviz"].lower() == "true" else []
    if not value["container"]:
        return [process_of(settings)] + others
    component = ComposableNode(plugin="penumbra_ros::PenumbraNode",
                               extra_arguments=[{"use_intra_process_comms": True}], **settings)
    return [LoadComposableNodes(target_container=value["container"],
                                composable_node_descriptions=[component])] + others


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in ARGUMENTS.items()]
    return LaunchDescription(declared + [OpaqueFunction(function=start)])
