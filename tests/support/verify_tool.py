# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify` in this process."""

from pathlib import Path

from tests.support import tool
from tests.support.tool import Capture, answered


def verified(capsys: Capture, *arguments: str | Path) -> tuple[int, str, str]:
    """Return the exit code, standard output and standard error of the tool."""
    code, out, err = answered(capsys, 'verify', *arguments)
    assert err.count('\n') == (code != 0)
    return code, out, err


def refused(capsys: Capture, *arguments: str | Path) -> str:
    """Return the one line on standard error."""
    return tool.refused(capsys, 'verify', *arguments)
