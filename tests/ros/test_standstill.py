# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What ends by itself: a process that stands still in the middleware, and one with a defect of its own."""

import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from rclpy.node import Node

from stickslip_sim.core.errors import RecordingWarning
from stickslip_sim.recording import open_bag, write_bag
from stickslip_sim.ros import standstill
from stickslip_sim.solvers import exact, with_advance
from tests.support.node_processes import NodeProcess, assert_clean, recording_into, running
from tests.support.recorded_runs import FACTS, samples
from tests.support.ros_nodes import client, live_axis
from tests.support.tool import restore_interrupt
from tests.support.waiting import wait_for

pytestmark = pytest.mark.ros

MEMORY = Path('/dev/shm')
PREFIX = 'fastrtps' if os.environ.get('ROS_DISTRO') == 'jazzy' else 'fastdds'
PARTICIPANTS = 10
LISTENER = """
import rclpy
from stickslip_msgs.msg import SliderState
rclpy.init()
node = rclpy.create_node('listener')
node.create_subscription(SliderState, 'slider_state', lambda state: None, 10)
rclpy.spin(node)
"""


def never_destroyed(*_: object) -> None:
    ctypes.PyDLL(None).pause()    # like a lock of Fast DDS: it keeps the interpreter


def impatient() -> None:
    """For `prepare`."""
    restore_interrupt()
    standstill.GRACE = 3.0


IMPATIENT_CALL = """
import sys
from stickslip_sim.cli.main import run
from stickslip_sim.ros import standstill
from stickslip_sim.solvers import exact, with_advance

standstill.GRACE = 3.0
sys.exit(run(['call', 'pause']))
"""


def with_a_middleware_that_does_not_end() -> None:
    """For `prepare`."""
    impatient()
    Node.destroy_node = never_destroyed


def with_nothing_compiled_that_ends_it() -> None:
    """For `prepare`."""
    with_a_middleware_that_does_not_end()
    sys.modules['stickslip_sim._standstill'] = None    # type: ignore[assignment]


@pytest.fixture
def shared_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let programs use it, as ROS 2 does by itself."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    for name in ('FASTRTPS', 'FASTDDS'):
        monkeypatch.delenv(f'{name}_DEFAULT_PROFILES_FILE', raising=False)


def ports() -> dict[int, Path]:
    """Return the files in which programs of this domain hear in shared memory, by the number of the program."""
    base = 7411 + 250 * int(os.environ['ROS_DOMAIN_ID'])
    return {number: MEMORY / f'{PREFIX}_port{base + 2 * number}' for number in range(PARTICIPANTS)}


@pytest.fixture
def half_made() -> Iterator[Callable[[Path], None]]:
    """What makes a port as a program leaves it that is killed when it has made the file and nothing in it."""
    made: list[Path] = []

    def make(port: Path) -> None:
        made.append(port)
        Path(f'{port}_el').unlink(missing_ok=True)    # a lock of one that is gone: Fast DDS would make the port anew
        new = port.with_name(f'new_{port.name}')
        new.touch()
        new.rename(port)

    yield make
    for port in made:
        for path in (port, Path(f'{port}_el'), port.with_name(f'sem.{port.name}_mutex')):
            path.unlink(missing_ok=True)


def open_ports(process: NodeProcess) -> set[Path]:
    """Return those of this domain that a program hears in, or writes into."""
    maps = Path(f'/proc/{process.pid}/maps').read_text()
    return {port for port in ports().values() if f'{port}\n' in maps}


def has_ended(process: NodeProcess) -> bool:
    try:
        return Path(f'/proc/{process.pid}/stat').read_text().rpartition(')')[2].split()[0] == 'Z'
    except OSError:
        return True


@pytest.mark.usefixtures('shared_memory')
class TestWithSharedMemory:
    def test_a_start_ends_with_what_to_remove(self, half_made: Callable[[Path], None]) -> None:
        for port in ports().values():
            half_made(port)
        with running(prepare=impatient) as process:
            code, errors = process.wait()
        line, stacks = errors.split('\n', 1)
        assert code == 2
        assert line.startswith('sim_node: ROS does not come up: a call has not come back for 3 s; ')
        assert f'rm {ports()[0]} ' in f'{line} '
        assert 'feed_axis.py' in stacks

    def test_so_does_a_call(self, half_made: Callable[[Path], None]) -> None:
        for port in ports().values():
            half_made(port)
        done = subprocess.run([sys.executable, '-c', IMPATIENT_CALL], capture_output=True, text=True, timeout=60,
                              check=False)
        assert done.returncode == 2
        assert done.stderr.startswith('stickslip call: ROS does not come up: ')

    def test_a_publish_to_a_program_that_was_killed_ends_the_node_and_keeps_the_bag(
            self, half_made: Callable[[Path], None], tmp_path: Path) -> None:
        bag = tmp_path / 'run'
        with running(*recording_into(bag), prepare=impatient) as node:
            own = wait_for(lambda: open_ports(node), 'the node')
            peer = subprocess.Popen([sys.executable, '-c', LISTENER], preexec_fn=restore_interrupt)
            theirs = wait_for(lambda: open_ports(node) - own, 'states for the listener')
            time.sleep(1.0)    # of the run, of which the bag has all but the last second
            peer.kill()
            peer.wait()
            for port in theirs:
                half_made(port)
            (file,) = bag.glob('*.mcap')
            size, moment = file.stat().st_size, time.monotonic() + 8.0
            wait_for(lambda: has_ended(node) or time.monotonic() > moment, 'its end')
            wait_for(lambda: has_ended(node) or file.stat().st_size > size, 'its end, or more of the bag')
            if not has_ended(node):    # it never opened the port again, as it happens on Kilted
                assert_clean(*node.end())
                return
            code, errors = node.wait()
        assert code == 1
        assert errors.count('sim_node: stands still: a call has not come back for 3 s; ') == 1
        assert 'publish' in errors
        with pytest.warns(RecordingWarning, match='has no end'):
            assert len(open_bag(bag).columns('slider_state')['position']) > 100


