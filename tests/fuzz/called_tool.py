# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tool, called as from a command line."""

import os
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from unittest import mock

from stickslip_sim.cli.main import run


def call_tool(*arguments: str) -> None:
    """Call the tool, which does what it is asked to or refuses in one line; what it would call internal is raised."""
    said = StringIO()
    with mock.patch.dict(os.environ, STICKSLIP_DEBUG='1'), redirect_stdout(StringIO()), redirect_stderr(said):
        code = run(arguments)
    assert code == 0 or said.getvalue().count('\n') == 1, (code, said.getvalue())
