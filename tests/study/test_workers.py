# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The processes that work on a study: they die, their parent dies, and what they start from."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from stickslip_sim.study.workers import processes

pytestmark = pytest.mark.slow

DYING = """
from signal import SIGKILL, raise_signal
from stickslip_sim.study.workers import WorkerError, processes

ended = 0
for _ in range(5):
    try:
        with processes(2) as workers:
            works = [workers.pool.submit(abs, -1), *(workers.pool.submit(raise_signal, SIGKILL) for _ in range(4))]
            for one in works:
                one.result()
    except WorkerError:
        ended += 1
print(ended)
"""
WITHOUT_A_GUARD = """
from stickslip_sim.study.workers import processes

with processes(2) as workers:
    print(*workers.pool.map(abs, [-1, -2, -3]))
"""


def answer(program: str, folder: Path, **environment: str) -> str:
    """Return what a script prints, and nothing but that."""
    script = folder / 'script.py'
    script.write_text(program)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120, check=False,
                          env={**os.environ, **environment})
    assert (done.returncode, done.stderr) == (0, '')
    return done.stdout


def test_workers_that_die_raise_one_error_and_say_nothing(tmp_path: Path) -> None:
    assert answer(DYING, tmp_path) == '5\n'


def test_a_script_needs_no_guard_against_being_read_by_its_workers(tmp_path: Path) -> None:
    assert answer(WITHOUT_A_GUARD, tmp_path) == '1 2 3\n'


def test_what_a_worker_raises_is_raised_here() -> None:
    with processes(1) as workers:
        with pytest.raises(ZeroDivisionError) as raised:
            workers.pool.submit(divmod, 1, 0).result()
        assert 'in _answer' in str(raised.value.__cause__)
        with pytest.raises(TypeError, match='pickle'):
            workers.pool.submit(iter, memoryview(b'')).result()
        assert workers.pool.submit(os.getpid).result() != os.getpid()


def test_work_under_way_is_given_up_at_the_end() -> None:
    children = Path('/proc/thread-self/children')
    before = children.read_text().split()
    with processes(2) as workers:
        works = [workers.pool.submit(signal.pause) for _ in range(2)]
        begun = [pid for pid in children.read_text().split() if pid not in before]
    assert len(begun) == 2
    assert not [pid for pid in begun if Path(f'/proc/{pid}').exists()]
    assert all(one.done() for one in works)
