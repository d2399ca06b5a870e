# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The first minutes of docs/hil.md as a reader goes through them: its commands, with the delays of a human."""

import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from stickslip_sim.recording import open_bag
from tests.support.node_processes import executable
from tests.support.repository import ROOT
from tests.support.ros_nodes import client
from tests.support.tool import Capture, answered, restore_interrupt
from tests.support.waiting import DEADLINE

pytestmark = [pytest.mark.ros, pytest.mark.slow]

PAGE = ROOT / 'docs' / 'hil.md'
HUMAN = 3.0      # s from the start of the axis to that of the controller: beyond the window of any limits from 0 on
CHECKED = 2.0     # s, in examples/controller_limits.yaml
AT_MOST = r'(\[WARN\].*: waiting for an axis: .*\n)?'   # said by a controller that a busy machine lets wait for 2 s


def commands() -> list[list[str]]:
    """Return the commands of the five minutes, without those that set the shell up."""
    text = PAGE.read_text(encoding='utf-8').partition('## Wired in five minutes')[2].partition('\n## ')[0]
    lines = [line for block in re.findall(r'```sh\n(.*?)```', text, re.DOTALL) for line in block.splitlines()]
    return [shlex.split(line) for line in lines if not line.startswith('source ')]


AXIS, CONTROLLER, CHECK, STEPPED_AXIS, STEPPER = commands()


def as_here(command: list[str], folder: Path) -> list[str]:
    """Return a command of the page for this machine: with programs and examples where they are, and no globs."""
    program, *words = command
    here = [executable('sim_node') if program.endswith('sim_node') else program.replace('python3', sys.executable)]
    for word in words:
        if '*' in word:
            here += map(str, folder.glob(word))
        else:
            here.append(str(ROOT / word) if word.startswith('examples/') else word)
    return here


@contextmanager
def started(command: list[str], folder: Path) -> Iterator['subprocess.Popen[str]']:
    process = subprocess.Popen(as_here(command, folder), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True, preexec_fn=restore_interrupt)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def interrupt(process: 'subprocess.Popen[str]') -> str:
    """End a program as Ctrl-C does; return what it said."""
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, errors
    return errors


def done(command: list[str], folder: Path) -> 'subprocess.CompletedProcess[str]':
    return subprocess.run(as_here(command, folder), cwd=folder, capture_output=True, text=True, timeout=DEADLINE,
                          check=False)


def of_the_tool(capsys: Capture, command: list[str], folder: Path) -> tuple[int, str, str]:
    """Give a command to the tool in this process; return its exit code, standard output and standard error."""
    program, *words = as_here(command, folder)
    assert program == 'stickslip'
    return answered(capsys, *words)


def test_the_run_is_not_taken_for_that_of_make_run() -> None:
    """A reader has that one in the same folder already."""
    from stickslip_sim.ros.demo import DEMO_SCENE
    assert CHECK[2].startswith('runs/')
    assert not CHECK[2].startswith(f'runs/{DEMO_SCENE}_')


def test_a_controller_that_is_started_by_hand_is_checked(tmp_path: Path, capsys: Capture) -> None:
    with started(AXIS, tmp_path) as axis, client() as listener:
        listener.next('slider_state', lambda state: state.time > HUMAN)
        assert listener.latest('slider_state').drive_velocity == 0.0    # it rests until the first command
        with started(CONTROLLER, tmp_path) as controller:
            first = listener.next('slider_state', lambda state: state.drive_velocity != 0.0).time
            listener.next('slider_state', lambda state: state.time > first + CHECKED + 0.1)
            assert re.fullmatch(AT_MOST, interrupt(controller))
        said = interrupt(axis)
    code, out, errors = of_the_tool(capsys, CHECK, tmp_path)
    assert code == 3, errors
    head, verdict, *_, last = out.splitlines()
    assert float(head.rpartition('first command at t = ')[2].removesuffix(' s')) > HUMAN
    assert verdict.startswith('real-time valid: ')
    assert verdict in said
    assert re.match(r'FAILED: \d of 5: .*overshoot.*sticks', last)
    assert 'no controller was checked' not in out
    code, _, errors = of_the_tool(capsys, [*CHECK[:-1], 'examples/limits.yaml'], tmp_path)    # it ends before
    assert (code, 'no controller was checked' in errors) == (3, True)


def test_lock_step_gives_the_same_recorded_run_each_time(tmp_path: Path, capsys: Capture) -> None:
    with started(STEPPED_AXIS, tmp_path) as axis:
        whole_run = done(STEPPER, tmp_path)
        assert whole_run.returncode == 0, whole_run
        for words in ('record off', 'reset', 'record'):
            code, _, errors = of_the_tool(capsys, ['stickslip', 'call', *words.split()], tmp_path)
            assert code == 0, errors
        part_of_it = done([*STEPPER, '--duration', '0.2'], tmp_path)
        assert part_of_it.returncode == 0, part_of_it
        interrupt(axis)
    first, second = sorted((tmp_path / 'runs').iterdir())
    whole, part = (open_bag(run).columns('/slider_state')['position'].tolist() for run in (first, second))
    assert part == whole[:201]
    assert of_the_tool(capsys, ['stickslip', 'verify', str(first)], tmp_path)[0] == 0
    code, out, errors = of_the_tool(capsys, [*CHECK[:2], str(first), *CHECK[3:]], tmp_path)
    assert code == 3, errors
    head, verdict, *_ = out.splitlines()
    assert '0 to 2 s, 2001 states' in head
    assert head.endswith('first command at t = 0 s')
    assert verdict.startswith('not in real time (time.mode lockstep); commands: 400 received, 0 refused')
