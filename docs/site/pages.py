# SPDX-License-Identifier: Apache-2.0
"""Which pages there are, in which order."""

PAGES = {
    "Start here": ["getting-started", "robot_and_camera", "hidden", "cloud", "diagnosis"],
    "Understand": ["method", "viewer", "install"],
    "Programs and ROS": ["python", "cpp", "ros2", "live"],
    "More tasks": ["calibration", "point_clouds", "robot_masks", "scene", "look_ahead"],
    "Reference": ["recording", "targets", "tracking", "tuning", "time", "performance", "latency", "architecture"],
}


def contents():
    """What stands at the left of every page: the README is read without it where there is no site."""
    text = ""
    for caption, pages in PAGES.items():
        names = "\n".join(f"docs/{page}" for page in pages)
        if caption == "Reference":
            names += "\nresearch/README\nexamples/arm_over_table/README\nCHANGELOG\nCONTRIBUTING\nSECURITY"
            names += "".join(f"\nros/{package}/QUALITY_DECLARATION"
                             for package in ("penumbra_ros", "penumbra_msgs", "penumbra_examples"))
        text += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{names}\n```\n"
    return text
