# SPDX-License-Identifier: Apache-2.0
"""Every command of the documents runs, in their order, and ends with status 0."""

import json
import os
import re
import select
import signal
import subprocess
import sys
import time
import urllib.request

import pytest

from blocks import DOCUMENTS, ROOT, blocks_of, commands_of, inline_code, program_of
from conftest import PROGRAM, in_folder

PATIENCE = 1800  # seconds that a command may take on a busy machine

# What cannot be run here, and why. Scripts of ours must at least be there.
NOT_RUN = {
    r"scripts/(demo|test|deb|wheel|docs|make_example|bench)\.sh": "builds everything: the tests are run by one",
    r"cmake --(preset|build|install)": "builds everything",
    r"ctest --preset": "these tests",
    r"python3 -m (venv|pip)|~/penumbra-python": "a wheel: tests/python/test_stubs.py",
    r"docker ": "needs Docker and its base images",
    r"build/dev/bench/": "a benchmark on real recordings",
    r"cd penumbra$": "after git clone",
    r"ros2 |rviz2 |colcon |rosdep |git clone |ln -s |config=|export (CYCLONE|FASTRTPS)": "ROS 2's own: scripts/test_ros.sh",
    r"python3 -m penumbra\.batch": "tests/python/test_batch.py",
    r"python3 -m penumbra\.datasets": "tests/python/test_datasets.py",
    r"penumbra_research |export PATH=|scripts/experiment_tables": "minutes: tests/research",
    r"sudo ": "the machine's settings and packages",
    r"echo net\.core": "the machine's settings",
}

# Documents whose commands read what their programs write.
PROGRAMS_FIRST = ("python.md",)


def run(words, work, environment):
    done = subprocess.run(words, cwd=work, env=environment, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 0, f"{' '.join(words)}\n{done.stdout}{done.stderr}"
    return done.stdout


def let_run(words, work, environment):
    """A command that goes on until Ctrl-C, once it has said something."""
    process = subprocess.Popen(words, cwd=work, env=environment, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    said = process.stdout.readline()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=PATIENCE)
    assert said and process.returncode == 0, said + rest


def look_at(words, work, environment):
    """A command that serves a page, which is fetched, and its first answer."""
    if "--port" in words:
        at = words.index("--port")
        words = [*words[:at], *words[at + 2:]]
    process = subprocess.Popen([*words, "--port", "0"], cwd=work, env=environment,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        until, address = time.monotonic() + PATIENCE, None
        while address is None and time.monotonic() < until and process.poll() is None:
            if select.select([process.stdout], [], [], 0.1)[0]:
                address = re.search(r"http://\S+", process.stdout.readline())
        assert address, process.communicate(timeout=1)[1]
        page = urllib.request.urlopen(address[0], timeout=PATIENCE).read().decode()
        assert "<html" in page
        session = urllib.request.urlopen(address[0].split("?")[0] + "api/session", timeout=PATIENCE)
        assert json.load(session)["mode"] in ("stored", "live")
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=PATIENCE)
        assert process.returncode == 0, told
    finally:
        if process.poll() is None:
            process.kill()


def run_penumbra(words, work, environment):
    if words[1] == "view" or "--port" in words:
        look_at(words, work, environment)
    elif words[1] == "live" or "--loop" in words:
        let_run(words, work, environment)
    else:
        run(words, work, environment)


def shell_blocks(document):
    return [block for block in blocks_of(document) if block.language in ("", "sh")]


@pytest.mark.parametrize("document", [d for d in DOCUMENTS if shell_blocks(d)],
                         ids=lambda d: str(d.relative_to(ROOT)))
def test_commands_run(document, work, environment):
    if document.name in PROGRAMS_FIRST:
        run([sys.executable, "-c", program_of(document)], work, environment)
    for block in shell_blocks(document):
        for command in commands_of(block):
            words = [in_folder(word, work) for word in command.words]
            place = f"{block.document}:{command.line}: {command.text}"
            print(place)
            if words[0] == "scripts/packages.sh":  # that its groups are there
                run([ROOT / words[0], *[w for w in words[1:] if w != "--install"]], work, environment)
            elif words[0] != "penumbra":
                assert any(re.match(pattern, command.text) for pattern in NOT_RUN), f"{place}: how to test this?"
                if words[0].startswith("scripts/"):
                    assert (ROOT / words[0]).is_file(), place
            elif words[1] == "simulate" and not (os.environ.get("PENUMBRA_FULL") and
                                                 "simulation" in os.environ.get("PENUMBRA_REQUIRE", "")):
                continue  # it takes minutes, and a build may be without it
            else:
                run_penumbra(words, work, environment)


def options_of_commands():
    told = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    commands = re.findall(r"^  (\w[\w-]*)  ", told, re.MULTILINE)
    assert {"run", "live", "view", "doctor"} <= set(commands)
    return {name: set(re.findall(r"--[a-z][a-z-]*", subprocess.run(
        [PROGRAM, name, "--help"], capture_output=True, text=True, check=True).stdout))
        for name in commands}


def test_options_in_the_text_are_the_programs():
    known = options_of_commands()
    anywhere = set().union(*known.values())
    wrong = []
    for document, code in inline_code():
        words = code.split()
        options = {word for word in words if re.fullmatch(r"--[a-z][a-z-]*", word)}
        of_command = anywhere
        if words[:1] == ["penumbra"] and len(words) > 1 and re.fullmatch(r"[a-z]+", words[1]):
            assert words[1] in known, f"{document}: `{code}`"
            of_command = known[words[1]]
        elif words[0].startswith("scripts/"):
            of_command = set(re.findall(r"--[a-z-]+", (ROOT / words[0]).read_text()))
        elif not words[0].startswith("--"):
            continue  # another program's
        wrong += [f"{document}: `{code}`: {option}" for option in sorted(options - of_command)]
    assert not wrong, "\n".join(wrong)
