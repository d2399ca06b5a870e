# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The suite ends, and names what failed, when a test stands still or a process of its own dies."""

import os
import subprocess
import sys
from pathlib import Path

from tests.support.repository import ROOT

CONFTEST = 'from tests.conftest import pytest_xdist_make_scheduler'
DONE = 'def test_done():\n    pass\n\n'
LAST = '\n\ndef test_last():\n    pass\n'
ENDS = {
    'waits': 'import threading\n\ndef test_it():\n    threading.Event().wait()\n',
    'keeps_the_interpreter': 'import ctypes\n\ndef test_it():\n    ctypes.PyDLL(None).pause()\n',
    'is_killed': 'import os\nimport signal\n\ndef test_it():\n    os.kill(os.getpid(), signal.SIGKILL)\n',
}


def test_a_test_that_stands_still_or_kills_its_process_takes_no_other_with_it(tmp_path: Path) -> None:
    """Each has a test before it and one after in its file, beside ten files, as `make test` runs them."""
    (tmp_path / 'conftest.py').write_text(CONFTEST)
    for name, test in ENDS.items():
        (tmp_path / f'test_{name}.py').write_text(DONE + test + LAST)
    for number in range(10):
        (tmp_path / f'test_b{number}.py').write_text(DONE)
    command = [sys.executable, '-m', 'pytest', '-c', str(ROOT / 'pyproject.toml'), '--rootdir', str(tmp_path),
               str(tmp_path), '-p', 'no:cacheprovider', '--dist', 'loadfile', '--no-loadscope-reorder',
               '--tx', '2*popen', '-o', 'faulthandler_timeout=1']
    done = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=120, check=False,
                          env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(ROOT), *sys.path])})
    output = done.stdout
    assert done.returncode == 1, output
    assert output.count(' in test_it\n') >= 2     # the stacks of those that stand still
    for name in ENDS:
        assert f"crashed while running 'test_{name}.py::test_it'" in output
    assert f'{len(ENDS)} failed, {10 + 2 * len(ENDS)} passed' in output
