# SPDX-License-Identifier: Apache-2.0
"""Tells a robot which parts of its view its own body hides."""

from ._core import *
from ._core import version as __version__
from .recorder import Recorder, from_arrays

# A star import keeps the builtin open.
__all__ = [name for name in dir() if name[0] != "_" and name not in ("open", "recorder")]
