#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""sbom.py BUILD FILE: writes NAME.spdx.json (SPDX 2.3) next to a wheel or a .changes file.

It lists the libraries that the programs in FILE link (DYNAMIC_LINK), bring along (CONTAINS), and have compiled
in as headers or archives (STATIC_LINK). BUILD is the folder in which Ninja made the programs. The licences must
be those of debian/copyright. The time is SOURCE_DATE_EPOCH.
"""
import email
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import urllib.parse
import uuid
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
KERNEL = "linux"  # its headers come with glibc's, and its licence does not reach their users
packages: dict[str, dict] = {}
licences: dict[str, dict] = {}
relationships: set[tuple[str, str, str]] = set()


def output(*command: object) -> str:
    return subprocess.run([str(word) for word in command], check=command[:2] != ("dpkg", "-S"), text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout


def add(name: str, version="NOASSERTION", supplier="NOASSERTION", licence="NOASSERTION", purl="", **more) -> str:
    """Adds a package unless more is known of it, and returns its identifier."""
    this = "SPDXRef-" + re.sub("[^A-Za-z0-9.-]", "-", name)
    if purl:
        more["externalRefs"] = [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                 "referenceLocator": f"pkg:{purl}"}]
    if this not in packages or supplier != "NOASSERTION":
        packages[this] = {
            "SPDXID": this, "name": name, "versionInfo": version or "NOASSERTION",
            "supplier": re.sub("<(.*)>", r"(\1)", supplier), "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseDeclared": licence, **more}
    return this


def add_page() -> str:
    """Adds the library in the viewer's page."""
    known = (ROOT / "debian/copyright").read_text()
    name, version, text = (ROOT / "web/dist/licences.txt").read_text().split(maxsplit=2)
    holder = re.search("Copyright © ([0-9-]+ (.*))", text)
    if (not text.startswith("The MIT License") or not holder or holder[1] not in known
            or set(re.findall("^License: (.+)", known, re.M)) != {"Apache-2.0", "Apache-2.0 and Expat", "Expat"}):
        sys.exit("sbom.py: debian/copyright lacks what web/dist/licences.txt says, or names more: make them agree")
    return add(name, version, f"Organization: {holder[2]}", "MIT", f"npm/{name}@{version}", copyrightText=holder[0])


def add_debian(name: str, version: str, machine: str, maintainer: str) -> str:
    """Adds a Debian package with the text of its licences."""
    this = add(name, version, f"Organization: {maintainer}",
               purl=f"deb/debian/{name}@{urllib.parse.quote(version, safe='~')}?arch={machine}")
    licence = this.replace("SPDXRef", "LicenseRef")
    text = pathlib.Path("/usr/share/doc", name, "copyright").read_text(errors="replace")
    licences[licence] = {"licenseId": licence, "name": f"licences of {name}", "extractedText": text}
    packages[this]["licenseDeclared"] = licence
    return this


def owners(paths: set[str]) -> dict[str, list[str]]:
    """Returns name, version, architecture, maintainer and source of the Debian package of each path."""
    lines = [line.rsplit(": ", 1) for line in output("dpkg", "-S", *sorted(paths)).splitlines()]
    names = {path: those.split(", ")[0] for those, path in lines if path in paths}
    form = "${binary:Package}\t${Package}\t${Version}\t${Architecture}\t${Maintainer}\t${source:Package}\n"
    rows = output("dpkg-query", "-W", "-f", form, *sorted(set(names.values()))).splitlines() if names else []
    facts = {row.split("\t")[0]: row.split("\t")[1:] for row in rows}
    return {path: facts.get(name) or facts[name.split(":")[0]] for path, name in names.items()}


def inputs(build: pathlib.Path, program: str) -> set[str]:
    """Returns the headers, archives and scripts of the page that a program was made of, if it was made here."""
    targets = output("ninja", "-C", build, "-t", "targets", "all")
    made = re.search(rf"^((?:.*/)?{re.escape(program)}): \w*_LINKER__", targets, re.M)
    if not made:
        return set()
    parts = output("ninja", "-C", build, "-t", "inputs", made[1]).splitlines()
    headers = output("ninja", "-C", build, "-t", "deps", *(part for part in parts if part.endswith(".o")))
    files = [part for part in parts if part.endswith((".a", ".js"))] + re.findall("^    (.*)", headers, re.M)
    return {os.path.normpath(build / file) for file in files}


