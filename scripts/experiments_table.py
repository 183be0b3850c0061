#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints an experiment's metrics.json as tables for docs/experiments.md.

scripts/experiments_table.py OUT/metrics.json KEY...     KEY: measures, columns in this order
"""
import json
import sys


def cell(measure):
    if measure["value"] is None:
        return "-"
    low, high = measure["ci95"]
    return f'{measure["value"]:.3g} ({low:.3g} to {high:.3g})'


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        metrics = json.load(file)
    keys = sys.argv[2:]
    for detection in metrics["detections"].values():
        print(f'\n{detection["name"]}\n')
        print("| method | " + " | ".join(keys) + " |")
        print("|---|" + "---|" * len(keys))
        for method in detection["methods"].values():
            print(f'| {method["name"]} | '
                  + " | ".join(cell(method["summary"][key]) for key in keys) + " |")


main()
