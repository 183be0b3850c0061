# SPDX-License-Identifier: Apache-2.0
"""How scripts/docs.sh makes a site of README.md and docs/. The source folder is the repository's."""

import pathlib
import re
import shutil
import sys

from pygments.lexers.special import TextLexer

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).parent))

import pages  # noqa: E402  beside this file
import reference  # noqa: E402
from docutils import nodes  # noqa: E402

project = "Penumbra"
version = release = re.search(r"project\(Penumbra VERSION ([0-9.]+)",
                              (ROOT / "CMakeLists.txt").read_text())[1]
copyright = "the Penumbra authors"

root_doc = "README"
include_patterns = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/*.md", "examples/*/README.md",
                    "research/README.md", "ros/*/QUALITY_DECLARATION.md"]
exclude_patterns = ["build*", "out*", "web", ".git", ".cache"]
extensions = ["myst_parser", "breathe"]
myst_heading_anchors = 4
breathe_projects = {"penumbra": str(ROOT / "build" / "docs" / "doxygen" / "xml")}
breathe_default_project = "penumbra"
highlight_language = "none"

html_theme = "furo"
html_title = f"Penumbra {version}"
html_static_path = ["style.css"]
html_css_files = ["style.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None

def add_what_is_made(app, docname, source):
    if docname == root_doc:
        source[0] += pages.contents()
    elif docname == "docs/python":
        source[0] += reference.python_pages()
    elif docname == "docs/cpp":
        source[0] += reference.cpp_pages()


def find_target(app, env, node, contnode):
    """A link to a folder of the sources, which is no page, or to an <a id="..."> of a page."""
    page = (ROOT / node.get("refdoc", root_doc)).with_suffix(".md")
    name, _, anchor = node.get("reftarget", "").partition("#")
    target = page.parent / name if name else page
    if target.is_dir():
        return contnode
    if anchor and target.is_file() and f'<a id="{anchor}">' in target.read_text():
        link = (name.removesuffix("md") + "html" if name else "") + "#" + anchor
        return nodes.reference("", "", contnode, refuri=link)
    return None


def finish(app, exception):
    if exception is not None or app.builder.format != "html":
        return
    known = app.env.domaindata["py"]["objects"]
    lacking = sorted(reference.python_names() - known.keys())
    assert not lacking, f"not in the reference: {lacking}"
    out = pathlib.Path(app.outdir)
    shutil.copyfile(out / "README.html", out / "index.html")


def setup(app):
    app.add_lexer("csv", TextLexer)
    app.connect("source-read", add_what_is_made)
    app.connect("missing-reference", find_target, priority=1)
    app.connect("build-finished", finish)
