# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The suite ends, and names what failed, when a test stands still or a process of its own dies."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.repository import ROOT

CONFTEST = 'from tests.conftest import pytest_xdist_make_scheduler'
DONE = 'def test_done():\n    pass\n\n'
LAST = '\n\ndef test_last():\n    pass\n'
STANDING_STILL = {
    'in Python': 'import threading\n\ndef test_it():\n    threading.Event().wait()\n',
    'in code that keeps the interpreter': 'import ctypes\n\ndef test_it():\n    ctypes.PyDLL(None).pause()\n',
}
KILLED = 'import os\nimport signal\n\ndef test_it():\n    os.kill(os.getpid(), signal.SIGKILL)\n'


def ended(folder: Path, test: str) -> tuple[int, str]:
    """Run a file with a test, with one before it and one after, beside ten others, as `make test` does; return how."""
    (folder / 'conftest.py').write_text(CONFTEST)
    (folder / 'test_a.py').write_text(DONE + test + LAST)
    for number in range(10):
        (folder / f'test_b{number}.py').write_text(DONE)
    command = [sys.executable, '-m', 'pytest', '-c', str(ROOT / 'pyproject.toml'), '--rootdir', str(folder),
               str(folder), '-p', 'no:cacheprovider', '--dist', 'loadfile', '--no-loadscope-reorder', '--tx', '2*popen',
               '-o', 'faulthandler_timeout=1']
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120,
                          check=False, env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(ROOT), *sys.path])})
    return done.returncode, done.stdout


@pytest.mark.parametrize('test', STANDING_STILL.values(), ids=STANDING_STILL)
def test_a_test_that_stands_still_ends_with_its_stack(test: str, tmp_path: Path) -> None:
    code, output = ended(tmp_path, test)
    assert code == 1, output
    assert ' in test_it\n' in output
    assert "crashed while running 'test_a.py::test_it'" in output
    assert '1 failed, 12 passed' in output


def test_a_process_that_dies_takes_one_test_with_it(tmp_path: Path) -> None:
    code, output = ended(tmp_path, KILLED)
    assert code == 1, output
    assert "crashed while running 'test_a.py::test_it'" in output
    assert '1 failed, 12 passed' in output
