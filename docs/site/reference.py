# SPDX-License-Identifier: Apache-2.0
"""The pages of the API: Python's from the module's own signatures and docstrings, C++'s from its
headers' comments."""

import enum
import importlib.util
import inspect
import pathlib
import re
from xml.etree import ElementTree

ROOT = pathlib.Path(__file__).parents[2]

# Folders of penumbra/ and what of them a program uses.
HEADERS = {
    "The whole method": ["pipeline/pipeline.hpp", "pipeline/frame.hpp", "targets/target.hpp",
                         "pipeline/link_points.hpp"],
    "Poses over time": ["pipeline/frame_queue.hpp", "time/pose_history.hpp",
                        "poses/robot_pose.hpp", "time/joint_buffer.hpp",
                        "time/transform_buffer.hpp"],
    "Robot": ["robot/robot.hpp"],
    "Camera": ["camera/camera.hpp", "camera/rectification.hpp", "camera/registration.hpp"],
    "Renderers": ["render/depth_renderer.hpp"],
    "Labels and verdicts": ["labels/labels.hpp", "targets/target_judge.hpp",
                            "cloud/scan.hpp"],
    "Tracking": ["tracking/trackers.hpp"],
    "Calibration": ["calibration/calibration.hpp"],
    "Planning": ["planning/look_ahead.hpp", "robot/trajectory.hpp", "planning/view_planning.hpp"],
    "Images, meshes, errors": ["base/image.hpp", "mesh/prepared_mesh.hpp", "base/error.hpp"],
}


