#!/usr/bin/env -S python3 -B
# SPDX-License-Identifier: Apache-2.0
"""Rewrites the tables of the performance page, and draws its plots, from the benchmarks' JSON.

performance_page.py RESULTS PAGE: reads RESULTS/renderers.json, RESULTS/scaling.json and
RESULTS/run.txt; replaces the text between "<!-- begin NAME -->" and "<!-- end NAME -->" in
PAGE/performance.md; writes PAGE/performance.svg.
"""
import json
import math
import pathlib
import re
import sys

from performance_table import table

WIDTH, HEIGHT, MARGIN = 460, 300, 56
COLOURS = ("#1f6fb2", "#d1662b", "#3a8f4d")


def renderers_table(report):
    names = [c["name"] for c in report["scenes"][0]["contenders"]]
    rows = [(scene["scene"], *(f'{c["typical_ms"]:.3f}' for c in scene["contenders"]))
            for scene in report["scenes"]]
    return table(("typical ms", *names), rows)


def settings(renderers, scaling):
    return (f'{renderers["cpu"]}; one thread; {renderers["rounds"]} rounds of '
            f'{renderers["frames"]} frames. OpenGL: {renderers["scenes"][0]["opengl"]}. '
            f'Scaling: {scaling["rounds"]} rounds of {scaling["frames"]} frames.')


def abscissa(axis, row):
    if axis == "image":
        width, height = row["value"].split("x")
        return int(width) * int(height)
    return row["triangles"] if axis == "triangles" else int(row["value"])


def panel(axis, rows, title, left, top):
    """One plot with both axes logarithmic."""
    points = {isa: [(math.log10(abscissa(axis, r)), math.log10(r["ms"][isa])) for r in rows]
              for isa in rows[0]["ms"]}
    xs = [x for line in points.values() for x, _ in line]
    ys = [y for line in points.values() for _, y in line]
    x0, x1, y0, y1 = min(xs), max(xs), math.floor(min(ys)), math.ceil(max(ys))

    def place(x, y):
        return (left + MARGIN + (x - x0) / (x1 - x0) * (WIDTH - 2 * MARGIN),
                top + HEIGHT - MARGIN - (y - y0) / (y1 - y0) * (HEIGHT - 2 * MARGIN))

    out = []
    for decade in range(y0, y1 + 1):
        a, b = place(x0, decade), place(x1, decade)
        out.append(f'<path class="grid" d="M{a[0]:.1f},{a[1]:.1f} L{b[0]:.1f},{b[1]:.1f}"/>')
        out.append(f'<text x="{a[0] - 6:.1f}" y="{a[1] + 4:.1f}" text-anchor="end">'
                   f'{10.0 ** decade:g} ms</text>')
    for row in rows:
        x, y = place(math.log10(abscissa(axis, row)), y0)
        out.append(f'<text transform="translate({x:.1f},{y + 12:.1f}) rotate(30)">'
                   f'{row["value"]}</text>')
    key = left + MARGIN + 8
    for colour, (isa, line) in zip(COLOURS, points.items()):
        path = " L".join("{:.1f},{:.1f}".format(*place(*p)) for p in line)
        out.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out.append(f'<text x="{key}" y="{top + MARGIN + 14}" fill="{colour}">{isa}</text>')
        key += 7 * len(isa) + 22
    out.append(f'<text x="{left + WIDTH / 2}" y="{top + 28}" text-anchor="middle" '
               f'font-weight="bold">{title}</text>')
    return out


def plot(panels):
    """Panels of (axis, rows, title), two in a line."""
    body = []
    for i, (axis, rows, title) in enumerate(panels):
        body += panel(axis, rows, title, (i % 2) * WIDTH, (i // 2) * HEIGHT)
    width, height = 2 * WIDTH, (len(panels) + 1) // 2 * HEIGHT
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        'font-family="sans-serif" font-size="11">',
        "<style>.grid{stroke:#ccc;stroke-width:1}</style>",
        f'<rect width="{width}" height="{height}" fill="white"/>', *body, "</svg>", ""])


def fill(document, parts):
    text = document.read_text()
    for name, content in parts.items():
        pattern = re.compile(rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        text, count = pattern.subn(lambda m, c=content: m[1] + c + "\n" + m[2], text)
        if count != 1:
            sys.exit(f"performance_page.py: {document} has no place for '{name}'")
    document.write_text(text)


def main():
    results, page = (pathlib.Path(argument) for argument in sys.argv[1:3])
    renderers = json.loads((results / "renderers.json").read_text())
    scaling = json.loads((results / "scaling.json").read_text())
    run = (results / "run.txt").read_text().splitlines()[:2]
    fill(page / "performance.md", {
        "settings": settings(renderers, scaling), "renderers": renderers_table(renderers),
        "run": ": ".join(run) + "."})
    (page / "performance.svg").write_text(plot(
        [(axis, rows, f"ms per frame by {axis}") for axis, rows in scaling["axes"].items()]))


if __name__ == "__main__":
    main()
