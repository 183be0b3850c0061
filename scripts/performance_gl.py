# SPDX-License-Identifier: Apache-2.0
"""The OpenGL parts of docs/performance.md, from gl_benchmark's reports, one per device."""


def named(contenders):
    return {c["name"]: c for c in contenders}


def best_cpu(report):
    return f'cpu {report["isa"]}'


def what(row):
    if row["axis"] == "image":
        return f'by image size: {row["value"]}'
    return f'by triangles: {row["triangles"]}' if row["axis"] == "triangles" else row["value"]


def short(report):
    return report["device"].split(" (")[0].split("/")[0].split(", OpenGL")[0]


def ratios(report):
    """Yields a frame's name, and gl's frame time, CPU time, and time with frames submitted ahead,
    each divided by that of one thread of cpu."""
    for row in report["frame_costs"]:
        contenders = named(row["contenders"])
        gl, cpu = contenders["gl"], contenders[best_cpu(report)]
        yield (what(row), gl["typical_ms"] / cpu["typical_ms"], gl["cpu_ms"] / cpu["cpu_ms"],
               cpu["ahead_frames_per_s"] / gl["ahead_frames_per_s"])


def verdict(report):
    """Returns the ratios' ranges, and the frames in which gl is faster."""
    rows = list(ratios(report))
    parts = []
    for column, label in ((1, "the frame time"), (2, "the CPU time"),
                          (3, "the time with frames submitted ahead")):
        values = [row[column] for row in rows]
        faster = "; ".join(row[0] for row in rows if row[column] < 1.0)
        parts.append(f"{min(values):.3g} to {max(values):.3g} times {label}"
                     + (f" (less for {faster})" if faster else ""))
    text = f'Compared with one thread of `cpu`, `gl` takes {", ".join(parts)}.'
    if all(min(row[1:]) >= 1.0 for row in rows):
        text += " **Use `cpu` on this device.**"
    return text


def settings(report):
    kind = "draws on the CPU" if report["software"] else "hardware"
    return (f'{report["device"]} ({kind}). {report["cpu"]}, {report["cores"]} cores; cpu: one '
            f'thread, {report["isa"]}. {report["rounds"]} rounds of {report["frames"]} frames.')


def section(report):
    return "\n\n".join([f"### {short(report)}", settings(report), verdict(report)])


def gl_sections(reports):
    return "\n" + "\n\n".join(section(report) for report in reports) + "\n"


def devices(reports):
    """What was measured, and plainly what was not."""
    if all(report["software"] for report in reports):
        return ("**No GPU was available: these figures are of software OpenGL, which draws on the "
                "same CPU. What a GPU gains is not measured yet.**")
    return f'Measured: {", ".join(short(report) for report in reports)}.'


def gl_panels(reports):
    """Panels of (axis, rows, title) for performance_page.plot, two per device."""
    panels = []
    for report in reports:
        cpu = best_cpu(report)
        for axis in ("triangles", "image"):
            rows = []
            for row in report["frame_costs"]:
                if row["axis"] == axis:
                    c = named(row["contenders"])
                    rows.append({"value": row["value"], "triangles": row["triangles"],
                                 "ms": {cpu: c[cpu]["typical_ms"], "gl": c["gl"]["typical_ms"],
                                        "gl, CPU time": c["gl"]["cpu_ms"]}})
            panels.append((axis, rows, f"{short(report)}: ms per frame by {axis}"))
    return panels
