# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One name, one thing: no two rooms have a public class, a function or a file of one name, but those listed here."""

import ast
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

import stickslip_sim

PACKAGE = Path(stickslip_sim.__file__).parent

VERB = 'the command of that name, and the work that it does'
PICTURE = 'the numbers, and the picture of them'
JUDGE = 'the same thing, written again by the independent judge, which may import nothing of it'
RIVAL = 'the same thing, written again by a rival of the race'

SAME_NAMES = {
    'Event': JUDGE, 'Sample': JUDGE, 'Segment': JUDGE, 'State': JUDGE, 'StaticLaw': JUDGE,
    'choose_slip': RIVAL, 'static_coefficient': RIVAL, 'start': RIVAL,
    'sample': JUDGE,
    'advise': VERB, 'critical': VERB, 'sweep': VERB,
    'simulate': f'{VERB}, on a scene and on one by its name; the reference has it too',
    'simulate_events': 'the work on a scene, and on one by its name',
    'identify': VERB, 'uncertainty': VERB, 'verify': VERB,
    'main': 'the start of an executable',
    'run': 'the run of the tool; of a rival; of the reference',
    'Run': 'a run, simulated or recorded; the run of the reference',
    'Problem': 'the task of the contestants of a race; that of the reference',
}
SAME_FILES = {
    'critical.py': VERB, 'identify.py': VERB, 'sweep.py': VERB, 'uncertainty.py': f'{VERB}; {PICTURE}',
    'bifurcation.py': PICTURE, 'characteristics.py': PICTURE, 'known_friction.py': PICTURE, 'what_if.py': PICTURE,
    'friction.py': 'the command; friction as faults change it',
    'run.py': f'{PICTURE}: of a run, and its folder',
    'pictures.py': 'all pictures of a room',
    'automaton.py': f'{RIVAL}; {JUDGE}', 'problem.py': 'see `Problem`',
    'inputs.py': JUDGE, 'roots.py': JUDGE, 'search.py': JUDGE,
    'layout.py': 'the numbers of an axis; the bytes of a message',
    'orders.py': 'commands and calls of a recorded run: given to a node, and to a rig',
    'parameters.py': 'the numbers of the axis; the parameters of the node, as ROS has them',
    'records.py': 'the numbers of an axis by name; the records of an MCAP file',
    'rows.py': 'what a solver fills; messages of one size as an array',
    'sections.py': 'of the help of the tool; of a parameter file',
    'steps.py': 'the steps of a fixed-step solver; those of a run that is simulated again',
    'topics.py': 'topics as they are recorded; as the node has them',
}


def definitions() -> Iterator[tuple[str, str]]:
    """Yield each public class and function of a module with its room."""
    for path in sorted(PACKAGE.rglob('*.py')):
        for node in ast.parse(path.read_text(encoding='utf-8')).body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith('_'):
                yield node.name, room_of(path)


def files() -> Iterator[tuple[str, str]]:
    """Yield each file with its room."""
    return ((path.name, room_of(path)) for path in PACKAGE.rglob('*.py') if not path.name.startswith('_'))


def room_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0]


def in_several_rooms(named: Iterator[tuple[str, str]]) -> dict[str, set[str]]:
    rooms = defaultdict(set)
    for name, room in named:
        rooms[name].add(room)
    return {name: found for name, found in rooms.items() if len(found) > 1}


@pytest.mark.parametrize(('named', 'listed'), [(definitions, SAME_NAMES), (files, SAME_FILES)])
def test_a_name_stands_for_one_thing(named: Callable[[], Iterator[tuple[str, str]]],
                                     listed: Mapping[str, str]) -> None:
    """No listed name is gone, either: the list does not grow old."""
    found = in_several_rooms(named())
    assert {name: rooms for name, rooms in found.items() if name not in listed} == {}
    assert set(listed) - set(found) == set()