def load_stub_maker():
    """What reads the module's signatures is there already, for its type stubs."""
    spec = importlib.util.spec_from_file_location("python_stubs", ROOT / "scripts" / "python_stubs.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def short(annotation):
    """Annotated[NDArray[float64], '(4, 4)'] as float64[4, 4]."""
    annotation = re.sub(r"NDArray\[(\w+)\]", r"\1", annotation)
    pattern = r"Annotated\[((?:[^\[\]]|\[[^\[\]]*\])*), '\(([^')]*?),?\)[^']*'\]"

    def shaped(match):
        kinds = re.sub(r"^Union\[(.*)\]$", r"\1", match[1]).split(", ")
        return " | ".join(f"{kind}[{match[2]}]" for kind in kinds)

    annotation = re.sub(pattern, shaped, annotation)
    annotation = annotation.replace("Union[str, os.PathLike[str]]", "PathLike")
    return annotation.replace("pathlib.", "")


# Where a group begins, in the module's own order.
GROUPS = {
    "Errors": "InputError", "Names": "Label", "Cameras": "Intrinsics", "Robots": "TriangleMesh",
    "Joint states": "JointBufferOptions", "Renderers": "RendererOptions", "Labels": "Tolerance",
    "Trackers": "PoseTrackerConfig", "Regions": "PixelBox", "Targets": "TargetThresholds",
    "What is said of targets": "Blame", "Frames and reports": "AttachedBody", "The session": "PipelineConfig",
    "Several cameras": "ViewCamera", "Files": "TargetsFile", "Recording": "Recorder",
}
IDENTITY = r"array\(\[\[1\., 0\., 0\., 0\.\],[^)]*1\.\]\]\)"
SHOWN = ("__len__", "__getitem__", "__iter__", "__next__")


def public(module):
    return {name: value for name, value in vars(module).items()
            if not name.startswith("_") and name != "version" and not inspect.ismodule(value)}


def python_names():
    """All that the reference must hold."""
    import penumbra

    names = set()
    for name, value in public(penumbra).items():
        names.add(f"penumbra.{name}")
        if inspect.isclass(value) and not issubclass(value, (enum.Enum, Exception)):
            names |= {f"penumbra.{name}.{member}" for member in vars(value)
                      if not member.startswith("_")}
    return names


def as_rst(text):
    """Prose as it stands, but for the names of pages."""
    text = re.sub(r"([*`|\\_])", r"\\\1", text.strip())
    return re.sub(r"docs/([a-z-]+)\.md", r":doc:`\1`", text)


def without_signature(doc):
    doc = re.sub(r"\n +", " ", doc or "")  # arrays among the defaults have several lines
    return "\n".join(line for line in doc.splitlines()
                     if not re.match(r"^(\d+\. )?\w+\(.*\) -> .*$|\w+\(\*args, \*\*kwargs\)$", line)
                     and line != "Overloaded function.")


def block(directive, options, text, *inner):
    lines = [directive, *[f"   {option}" for option in options], ""]
    for part in (text, *inner):
        lines += ["   " + line if line else "" for line in part.splitlines()] + [""]
    return "\n".join(lines)


class Writer:
    """Text of the reference in reStructuredText, from signatures that the module tells."""

    def __init__(self):
        self.stubs = load_stub_maker()

    def arguments(self, signature, skip_self):
        told = signature.arguments[1 if skip_self else 0:]
        return ", ".join(a.name if not a.type else
                         f"{a.name}: {short(a.type)}" + (" = ..." if a.has_default else "")
                         for a in told)

    def function(self, name, doc, kind="function", skip_self=False, options=()):
        """All of its overloads, and then what is said of them."""
        found = self.stubs.signatures(doc, name)
        assert found, f"{name} tells no signature: {doc!r}"
        lines = [f"{name}({self.arguments(s, skip_self)}) -> {short(s.result)}" for s in found]
        gap = " " * len(f".. py:{kind}:: ")
        return block(f".. py:{kind}:: " + f"\n{gap}".join(lines), options,
                     as_rst(re.sub(r"\n{2,}", "\n\n", without_signature(doc))))

    def property(self, name, value, defaults):
        result = self.stubs.signatures("get" + (value.fget.__doc__ or ""), "get")[0].result
        default = f" Default: ``{defaults[name]}``." if name in defaults else ""
        return block(f".. py:property:: {name}", [f":type: {short(result)}"],
                     as_rst(value.__doc__ or "") + default)

    def defaults(self, of):
        """As the constructor tells them, in words of Python."""
        doc = re.sub(r"\n +", " ", of.__init__.__doc__ or "")
        found = re.search(r"__init__\((.*)\) -> None", doc)
        told = {}
        for part in self.stubs.split(found[1], ", ") if found else []:
            name, *value = self.stubs.split(part, " = ")
            if value:
                text = re.sub(r"<(\w+\.\w+): [^>]*>", r"\1", value[0])
                text = re.sub(r"mappingproxy\((\{.*?\})\)", r"\1", text)
                told[name.split(":")[0].strip()] = re.sub(IDENTITY, "numpy.eye(4)", text)
        return told

    def members(self, of, defaults):
        for name, value in vars(of).items():
            if isinstance(value, property):
                yield self.property(name, value, defaults)
            elif name == "replace":
                yield block(".. py:method:: replace(**changes)", [], "The same with other values.")
            elif not name.startswith("_") or (name in SHOWN and getattr(of, name).__doc__):
                static = isinstance(value, staticmethod)
                yield self.function(name, getattr(of, name).__doc__, "method", not static,
                                    [":staticmethod:"] if static else [])

    def in_python(self, name, value, kind="function"):
        """What is written in Python, and so has a signature."""
        shown = re.sub(r"\(self(, )?", "(", str(inspect.signature(value)).replace("'", ""))
        shown = shown.removesuffix(" -> None") if kind == "class" else shown
        members = [self.in_python(key, member, "method") for key, member in vars(value).items()
                   if inspect.isclass(value) and not key.startswith("_")]
        texts = [value.__doc__, *([value.__init__.__doc__] if inspect.isclass(value) else [])]
        return block(f".. py:{kind}:: {name}{shown}", [],
                     "\n\n".join(as_rst(inspect.cleandoc(text)) for text in texts), *members)

    def described(self, name, value):
        if value.__module__ == "penumbra.recorder":
            return self.in_python(name, value, "class" if inspect.isclass(value) else "function")
        if not inspect.isclass(value):
            return self.function(name, value.__doc__)
        if issubclass(value, enum.Enum):
            names = ", ".join(f"``{member.name}``" for member in value)
            return block(f".. py:class:: {name}", [], as_rst(value.__doc__ or "") + f" One of {names}.")
        if issubclass(value, Exception):
            return block(f".. py:exception:: {name}", [], as_rst(value.__doc__))
        made = [s for s in self.stubs.signatures(value.__init__.__doc__ or "", "__init__")]
        fields = {key for key, member in vars(value).items() if isinstance(member, property)}
        heads = [self.head(name, signature, fields) for signature in made] or [name]
        said = as_rst(value.__doc__ or "")
        made_says = as_rst(without_signature(value.__init__.__doc__)) if made else ""
        return block(".. py:class:: " + ("\n" + " " * 14).join(heads), [],
                     f"{said} {' '.join(made_says.split())}".strip(),
                     *self.members(value, self.defaults(value)))

    def head(self, name, signature, fields):
        """Arguments that are fields say their types and defaults there."""
        told = [a.name if a.name in fields or not a.type else f"{a.name}: {short(a.type)}"
                for a in signature.arguments[1:]]
        return f"{name}({', '.join(told)})"


def groups(module):
    """{title: [(name, value)]}, all of the module."""
    starts, grouped, title = {first: title for title, first in GROUPS.items()}, {}, None
    for name, value in public(module).items():
        title = starts.get(name, title)
        grouped.setdefault(title, []).append((name, value))
    assert list(grouped) == list(GROUPS), "GROUPS of docs/site/reference.py: the module's order"
    return grouped


def python_pages():
    import penumbra

    writer, text = Writer(), ""
    for title, members in groups(penumbra).items():
        parts = "\n".join(writer.described(name, value) for name, value in members)
        text += f"\n### {title}\n\n```{{eval-rst}}\n.. py:currentmodule:: penumbra\n\n{parts}\n```\n"
    return text


def cpp_parts():
    """{header: [directive]} of classes, enums, functions and constants, as Doxygen found them."""
    folder = ROOT / "build" / "docs" / "doxygen" / "xml"
    space = ElementTree.parse(folder / "namespacepenumbra.xml").getroot()
    parts = {}
    for inner in space.iter("innerclass"):
        found = ElementTree.parse(folder / f"{inner.get('refid')}.xml").getroot().find("compounddef")
        if "<" in inner.text or inner.text.count("::") > 1:
            continue  # shown within its class
        line = f".. doxygen{found.get('kind')}:: {inner.text}\n   :members:\n   :undoc-members:\n"
        place = found.find("location")
        parts.setdefault(place.get("file"), []).append((int(place.get("line")), line))
    for member in space.iter("memberdef"):
        kind, place = member.get("kind"), member.find("location")
        name = f"penumbra::{member.findtext('name')}"
        if kind == "function":
            name += re.sub(r"\s*=\s*[^,)]*", "", member.findtext("argsstring"))
        parts.setdefault(place.get("file"), []).append(
            (int(place.get("line")), f".. doxygen{kind}:: {name}\n"))
    return {file: [line for _, line in sorted(lines)] for file, lines in parts.items()}


def cpp_pages():
    parts, text = cpp_parts(), ""
    for title, headers in HEADERS.items():
        text += f"\n### {title}\n"
        for header in headers:
            file = f"penumbra/{header}"
            text += f"\n#### {file}\n\n```{{eval-rst}}\n" + "\n".join(parts[file]) + "```\n"
    return text