def describe(build: pathlib.Path, this: str, fields, folder: pathlib.Path, siblings: dict[str, str]) -> None:
    """Relates a package, unpacked in a folder, to what it is made of. Siblings: libraries of those built with it."""
    linked: set[str] = set()
    files: set[str] = set()
    for program in folder.rglob("*"):
        if program.is_file() and not program.is_symlink() and program.open("rb").read(4) == b"\x7fELF":
            linked |= set(re.findall(r"NEEDED.*\[(.*)\]", output("readelf", "-dW", program)))
            files |= inputs(build, program.name)
    machine = ["-a", fields["Architecture"]] if fields["Architecture"] else []
    place = output("dpkg-architecture", *machine, "-qDEB_HOST_MULTIARCH").strip()
    libraries = owners({f"{root}/{place}/{library}" for library in linked for root in ("/lib", "/usr/lib")})
    related = {("DYNAMIC_LINK", siblings[library]) for library in linked & set(siblings)}
    lost = linked - {os.path.basename(path) for path in libraries} - set(siblings)
    if lost:
        sys.exit(f"sbom.py: {folder.name}: no Debian package has {', '.join(sorted(lost))}")
    for path, (*facts, _) in libraries.items():
        bundled = any(folder.rglob(os.path.basename(path)))
        related |= {(kind, add_debian(*facts)) for kind in ["DYNAMIC_LINK"] + ["CONTAINS"] * bundled}
    compiled = owners(files)
    known = {KERNEL, *(source for *_, source in libraries.values())}
    related |= {("STATIC_LINK", add_debian(*facts)) for *facts, source in compiled.values() if source not in known}
    for path in files - set(compiled):
        if "/web/dist/" in path:
            packages[this]["licenseDeclared"] = "Apache-2.0 AND MIT"
            related.add(("CONTAINS", add_page()))
        elif "/include/" in path and not path.startswith(f"{ROOT}/"):  # a Python or a pybind11 that is not Debian's
            related.add(("STATIC_LINK", add(re.sub(".*/include/([^/]+)/.*", r"\1", path))))
    wanted = fields.get_all("Requires-Dist") or (fields["Depends"] or "").split(", ")
    firsts = "\n".join(want.split(" | ")[0] for want in wanted)
    for name, versions in re.findall(r"^([\w.+-]+)(?::any)? *\(?([^;)\n]*)\)?$", firsts, re.M):
        other = add(name, versions)
        related |= {("DEPENDS_ON", other)} if ("DYNAMIC_LINK", other) not in related else set()
    relationships.update({(this, *relation) for relation in related} | {("SPDXRef-DOCUMENT", "DESCRIBES", this)})


def main(build: pathlib.Path, file: pathlib.Path, temporary: pathlib.Path) -> None:
    parts = []
    debs = re.findall(r"^ \S{64} \d+ (\S+\.deb)$", file.read_text(), re.M) if file.suffix == ".changes" else []
    for part in [file.parent / deb for deb in debs] or [file]:
        folder = temporary / part.name
        if debs:
            output("dpkg-deb", "-x", part, folder)
            fields = email.message_from_string(output("dpkg-deb", "-f", part))
        else:
            zipfile.ZipFile(part).extractall(folder)
            fields = email.message_from_string(next(folder.glob("*.dist-info/METADATA")).read_text())
        digest = hashlib.sha256(part.read_bytes()).hexdigest()
        this = add(fields["Package"] or fields["Name"], fields["Version"], "Organization: Penumbra", "Apache-2.0",
                   packageFileName=part.name, checksums=[{"algorithm": "SHA256", "checksumValue": digest}])
        parts.append((this, fields, folder))
    siblings = {library.name: this for this, _, folder in parts for library in folder.glob("usr/lib/*/*.so.*")}
    for part in parts:
        describe(build, *part, siblings)
    contents = [packages[name] for name in sorted(packages)]
    digest = hashlib.sha256(json.dumps(contents).encode()).hexdigest()
    created = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"])))
    kinds = ("spdxElementId", "relationshipType", "relatedSpdxElement")
    file.with_suffix(".spdx.json").write_text(json.dumps({
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": file.stem,
        "documentNamespace": f"https://spdx.org/spdxdocs/{file.stem}-{uuid.UUID(digest[:32])}",
        "creationInfo": {"created": created, "creators": ["Organization: Penumbra", "Tool: scripts/sbom.py"]},
        "packages": contents,
        "hasExtractedLicensingInfos": [licences[name] for name in sorted(licences)],
        "relationships": [dict(zip(kinds, relation)) for relation in sorted(relationships)]}, indent=1) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 3 or not re.search(r"\.(changes|whl)$", sys.argv[2]) or not os.path.isfile(sys.argv[2]):
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    with tempfile.TemporaryDirectory() as temporary:
        main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(temporary))
