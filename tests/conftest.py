# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures that several test files share."""

import os
import subprocess
import sys
from typing import Protocol

import pytest


class Program(Protocol):
    """Runs a program in a process of its own, with compiled code or as plain Python; returns what it printed."""

    def __call__(self, program: str, *, compiled: bool) -> str:
        """Run it."""


@pytest.fixture(scope='session')
def in_a_process() -> Program:

    def run(program: str, *, compiled: bool) -> str:
        environment = {**os.environ, 'STICKSLIP_COMPILED': '1' if compiled else '0',
                       'PYTHONPATH': os.pathsep.join([os.getcwd(), *filter(None, sys.path)])}
        done = subprocess.run([sys.executable, '-c', program], env=environment, capture_output=True, text=True,
                              timeout=300, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