def test_without_shared_memory_a_half_made_port_is_nothing(half_made: Callable[[Path], None]) -> None:
    """As `make run` and `make test` have it."""
    for port in ports().values():
        half_made(port)
    with live_axis(prepare=impatient) as (process, _):
        maps = Path(f'/proc/{process.pid}/maps').read_text()
    assert f'{MEMORY}/fast' not in maps


def test_time_in_which_a_node_is_stopped_does_not_count() -> None:
    with live_axis(prepare=impatient) as (process, axis):
        process.send(signal.SIGSTOP)
        time.sleep(3.5)
        process.send(signal.SIGCONT)
        axis.next('slider_state')
        time.sleep(3.5)    # in which it would have ended


@pytest.mark.parametrize(('prepare', 'reported'), [
    (with_a_middleware_that_does_not_end, 'sim_node: stands still: '),
    (with_nothing_compiled_that_ends_it, 'Timeout (0:00:03)!'),
], ids=['compiled', 'plain'])
def test_a_node_ends_whose_middleware_does_not(prepare: Callable[[], None], reported: str, tmp_path: Path) -> None:
    bag = tmp_path / 'run'
    with running(*recording_into(bag), prepare=prepare) as process:
        with client() as axis:
            axis.connect()
        code, errors = process.end()
    assert code == 1
    assert reported in errors
    assert 'in never_destroyed' in errors
    assert open_bag(bag).is_complete


PLACES = {    # a method of stickslip_sim, and the program that calls it in this thread
    'step loop': ('simulation.rig', 'Rig', 'make_step', 'sim_node'),
    'player': ('ros.replay.states', 'States', 'acts', 'replay_node'),
    'executor': ('ros.node.reports', 'PeriodicReport', 'report', 'sim_node'),
}


def broken(*_: object) -> None:
    raise ZeroDivisionError('first\nsecond')


def break_method(module: str, owner: str, method: str) -> None:
    """Let a method raise an error of two lines: for `prepare`, with its arguments."""
    restore_interrupt()
    setattr(getattr(import_module(f'stickslip_sim.{module}'), owner), method, broken)


@pytest.mark.parametrize(('place', 'debug'), [*((place, '0') for place in PLACES), ('executor', '1')])
def test_a_defect_is_reported_and_shown_where(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, debug: str
                                              ) -> None:
    write_bag(tmp_path / 'run', FACTS, samples(3), [], {})
    monkeypatch.setenv('STICKSLIP_DEBUG', debug)
    *method, program = PLACES[place]
    bag = [f'bag:={tmp_path}/run'] if place == 'player' else []
    with running(*bag, program=program, folder=tmp_path, prepare=partial(break_method, *method)) as process:
        code, errors = process.wait()
    *before, line = errors.splitlines()
    assert code == 1
    if debug == '0':
        assert not any('Traceback' in text for text in before)
        assert line == f'{program}: internal error: ZeroDivisionError: first (STICKSLIP_DEBUG=1 shows where)'
    else:
        assert 'Traceback (most recent call last):' in before
        assert any(text.endswith('in broken') for text in before)
        assert [before[-1], line] == ['ZeroDivisionError: first', 'second']


def with_a_run_that_contradicts_itself() -> None:
    """For `prepare`."""
    restore_interrupt()
    done: list[bool] = []

    def corrupted(p: Any, s: Any, second: float, fraction: float, *arguments: Any) -> Any:
        if not done and fraction > 0.005:
            done.append(True)
            s.stored_at_start += 1e3      # J that the run never had
        return exact.advance(p, s, second, fraction, *arguments)

    exact.SOLVER = with_advance(exact.SOLVER, corrupted)    # type: ignore[assignment]


def test_a_run_that_contradicts_itself_stands_still(tmp_path: Path) -> None:
    """The check of runs finds it at the next event; the node says so and waits, and its bag is whole."""
    bag = tmp_path / 'run'
    with running(*recording_into(bag), prepare=with_a_run_that_contradicts_itself) as process, client() as axis:
        axis.status('solver', level=b'\2')
        code, errors = process.end()
    assert code == 0
    assert 'stands still: the run violates its own motion or energy balance at t = ' in errors
    assert open_bag(bag).is_complete
    assert len(list(open_bag(bag).messages(['/slider_state']))) > 5
