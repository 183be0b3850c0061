# SPDX-License-Identifier: Apache-2.0
"""The launch files' arguments and restarts, with stand-ins for ROS 2's launch."""
import importlib.util
import pathlib
import sys
import tempfile
import types
from types import SimpleNamespace as Context

import yaml


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
        return context.launch_configurations[self.name]


class PackageShare(str):
    def find(self, package):
        return package


class MoveItConfigs:
    def __init__(self, robot, package_name):
        self.parameters = {"package": package_name}

    def robot_description_semantic(self, file, mappings):
        return self

    def sensors_3d(self, file):
        self.parameters["sensors"] = file
        return self

    def to_moveit_configs(self):
        return self

    def to_dict(self):
        return self.parameters


def launch_file(path, warnings):
    logger = Context(warning=warnings.append)
    stand_in("launch.logging", get_logger=lambda name: logger)
    stand_in("launch", LaunchDescription=lambda entities: entities,
             logging=sys.modules["launch.logging"])
    stand_in("launch.actions", TimerAction=Action, OpaqueFunction=Action, ExecuteProcess=Action,
             GroupAction=lambda actions, forwarding: actions[0] if not forwarding else None,
             IncludeLaunchDescription=lambda path, launch_arguments: (path, dict(launch_arguments)),
             DeclareLaunchArgument=lambda name, **arguments: Action(name=name, **arguments))
    stand_in("launch.substitutions", LaunchConfiguration=Configuration,
             PathJoinSubstitution="/".join)
    stand_in("launch_ros.substitutions", FindPackageShare=PackageShare)
    stand_in("moveit_configs_utils", MoveItConfigsBuilder=MoveItConfigs)
    stand_in("launch_ros.actions", Node=Action, LoadComposableNodes=Action)
    stand_in("launch_ros.descriptions", ComposableNode=Action)
    spec = importlib.util.spec_from_file_location("penumbra_launch", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.generate_launch_description()


def refuses(function, *arguments):
    try:
        function(*arguments)
    except RuntimeError as error:
        return str(error)
    return ""


def main(package):
    warnings = []
    *declared, start = launch_file(package / "launch/penumbra.launch.py", warnings)
    defaults = {argument.name: argument.default_value for argument in declared}

    def context(is_shutdown=False, **given):
        return Context(is_shutdown=is_shutdown, launch_configurations={**defaults, **given})

    running, ending = context(camera="/c", targets="/a,/b"), context(is_shutdown=True)
    [process] = start.function(running)
    [topics] = process.parameters
    assert topics["depth_topic"] == "/c/depth/image_rect_raw", topics
    assert topics["target_topics"] == ["/a", "/b"], topics
    [process_of_defaults] = start.function(context())
    assert process_of_defaults.parameters == [
        {"depth_topic": "/camera/camera/depth/image_rect_raw"}], process_of_defaults.parameters
    check_files(start, context, warnings, str(package / "config/penumbra.yaml"))

    start.function(context(robot_ip="192.168.1.10", camera_name="front", ur_type="ur5e"))
    assert not warnings, f"arguments of a launch file that includes this one: {warnings}"
    start.function(context(kamera="/c"))
    assert len(warnings) == 1 and "'camera'" in warnings[0], warnings

    for _ in range(2):  # the process that was started again, too
        assert not process.on_exit(Context(returncode=0), running)
        assert refuses(process.on_exit, Context(returncode=2), running), "launch shows the failure"
        for status in (1, -6, -9):
            [timer] = process.on_exit(Context(returncode=status), running)
            [again] = timer.actions
            assert timer.period > 0 and again.parameters == process.parameters
            assert not process.on_exit(Context(returncode=status), ending), "it would not end"
        process = again
    [loading] = start.function(context(container="/cell"))
    assert loading.target_container == "/cell"
    assert loading.composable_node_descriptions[0].plugin == "penumbra_ros::PenumbraNode"
    [_, rviz] = start.function(context(cameras="left=/l,right=/r", name="eyes", rviz="true"))
    assert ("penumbra/mask", "eyes/left/mask") in rviz.remappings, rviz.remappings
    assert pathlib.Path(rviz.arguments[1]).is_file(), rviz.arguments
    for file in ("config/penumbra.yaml", "rviz/penumbra.rviz"):
        assert yaml.safe_load((package / file).read_text())
    check_cell(package.parent / "penumbra_examples", set(defaults))


def check_files(start, context, warnings, file):
    """A params_file overrides defaults; one without our parameters is named, as is a missing one."""
    [of_file] = start.function(context(params_file=file))
    assert of_file.parameters == [file], "a default overrides the file"
    [both] = start.function(context(params_file=file, use_sim_time="False", camera="/c"))
    assert both.parameters == [
        file, {"depth_topic": "/c/depth/image_rect_raw", "use_sim_time": False}], both
    missing = file + ".none"
    assert missing in refuses(start.function, context(params_file=missing))
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as other:
        for names, given, is_ours in [
                (["amcl", "bt_navigator"], {}, False), (["penumbra"], {}, True), ([], {}, False),
                (["penumbra"], {"name": "eyes"}, False), (["amcl", "eyes"], {"name": "eyes"}, True),
                (["penumbra"], {"namespace": "cell"}, False),
                (["/cell/penumbra"], {"namespace": "cell"}, True),
                (["/*/penumbra"], {"ros_namespace": "/cell"}, True),
                (["/**"], {"namespace": "/a/b"}, True)]:
            other.seek(0)
            other.truncate()
            yaml.safe_dump({name: {"ros__parameters": {"queue": 4}} for name in names}, other)
            other.flush()
            warnings.clear()
            start.function(context(params_file=other.name, **given))
            assert [other.name in line for line in warnings] == ([] if is_ours else [True]), (
                names, given, warnings)
    warnings.clear()


def check_cell(package, arguments):
    """The example includes the launch file with arguments that it has."""
    *declared, start = launch_file(package / "launch/cell.launch.py", [])
    defaults = {argument.name: argument.default_value for argument in declared}
    cell = Context(launch_configurations={**defaults, "bag": "b", "moveit": "false"})
    [player, (path, given)] = start.function(cell)
    assert player.cmd[-1] == "b", player.cmd
    assert path == "penumbra_ros/launch/penumbra.launch.py" and set(given) <= arguments, given
    cell.launch_configurations.update(bag="", moveit="True")
    assert refuses(start.function, cell), "a camera that stands nowhere"
    cell.launch_configurations["camera_pose"] = "0.8 0 0.6 3.14 0.5 0"
    [*_, move_group] = actions = start.function(cell)
    assert len(actions) == 5, "arm, camera, its pose, Penumbra, MoveIt"
    sensors = move_group.parameters[0]["sensors"]
    [sensor] = yaml.safe_load((package.parent / sensors).read_text())["sensors"]
    assert sensor == "depth_without_robot"


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
