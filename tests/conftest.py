"""Fixtures that several test files share."""

import os
import subprocess
import sys
from collections.abc import Callable

import pytest


@pytest.fixture(scope='session')
def plain_python() -> Callable[..., str]:
    """Run a program in a process of its own, with compiled code or as plain Python; return what it printed."""

    def run(program: str, *, compiled: bool) -> str:
        environment = {**os.environ, 'STICKSLIP_COMPILED': '1' if compiled else '0',
                       'PYTHONPATH': os.pathsep.join([os.getcwd(), *filter(None, sys.path)])}
        done = subprocess.run([sys.executable, '-c', program], env=environment, capture_output=True, text=True,
                              timeout=300, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
