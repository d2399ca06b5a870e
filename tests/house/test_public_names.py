# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`import stickslip_sim`: the names for users, that they cost nothing until they are used, and the map of the rooms."""

import re
from itertools import chain
from pathlib import Path

import pytest

import stickslip_sim
from stickslip_sim import identification
from tests.conftest import Program
from tests.support.floors import floors

NAMES = [
    'Cycle', 'Event', 'EventKind', 'InputError', 'Instant', 'Mode', 'RecordingError', 'RecordingWarning', 'Run',
    'Sample', 'Scene', 'Sensitivities', 'Simulator', 'SolverError', 'StickslipError', 'Summary', 'UnsoundError',
    'VerdictError', '__version__', 'critical', 'error_estimate', 'identify', 'load_scene', 'read_run',
    'run_batch', 'scene_names', 'sensitivities', 'simulate', 'simulate_events', 'sweep', 'uncertainty']
ROOM = re.compile(r'^ {4}(\w+) {2,}\S', re.MULTILINE)   # a line of the map


def test_the_names_are_those_of_this_list() -> None:
    assert sorted(stickslip_sim.__all__) == NAMES
    assert dir(stickslip_sim) == NAMES
    for name in NAMES:
        assert getattr(stickslip_sim, name).__doc__, name


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(AttributeError, match="module 'stickslip_sim' has no attribute 'simulat'"):
        getattr(stickslip_sim, 'simulat')  # noqa: B009


def test_the_map_has_the_rooms_in_the_order_of_the_floors() -> None:
    rooms = ROOM.findall(stickslip_sim.__doc__ or '')
    package = Path(stickslip_sim.__file__).parent
    assert ['__main__', *rooms] == [*chain(*floors('stickslip_sim'))]
    assert sorted(rooms) == sorted(path.parent.name for path in package.glob('*/__init__.py'))


def test_the_map_of_identification_has_its_floors() -> None:
    """What is not on it, import-linter finds: its list is exhaustive."""
    assert ROOM.findall(identification.__doc__ or '') == [*chain(*floors('stickslip_sim.identification'))]


def test_importing_costs_nothing(in_a_process: Program) -> None:
    """No other room of the package, and none of the libraries that they need."""
    program = '''
import sys
before = set(sys.modules)
import stickslip_sim
print(*sorted(name for name in set(sys.modules) - before if name.partition('.')[0] not in sys.stdlib_module_names))
'''
    assert in_a_process(program, compiled=False).split() == [
        'stickslip_sim', 'stickslip_sim.core', 'stickslip_sim.core.version']


def test_a_simulation_needs_neither_pictures_nor_ros(in_a_process: Program) -> None:
    program = '''
import sys
import stickslip_sim as stickslip
run = stickslip.simulate(stickslip.load_scene('paper_fig7'), 0.1)
print(len(run.samples['time']), *(name in sys.modules for name in ('matplotlib', 'rclpy', 'mcap', 'pandas', 'click')))
'''
    assert in_a_process(program, compiled=False).split() == ['101', *['False'] * 5]
