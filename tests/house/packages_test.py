# SPDX-License-Identifier: Apache-2.0
"""The ROS packages' package.xml, read as ROS's own build tools read them."""
import sys

from catkin_pkg.package import parse_package

for folder in sys.argv[1:]:
    package = parse_package(folder)
    package.validate()
    assert package.licenses == ["Apache-2.0"], package.licenses
