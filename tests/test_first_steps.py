# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What README has a newcomer do first: `make run`, and examples/drive.py from a second terminal."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from stickslip_sim.recording import read_run
from tests.ros_nodes import Client, client, running
from tests.waiting import wait_for

pytestmark = pytest.mark.ros

DRIVE = Path(__file__).parents[1] / 'examples' / 'drive.py'


def python(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *map(str, arguments)], capture_output=True, text=True, timeout=60,
                          check=False)


@pytest.fixture(scope='module')
def axis(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    with running(folder=tmp_path_factory.mktemp('axis')), client() as it:
        it.connect()
        yield it


def test_the_demonstration_records_and_has_nothing_to_complain_of(tmp_path: Path) -> None:
    done = python('-m', 'stickslip_sim.ros.demo', '--duration', '1', '--out', tmp_path)
    assert (done.returncode, done.stderr) == (0, '')
    [folder] = tmp_path.iterdir()
    assert (folder / 'run.png').stat().st_size > 10_000
    assert read_run(folder).receipt is not None    # it was closed


def test_what_is_sent_holds(axis: Client) -> None:
    done = python(DRIVE, '0.005', '--force', '400')
    assert done.returncode == 0, done.stderr
    wait_for(lambda: axis.latest('slider_state').drive_velocity == 0.005, 'its effect')


def test_a_wrong_unit_is_told_to_the_sender(axis: Client) -> None:
    before = axis.latest('slider_state').drive_velocity
    wait_for(lambda: 'velocity = 5.0 is refused' in python(DRIVE, '5').stderr, 'a refusal that is heard in its second')
    assert axis.latest('slider_state').drive_velocity == before


def test_nothing_to_send_is_wrong_use() -> None:
    done = python(DRIVE)
    assert done.returncode == 2
    assert 'give a velocity in m/s' in done.stderr
