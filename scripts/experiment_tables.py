#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""The experiments' tables of docs/experiments.md, from what `penumbra_research` measured.

experiment_tables.py METRICS.json...: prints them, and the figures in README.md.
experiment_tables.py --into docs/experiments.md METRICS.json...: replaces what stands between
"<!-- begin NAME -->" and "<!-- end NAME -->" there.
"""
import argparse
import json
import pathlib
import re
import sys

from performance_table import table

# Key in metrics.json, head of the column, digits. The file has more, and confidence intervals.
COLUMNS = {
    "conveyor": (("translation_p95_mm", "p95 error hidden, mm", 1),
                 ("wrong_accepted_hidden", "wrong accepted hidden, per run", 2)),
    "handover": (("translation_p95_mm", "p95 error hidden, mm", 0),
                 ("on_robot_accepted", "on the body accepted, per run", 2),
                 ("refused_before_robot_percent", "hands in front refused, %", 1)),
}
README = {
    "conveyor": ("amodal", ("wrong_accepted_hidden", "translation_p95_mm"),
                 ("raw", "tracker", "urdf_filter", "penumbra")),
    "handover": ("keypoint", ("on_robot_accepted", "refused_before_robot_percent"),
                 ("raw", "tracker", "silhouette", "urdf_filter", "penumbra")),
}


def cell(measure, digits):
    return "-" if measure["value"] is None else f'{measure["value"]:.{digits}f}'


def tables(metrics):
    """Name between the marks, and table, of each kind of detection."""
    columns = COLUMNS[metrics["experiment"]]
    for lane, detection in metrics["detections"].items():
        rows = [(method["name"], *(cell(method["summary"][key], digits)
                                   for key, _, digits in columns))
                for method in detection["methods"].values()]
        yield (f'{metrics["experiment"]} {lane}',
               table(("method", *(head for _, head, _ in columns)), rows))


def told(metrics):
    lane, keys, methods = README[metrics["experiment"]]
    for method in methods:
        summary = metrics["detections"][lane]["methods"][method]["summary"]
        yield f"{method}: " + ", ".join(f'{key} {summary[key]["value"]:.2f}' for key in keys)


def read_metrics(name):
    try:
        return json.loads(name.read_text())
    except (OSError, ValueError) as fault:
        sys.exit(f"{name}: no metrics.json of an experiment: {fault}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("metrics", nargs="+", type=pathlib.Path, metavar="METRICS.json")
    parser.add_argument("--into", type=pathlib.Path, metavar="PAGE.md")
    arguments = parser.parse_args()
    page = arguments.into
    text = page.read_text() if page else None
    for name in arguments.metrics:
        metrics = read_metrics(name)
        for mark, rows in tables(metrics):
            if page is None:
                print(f"{mark}\n\n{rows}\n")
                continue
            pattern = re.compile(rf"(<!-- begin {mark} -->\n).*?(<!-- end {mark} -->)", re.DOTALL)
            text, found = pattern.subn(lambda match: match[1] + rows + "\n" + match[2], text)
            if found != 1:
                sys.exit(f'{page}: "{mark}" stands {found} times between begin and end, not once')
        if page is None:
            print(f'README.md, {metrics["experiment"]}, seeds {metrics["seeds"]}:')
            print("\n".join(told(metrics)) + "\n")
    if page:
        page.write_text(text)


if __name__ == "__main__":
    main()
