#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes man pages and completions for bash and zsh from what `penumbra --help` prints.

command_pages.py FOLDER [EMULATOR...] PROGRAM writes man/man1/*.1,
bash-completion/completions/penumbra and zsh/site-functions/_penumbra below FOLDER.
"""

import pathlib
import re
import subprocess
import sys
from typing import NamedTuple


class Option(NamedTuple):
    names: list[str]
    value: str  # what follows the names: OUT REQUIRED
    description: str


class Help(NamedTuple):
    """The help of the program or of one of its commands."""

    about: str
    usage: str
    groups: dict[str, list[Option]]  # options by their heading
    notes: str


def read_help(program: list[str], *command: str) -> Help:
    text = subprocess.run([*program, *command, "--help"], check=True, capture_output=True, text=True)
    lines = text.stdout.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    about = " ".join(lines[:at]).strip()
    usage = lines[at].removeprefix("Usage: ")
    groups: dict[str, list[Option]] = {}
    at += 1
    while at < len(lines):
        heading = re.fullmatch(r"([A-Z][a-z]+( [a-z]+)?):", lines[at])
        if heading and heading[1] != "Examples":
            options = groups.setdefault(heading[1], [])
        elif entry := re.fullmatch(r"  (\S+)((?: \S+)*)(?:  +(\S.*))?", lines[at]):
            options.append(Option(entry[1].split(","), entry[2].strip(), entry[3] or ""))
        elif lines[at].startswith("   "):
            options[-1] = options[-1]._replace(
                description=f"{options[-1].description} {lines[at].strip()}".strip())
        elif lines[at]:
            break  # the text after the options
        at += 1
    return Help(about, usage, groups, "\n".join(lines[at:]).strip())


def roff(text: str) -> str:
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", "\\e").replace("-", "\\-"), flags=re.M)


def man_page(name: str, version: str, page: Help) -> str:
    parts = [f'.TH {name.upper()} 1 "" "{version}" "User Commands"', ".SH NAME",
             f"{roff(name)} \\- {roff(page.about)}", ".SH SYNOPSIS", f".B {roff(page.usage)}"]
    for heading, options in page.groups.items():
        parts.append(f".SH {heading.upper()}")
        for option in options:
            names = roff(", ".join(option.names))
            parts += [".TP", f"\\fB{names}\\fR {roff(option.value)}".rstrip(),
                      roff(option.description)]
    parts += [".SH NOTES", ".nf", roff(page.notes), ".fi", ""]
    return "\n".join(parts)


def options_of(page: Help) -> list[Option]:
    return [option for options in page.groups.values() for option in options
            if option.names[0].startswith("-")]


def bash(top: Help, commands: dict[str, Help]) -> str:
    def words(page: Help) -> str:
        return " ".join(name for option in options_of(page) for name in option.names)

    cases = "".join(f"    {name}) words='{words(page)}' ;;\n" for name, page in commands.items())
    return f"""# Completion of penumbra for bash.
_penumbra() {{
  local words='{' '.join(commands)} {words(top)}'
  COMPREPLY=()
  ((COMP_CWORD == 1)) || case ${{COMP_WORDS[1]}} in
{cases}    *) return ;;
  esac
  [[ $COMP_CWORD == 1 || $2 == -* ]] && COMPREPLY=($(compgen -W "$words" -- "$2"))
}}
complete -o default -F _penumbra penumbra
"""


def zsh(top: Help, commands: dict[str, Help]) -> str:
    def quoted(text: str) -> str:
        return "'" + text.replace("'", "'\\''") + "'"

    def arguments(page: Help) -> str:
        specs = []
        for option in options_of(page):
            value = option.value.replace("REQUIRED", "").split(" ")[0].replace(":", "\\:")
            text = re.sub(r"([\[\]\\])", r"\\\1", option.description)
            for name in option.names:
                specs.append(quoted(f"*{name}[{text}]" + (f":{value}:_files" if value else "")))
        return " \\\n      ".join([*specs, "'*:file:_files'"])

    described = "\n    ".join(quoted(f"{name}:{page.about}") for name, page in commands.items())
    cases = "".join(f"    {name}) _arguments {arguments(page)} ;;\n"
                    for name, page in commands.items())
    return f"""#compdef penumbra
_penumbra() {{
  local -a commands=(
    {described})
  if ((CURRENT == 2)); then
    _describe command commands
    _arguments {arguments(top)}
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{cases}  esac
}}
_penumbra "$@"
"""


def main() -> None:
    folder, program = pathlib.Path(sys.argv[1]), sys.argv[2:]
    version = subprocess.run([*program, "--version"], check=True, capture_output=True, text=True)
    top = read_help(program)
    commands = {option.names[0]: read_help(program, option.names[0])
                for option in top.groups["Subcommands"]}
    files = {"bash-completion/completions/penumbra": bash(top, commands),
             "zsh/site-functions/_penumbra": zsh(top, commands)}
    pages = {"penumbra": top, **{f"penumbra-{name}": page for name, page in commands.items()}}
    for name, page in pages.items():
        files[f"man/man1/{name}.1"] = man_page(name, version.stdout.strip(), page)
    for file, text in files.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text)


if __name__ == "__main__":
    main()
