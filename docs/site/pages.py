# SPDX-License-Identifier: Apache-2.0
"""Which pages there are, in which order."""

PAGES = {
    "Start": ["getting-started", "install", "method"],
    "Use": ["cloud", "point_clouds", "targets", "ros2", "live", "viewer", "python", "cpp", "diagnosis", "tuning", "scene", "look_ahead", "calibration", "batch", "robot_masks"],
    "Details": ["recording", "tracking", "time"],
    "Reference": ["performance", "latency", "architecture"],
}


def contents():
    """What stands at the left of every page: the README is read without it where there is no site."""
    text = ""
    for caption, pages in PAGES.items():
        names = "\n".join(f"docs/{page}" for page in pages)
        if caption == "Reference":
            names += "\nresearch/README\nexamples/arm_over_table/README\nCHANGELOG\nCONTRIBUTING\nSECURITY"
        text += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{names}\n```\n"
    return text
