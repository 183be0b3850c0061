# SPDX-License-Identifier: Apache-2.0
"""A UR arm, a RealSense camera, Penumbra, MoveIt with an octomap without the arm, and rviz.

ros2 launch penumbra_examples cell.launch.py camera_pose:="0.8 0 0.6 3.14 0.5 0"
ros2 launch penumbra_examples cell.launch.py bag:=recorded moveit:=false      # without hardware

Copy it and change what your cell has of its own.
"""
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, ExecuteProcess, GroupAction,
                            IncludeLaunchDescription, OpaqueFunction)
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

ARGUMENTS = {
    "ur_type": ("ur5e", "the arm"),
    "robot_ip": ("192.168.1.10", "the arm's controller"),
    "camera_pose": ("", "of camera_link in base_link: x y z yaw pitch roll, metres and radians; "
                        "without a bag there is no default"),
    "camera": ("/camera/camera", "namespace of depth/image_rect_raw, if the bag has another"),
    "targets": ("", "topics of a detector's results, separated by commas"),
    "bag": ("", "a bag of such a cell, played in place of arm and camera"),
    "moveit": ("true", "false: no MoveIt"),
    "rviz": ("true", "false: no rviz"),
}


def included(package, file, **arguments):
    """Includes a launch file that gets these arguments only, not those of others by their names."""
    path = PathJoinSubstitution([FindPackageShare(package), "launch", file])
    return GroupAction([IncludeLaunchDescription(path, launch_arguments=arguments.items())],
                       forwarding=False)


def arm_and_camera(value):
    if value["bag"]:
        return [ExecuteProcess(cmd=["ros2", "bag", "play", value["bag"]])]
    numbers = value["camera_pose"].split()
    if len(numbers) != 6:
        raise RuntimeError("camera_pose:= must be x y z yaw pitch roll of camera_link in "
                           "base_link; `penumbra calibrate` finds where a camera stands")
    pose = zip(("--x", "--y", "--z", "--yaw", "--pitch", "--roll"), numbers)
    return [
        included("ur_robot_driver", "ur_control.launch.py", ur_type=value["ur_type"],
                 robot_ip=value["robot_ip"], launch_rviz="false"),
        included("realsense2_camera", "rs_launch.py"),
        Node(package="tf2_ros", executable="static_transform_publisher",
             arguments=[*(word for pair in pose for word in pair),
                        "--frame-id", "base_link", "--child-frame-id", "camera_link"]),
    ]


def move_group(value):
    from moveit_configs_utils import MoveItConfigsBuilder

    sensors = FindPackageShare("penumbra_examples").find("penumbra_examples")
    moveit = (MoveItConfigsBuilder("ur", package_name="ur_moveit_config")
              .robot_description_semantic("srdf/ur.srdf.xacro", {"name": value["ur_type"]})
              .sensors_3d(sensors + "/config/sensors_3d.yaml").to_moveit_configs())
    octomap = {"octomap_frame": "base_link", "octomap_resolution": 0.05,
               "publish_robot_description_semantic": True}
    return Node(package="moveit_ros_move_group", executable="move_group",
                parameters=[moveit.to_dict(), octomap])


def start(context):
    value = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    actions = arm_and_camera(value)
    actions.append(included("penumbra_ros", "penumbra.launch.py", camera=value["camera"],
                            targets=value["targets"], rviz=value["rviz"]))
    if value["moveit"].lower() == "true":
        actions.append(move_group(value))
    return actions


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in ARGUMENTS.items()]
    return LaunchDescription(declared + [OpaqueFunction(function=start)])
