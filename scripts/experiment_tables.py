#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""The experiments' tables of research/README.md, from what `penumbra_research` measured.

experiment_tables.py METRICS.json...: prints them, and the figures in README.md.
experiment_tables.py --into research/README.md METRICS.json...: replaces the text between
"<!-- begin NAME -->" and "<!-- end NAME -->" there.
"""
import argparse
import json
import pathlib
import re
import sys

from performance_table import table

# Key in metrics.json, head of the column or name of the table, digits. The file has more, and
# confidence intervals.
COLUMNS = {
    "conveyor": (("translation_p95_mm", "error", 1), ("wrong_accepted_hidden", "wrong", 2)),
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
    """Name between the marks, and table: one per measure if there are several kinds of detections."""
    experiment, kinds = metrics["experiment"], metrics["detections"]
    columns = COLUMNS[experiment]
    methods = next(iter(kinds.values()))["methods"]

    def summary(kind, method):
        return kinds[kind]["methods"][method]["summary"]

    if len(kinds) == 1:
        (kind,) = kinds
        rows = [(methods[method]["name"], *(cell(summary(kind, method)[key], digits)
                                            for key, _, digits in columns)) for method in methods]
        yield f"{experiment} {kind}", table(("method", *(head for _, head, _ in columns)), rows)
        return
    for key, name, digits in columns:
        rows = [(methods[method]["name"], *(cell(summary(kind, method)[key], digits)
                                            for kind in kinds)) for method in methods]
        heads = (kind.replace("_", ", ") for kind in kinds)
        yield f"{experiment} {name}", table(("method", *heads), rows)


def readme_figures(metrics):
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
                sys.exit(f'{page}: "{mark}" is marked {found} times, not once')
        if page is None:
            print(f'README.md, {metrics["experiment"]}, seeds {metrics["seeds"]}:')
            print("\n".join(readme_figures(metrics)) + "\n")
    if page:
        page.write_text(text)


if __name__ == "__main__":
    main()
