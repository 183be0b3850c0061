# SPDX-License-Identifier: Apache-2.0
"""The OpenGL parts of docs/performance.md, from gl_benchmark's reports, one per device."""
from performance_table import table


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


def factor(gl, cpu):
    ratio = gl / cpu
    return f"{ratio:.3g}" if ratio >= 1 else f"**{ratio:.2f}**"


def ratios(report):
    """Per row: what it is; gl against one thread of cpu in frame time, CPU time, time per frame
    with frames ahead."""
    for row in report["frame_costs"]:
        contenders = named(row["contenders"])
        gl, cpu = contenders["gl"], contenders[best_cpu(report)]
        yield (what(row), row["triangles"], cpu["typical_ms"], gl["typical_ms"],
               gl["typical_ms"] / cpu["typical_ms"], gl["cpu_ms"] / cpu["cpu_ms"],
               cpu["ahead_frames_per_s"] / gl["ahead_frames_per_s"])


def ratio_table(report):
    rows = [(name, triangles, f"{cpu:.3f}", f"{gl:.3f}", *(factor(r, 1.0) for r in others))
            for name, triangles, cpu, gl, *others in ratios(report)]
    return table(("frame", "triangles", f"{best_cpu(report)}, ms", "gl, ms",
                  "gl / cpu: frame time", "CPU time", "time with frames ahead"), rows)


def verdict(report):
    """Where gl begins to pay, in words."""
    rows = list(ratios(report))
    parts = []
    for column, label in ((4, "frame time"), (5, "CPU time"), (6, "time with frames ahead")):
        values = [row[column] for row in rows]
        faster = [row[0] for row in rows if row[column] < 1.0]
        where = "nowhere" if not faster else "; ".join(faster)
        if len(faster) == len(rows):
            where = "everywhere"
        parts.append(f"{label} {min(values):.3g} to {max(values):.3g} times as long (shorter "
                     f"{where})")
    text = f'gl against one thread of cpu: {", ".join(parts)}.'
    if all(min(row[4:]) >= 1.0 for row in rows):
        text += " **Use `cpu` on this device.**"
    return text


def cameras_table(report):
    return table(("cameras", "renderer", "threads", "frames/s in all", "CPU ms per frame"),
                 [(r["cameras"], r["name"], r["threads"], f'{r["frames_per_s"]:.0f}',
                   f'{r["cpu_ms"]:.3f}')
                  for r in report["cameras"]])


def disturbed(report):
    if float(report["load_average"]["start"].split()[0]) <= 1.0:
        return ""
    return (" Other programs ran at the same time: frame times and frames/s are worse than on a "
            "quiet machine, CPU times less so.")


def settings(report):
    kind = "draws on the CPU" if report["software"] else "hardware"
    return (f'{report["device"]} ({kind}; LP_NUM_THREADS {report["lp_num_threads"]}). '
            f'{report["cpu"]}, {report["cores"]} cores; cpu: one thread, best SIMD target '
            f'{report["isa"]}. {report["rounds"]} rounds of {report["frames"]} frames, seed '
            f'{report["seed"]}. Load average (1, 5, 15 minutes): {report["load_average"]["start"]} '
            f'at the start, {report["load_average"]["end"]} at the end.{disturbed(report)}')


def section(report):
    parts = [f"### {short(report)}", settings(report), verdict(report), ratio_table(report),
             "Several cameras, xArm 7, 1280x720:", cameras_table(report)]
    return "\n\n".join(parts)


def gl_sections(reports):
    return "\n" + "\n\n".join(section(report) for report in reports) + "\n"


def devices(reports):
    """What was measured, and plainly what was not."""
    if all(report["software"] for report in reports):
        return ("**No GPU was available: these figures are of software OpenGL, which draws on the "
                "same CPU. What a GPU gains is not measured yet.**")
    return f'Measured: {", ".join(short(report) for report in reports)}.'


def paper_table(reports):
    rows = [("the paper", "GTX 1060", "its robot and camera", "< 10", "30")]
    for report in reports:
        for row in report["frame_costs"]:
            if row["axis"] != "frame":
                continue
            contenders = named(row["contenders"])
            for name, on in ((best_cpu(report), report["cpu"].split(",")[0] + ", one thread"),
                             ("gl", short(report))):
                c = contenders[name]
                rows.append((f"Penumbra, {name}", on, row["value"], f'{c["typical_ms"]:.3f}',
                             f'{c["ahead_frames_per_s"]:.0f}'))
    return table(("who", "on", "frame", "virtual depth, ms", "frames/s"), rows)


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
