# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One name, one thing: no two modules define one public name, and no two files have one, but those listed here.

Classes, functions, constants and aliases count, within a room too.  What is listed stands with all its paths, so that a
reason is looked at again where another comes.
"""

import ast
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

import stickslip_sim

PACKAGE = Path(stickslip_sim.__file__).parent
Names = Mapping[str, tuple[str, ...]]   # and the modules that have them

EXACT, STEPS = 'solvers/exact/__init__.py', 'solvers/fixed_step/__init__.py'
ENGINE, LOOP = 'solvers/exact/engine.py', 'solvers/fixed_step/loop.py'

SAME_NAMES: Mapping[str, Names] = {
    'the same thing, written again by the reference, which may import no numerics of it': {
        'Event': ('core/types.py', 'reference/exact_run.py'),
        'Input': ('core/input_profile.py', 'reference/inputs.py'),
        'Mode': ('core/types.py', 'reference/modes.py'),
        'Run': ('runs/run.py', 'reference/exact_run.py'),
        'Sample': ('core/types.py', 'reference/exact_run.py'),
        'Segment': ('axis/layout.py', 'reference/inputs.py'),
        'State': ('axis/state_record.py', 'reference/flow.py'),
        'StaticLaw': ('friction/static.py', 'reference/statics.py'),
    },
    'what type checkers take for true, where `typing` is not to be imported': {
        'TYPE_CHECKING': ('__init__.py', 'ros/process/stop_signals.py'),
    },
    'the same thing, written again for the rivals of the race, which Numba compiles': {
        'ACCELERATING': ('axis/codes.py', 'bench/peers/automaton.py'),
        'ARREST': ('axis/codes.py', 'bench/peers/resets.py'),
        'BREAKAWAY': ('axis/codes.py', 'bench/peers/resets.py'),
        'COASTING': ('axis/codes.py', 'bench/peers/automaton.py'),
        'DECELERATING': ('axis/codes.py', 'bench/peers/automaton.py'),
        'KNOT': ('axis/codes.py', 'bench/peers/resets.py'),
        'REVERSE': ('axis/codes.py', 'bench/peers/resets.py'),
        'STICK': ('axis/codes.py', 'bench/peers/automaton.py'),
        'TURN': ('linear/waves.py', 'bench/peers/automaton.py'),
        'choose_slip': ('axis/mode_entry.py', 'bench/peers/resets.py'),
        'static_coefficient': ('friction/static.py', 'bench/peers/automaton.py'),
    },
    'the same thing, written again by the reference and for the rivals': {
        'ACCELERATE': ('axis/codes.py', 'bench/peers/resets.py', 'reference/modes.py'),
        'COAST': ('axis/codes.py', 'bench/peers/resets.py', 'reference/modes.py'),
        'DECELERATE': ('axis/codes.py', 'bench/peers/resets.py', 'reference/modes.py'),
    },
    'what is to be solved: by the contestants of a race; by the reference': {
        'Problem': ('bench/problem.py', 'reference/problem.py'),
    },
    'the numbers that a parameter may have; its place in the record of the axis': {
        'CONTACT_STIFFNESS': ('core/ranges.py', 'axis/layout.py'),
        'DAMPING': ('core/ranges.py', 'axis/layout.py'),
        'MASS': ('core/ranges.py', 'axis/layout.py'),
        'STIFFNESS': ('core/ranges.py', 'axis/layout.py'),
    },
    'the numbers that a time may have; its place in the state of a rival': {
        'TIME': ('core/ranges.py', 'bench/peers/automaton.py'),
    },
    'the place of a mark in the record of the axis; a contact that has it': {
        'COMPLIANT': ('axis/layout.py', 'extremes/shared_axes.py'),
    },
    'what each solver has; that of the exact one and of the fixed steps, compiled or not': {
        'METHODS': (STEPS, 'solvers/adaptive/__init__.py'),
        'advance': (EXACT, ENGINE, STEPS, LOOP),
        'energy': (EXACT, ENGINE),
        'is_sound': (EXACT, 'solvers/exact/soundness.py'),
        'run_axes': (EXACT, 'solvers/exact/many_axes.py'),
        'set_inputs': (EXACT, ENGINE, STEPS, LOOP),
        'set_load': (EXACT, ENGINE, STEPS, LOOP),
        'set_parameters': (EXACT, ENGINE, STEPS, LOOP),
        'solver': (STEPS, 'solvers/adaptive/__init__.py'),
        'walk': (EXACT, 'solvers/walk.py'),
    },
    'what each solver has, and the rivals, too': {
        'start': (EXACT, ENGINE, STEPS, LOOP, 'bench/peers/resets.py'),
    },
    'what each solver has, and the reference, too': {
        'sample': (EXACT, ENGINE, STEPS, LOOP, 'reference/exact_run.py'),
    },
    'what each file of a rival has': {
        'PEER': ('bench/peers/dop853.py', 'bench/peers/euler.py', 'bench/peers/heyoka.py', 'bench/peers/mujoco.py',
                 'bench/peers/sksundae.py', 'bench/peers/sundials.py'),
    },
    'the whole of it: of the tool; of the reference; of a rival': {
        'run': ('cli/main.py', 'reference/automaton.py', 'bench/peers/dop853.py', 'bench/peers/euler.py'),
    },
    'what an executable starts': {
        'main': ('cli/main.py', 'ros/cascade_controller.py', 'ros/compensating_controller.py', 'ros/demo.py',
                 'ros/health.py', 'ros/replay_node.py', 'ros/sim_node.py'),
        'PROGRAM': ('ros/diagnostics/health_program.py', 'ros/node/axis_program.py', 'ros/replay/replay_program.py'),
    },
    'the command of that name, and the work that it does': {
        'advise': ('cli/advise.py', 'advise/advice.py'),
        'critical': ('cli/critical.py', 'study/in_memory.py'),
        'identify': ('cli/identify.py', 'identification/identify.py'),
        'sweep': ('cli/sweep.py', 'study/in_memory.py'),
        'uncertainty': ('cli/uncertainty.py', 'study/in_memory.py'),
        'verify': ('cli/verify.py', 'verify/verification.py'),
    },
    'the command of that name, the work on a scene and on one by its name, and the reference': {
        'simulate': ('cli/simulate.py', 'runs/simulated.py', 'inputs/scene_runs.py', 'reference/__init__.py'),
    },
    'the work on a scene, and on one by its name': {
        'simulate_events': ('runs/simulated.py', 'inputs/scene_runs.py'),
    },
}

SAME_FILES: Mapping[str, Names] = {
    'the command of that name, and the work that it does': {
        'critical.py': ('cli/critical.py', 'study/critical.py'),
        'identify.py': ('cli/identify.py', 'identification/identify.py'),
        'sweep.py': ('cli/sweep.py', 'study/sweep.py'),
    },
    'the numbers, and the picture of them': {
        'bifurcation.py': ('study/bifurcation.py', 'plots/bifurcation.py'),
        'characteristics.py': ('compare/characteristics.py', 'plots/characteristics.py'),
        'known_friction.py': ('identification/report/known_friction.py', 'plots/known_friction.py'),
        'what_if.py': ('verify/what_if.py', 'plots/what_if.py'),
    },
    'the command of that name, the numbers, and the picture of them': {
        'uncertainty.py': ('cli/uncertainty.py', 'study/uncertainty.py', 'plots/uncertainty.py'),
    },
    'what every run has; its folder; its picture': {
        'run.py': ('runs/run.py', 'recording/run.py', 'plots/run.py'),
    },
    'the same thing, written again by the reference, which may import no numerics of it': {
        'roots.py': ('reference/roots.py', 'linear/roots.py'),
        'search.py': ('reference/search.py', 'solvers/exact/search.py'),
    },
    'the same thing, written again by the reference and for the rivals': {
        'automaton.py': ('reference/automaton.py', 'bench/peers/automaton.py'),
    },
    'what is to be solved: by the contestants of a race; by the reference': {
        'problem.py': ('bench/problem.py', 'reference/problem.py'),
    },
    'the inputs of an axis: as a simulator keeps them; at any time, for solvers that step; as the reference has them': {
        'inputs.py': ('simulation/inputs.py', 'solvers/inputs.py', 'reference/inputs.py'),
    },
    'what goes from event to event, of two solvers': {
        'engine.py': ('solvers/exact/engine.py', 'solvers/adaptive/engine.py'),
    },
    'the command of that name; the section of a scene': {
        'friction.py': ('cli/friction.py', 'scene/friction.py'),
    },
    'the numbers of the axis; the parameters of the node, as ROS has them': {
        'parameters.py': ('axis/parameters.py', 'ros/node/parameters.py'),
    },
    'all pictures of a room': {
        'pictures.py': ('compare/pictures.py', 'study/pictures.py'),
    },
}


def definitions() -> Iterator[tuple[str, str]]:
    """Yield each public name that a module defines at its top, and the module."""
    for path in sorted(PACKAGE.rglob('*.py')):
        for node in ast.parse(path.read_text(encoding='utf-8')).body:
            for name in names_of(node):
                if not name.startswith('_'):
                    yield name, path.relative_to(PACKAGE).as_posix()


def names_of(node: ast.stmt) -> Iterator[str]:
    if isinstance(node, ast.ClassDef | ast.FunctionDef):
        yield node.name
    elif isinstance(node, ast.Assign | ast.AnnAssign):
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
            yield from (each.id for each in ast.walk(target) if isinstance(each, ast.Name))


def files() -> Iterator[tuple[str, str]]:
    """Yield the name of each file, and its path; a folder goes by its own name."""
    return ((path.name, path.relative_to(PACKAGE).as_posix()) for path in PACKAGE.rglob('*.py')
            if not path.name.startswith('_'))


def in_several_modules(named: Iterator[tuple[str, str]]) -> dict[str, set[str]]:
    modules = defaultdict(set)
    for name, module in named:
        modules[name].add(module)
    return {name: found for name, found in modules.items() if len(found) > 1}


@pytest.mark.parametrize(('named', 'listed'), [(definitions, SAME_NAMES), (files, SAME_FILES)])
def test_a_name_stands_for_one_thing(named: Callable[[], Iterator[tuple[str, str]]],
                                     listed: Mapping[str, Names]) -> None:
    """No listed name is gone, or has come to stand elsewhere: the list does not grow old."""
    expected = {name: set(modules) for names in listed.values() for name, modules in names.items()}
    assert in_several_modules(named()) == expected


@pytest.mark.parametrize('text', ['class Two: pass', 'def Two(): pass', 'Two = 2', 'Two: int = 2', 'One, Two = 1, 2',
                                  'Two = dict[str, float]'])
def test_a_name_is_seen_however_it_is_defined(text: str) -> None:
    assert 'Two' in [name for node in ast.parse(text).body for name in names_of(node)]
