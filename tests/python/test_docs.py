# SPDX-License-Identifier: Apache-2.0
"""What docs/python.md shows runs, in its order."""

import os
import re
import subprocess
import sys

from conftest import ROOT


def test_the_manual_runs():
    text = (ROOT / "docs" / "python.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 4
    done = subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=ROOT, env=os.environ,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "FrameStatus.bad_depth" in done.stdout and "% behind gripper" in done.stdout
