# SPDX-License-Identifier: Apache-2.0
"""Tells a robot which parts of its view its own body hides."""

from ._core import *
from ._core import version as __version__
from .recorder import Recorder, from_arrays
