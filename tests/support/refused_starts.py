# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that are to end at once, in processes forked from one that has imported what they need: ten times as fast.

What is left out is the start of the interpreter; the programs that run do it, see `node_processes`.
"""

import multiprocessing
import os
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tests.support.waiting import DEADLINE

pytest.importorskip('rclpy')

_ROOM = 'stickslip_sim.ros'
_FORKS = multiprocessing.get_context('forkserver')
_FORKS.set_forkserver_preload([
    'pytest', __name__, *(f'{_ROOM}.{name}' for name in (
        'sim_node', 'cascade_controller', 'compensating_controller', 'replay_node', 'health', 'process.program',
        'node.feed_axis', 'controllers.controller_node', 'replay.replay_node', 'diagnostics.health_node'))])


def ended_at_once(program: str, *arguments: str | Path) -> tuple[int, str]:
    """Return the exit code of a program of `stickslip_sim.ros` and what it wrote on standard error."""
    with TemporaryDirectory() as folder:
        errors = Path(folder, 'errors')
        process = _FORKS.Process(target=_run, args=(program, [*map(str, arguments)], errors, dict(os.environ)))
        process.start()
        process.join(DEADLINE)
        process.kill()    # one that goes on
        process.join()
        assert process.exitcode is not None
        return process.exitcode, errors.read_text(encoding='utf-8')


def _run(program: str, arguments: list[str], errors: Path, environment: dict[str, str]) -> None:
    os.environ.clear()
    os.environ.update(environment)
    with errors.open('wb') as file:
        os.dup2(file.fileno(), 2)
    sys.stderr = os.fdopen(2, 'w', buffering=1, encoding='utf-8', closefd=False)
    sys.exit(import_module(f'{_ROOM}.{program}').main(arguments))
