# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify` in this process."""

from pathlib import Path

import pytest

from stickslip_sim.cli.main import run

Capture = pytest.CaptureFixture[str]


def verified(capsys: Capture, *arguments: str | Path) -> tuple[int, str, str]:
    """Return the exit code, standard output and standard error of the tool."""
    capsys.readouterr()
    code = run(['verify', *map(str, arguments)])
    out, err = capsys.readouterr()
    assert err.count('\n') == (code != 0)
    return code, out, err


def refused(capsys: Capture, *arguments: str | Path) -> str:
    code, out, err = verified(capsys, *arguments)
    assert (code, out) == (2, '')
    return err
