# SPDX-License-Identifier: Apache-2.0
"""Man pages and completions name every command and option of --help, and bash completes with them."""
import pathlib
import re
import shutil
import subprocess
import sys

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])


def help_of(*command):
    text = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True)
    return text.stdout


def completed(*words):
    script = (f"source {folder}/bash-completion/completions/penumbra; COMP_WORDS=({' '.join(words)} '')"
              f"; COMP_CWORD={len(words) - 1}; _penumbra penumbra '{words[-1]}' '{words[-2]}'"
              '; echo "${COMPREPLY[*]}"')
    text = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    return text.stdout.split()


commands = re.findall(r"^  ([a-z-]+) {2,}", help_of().split("Subcommands:")[1], re.MULTILINE)
assert "run" in commands and "calibrate" in commands, commands
assert set(commands) <= set(completed("penumbra", "")), completed("penumbra", "")
zsh = (folder / "zsh/site-functions/_penumbra").read_text()
for command in commands:
    page = (folder / f"man/man1/penumbra-{command}.1").read_text().replace("\\-", "-")
    options = set(re.findall(r"^  (?:-\w,)?(--[a-z-]+)", help_of(command), re.MULTILINE))
    assert "--help" in options, command
    assert options <= set(completed("penumbra", command, "--")), command
    for option in options:
        assert option in page and option in zsh, (command, option)
assert completed("penumbra", "run", "--sa") == ["--save"]
assert completed("penumbra", "run", "rec") == [], "files are the shell's to complete"
if shutil.which("zsh"):
    subprocess.run(["zsh", "-n", folder / "zsh/site-functions/_penumbra"], check=True)
