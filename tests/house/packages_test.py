# SPDX-License-Identifier: Apache-2.0
"""The package.xml files and the workspace, read as ROS's own build tools read them."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

from catkin_pkg.package import parse_package

root = pathlib.Path(sys.argv[1])
folders = [root, *sorted(file.parent for file in root.glob("ros/*/package.xml"))]
names = []
for folder in folders:
    package = parse_package(folder)
    package.validate()
    assert package.licenses == ["Apache-2.0"], package.licenses
    names.append(package.name)
assert names == ["penumbra", "penumbra_examples", "penumbra_msgs", "penumbra_ros"], names

# colcon does not look for packages inside of a package, so docs/ros2.md links ros/.
if not shutil.which("colcon"):
    print("skipped: no colcon")
    sys.exit(77)
with tempfile.TemporaryDirectory() as workspace:
    source = pathlib.Path(workspace, "src")
    source.mkdir()
    (source / "penumbra").symlink_to(root)
    (source / "penumbra_ros").symlink_to("penumbra/ros")
    listed = subprocess.run(["colcon", "list", "--names-only"], cwd=workspace,
                            capture_output=True, text=True, check=True).stdout.split()
assert listed == names, listed
