# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Exact, event-driven simulation of a feed axis with stick-slip friction.

    import stickslip_sim as stickslip

    run = stickslip.simulate(stickslip.load_scene('paper_fig8'), duration=10.0)
    run.plot('run.png')

All names of `__all__` are imported when they are first used (docs/python.md shows them).  The rooms, from the top
floor down; each imports only from the floors below it:

    cli             the tool `stickslip`, one file a verb; prints what the rooms below find
    ros             the nodes, and the demo of `make run`; the only room that imports ROS
    extremes        what breaks other simulators, measured on this one
    compare         the figures and statements of the paper, on any run
    advise          which solver and which parts of a scene are worth their time
    design          the experiment that would narrow parameters most
    check           a run against limits
    verify          a recorded run again, bit by bit, or as something else had been
    identification  from measured channels, in SI, to a scene: friction curves, and runs that give all parameters
    sensitivity     derivatives of what a run shows with respect to the numbers of its scene
    study           sweeps, maps, critical values, uncertainty
    bench           cost, error and time to start of this solver, and of its rivals, which are in bench/peers
    inputs          what comes from outside: scenes by name or path, profiles and measurements from files, units to SI
    recording       runs as bags: written, read back, played
    runs            a run as one thing, simulated or recorded; its receipt and error; batches of thousands
    realtime        steps that keep the time of a clock, and how well they do
    plots           pictures; the only room that imports matplotlib
    scene           everything that decides a run, from a file
    controllers     the example controllers, without ROS
    rig             what is around the axis: commands, drive limits, faults, encoders
    simulation      one axis through time: simulator, inputs, checkpoint, cycles
    solvers         from event to event: exact, adaptive and fixed steps
    reference       an independent solver that judges the others
    axis            the physics of the paper: motion in each mode, transitions; the records that solvers work on
    friction        the laws of friction
    linear          closed forms of linear motion, and roots that are not missed
    config          strict YAML, and what a parameter is
    core            what every room uses: errors, events, samples, input profiles, the switch to compiled code
"""

from .core.version import __version__

TYPE_CHECKING = False   # what type checkers take for true; `typing` itself is not imported before it is needed

if TYPE_CHECKING:
    from .core.errors import (
        InputError,
        RecordingError,
        RecordingWarning,
        SolverError,
        StickslipError,
        UnsoundError,
        VerdictError,
    )
    from .core.types import Event, EventKind, Instant, Mode, Sample
    from .identification.identify import identify
    from .inputs import load_scene
    from .inputs.scene_runs import simulate, simulate_events
    from .recording import read_run
    from .runs import Run
    from .runs.batch import run_batch
    from .runs.error_estimate import error_estimate
    from .scene import Scene, scene_names
    from .sensitivity.sensitivities import Sensitivities, sensitivities
    from .simulation.cycles import Cycle, Summary
    from .simulation.simulator import Simulator
    from .study.in_memory import critical, sweep, uncertainty

__all__ = [
    'Cycle', 'Event', 'EventKind', 'InputError', 'Instant', 'Mode', 'RecordingError', 'RecordingWarning', 'Run',
    'Sample', 'Scene', 'Sensitivities', 'Simulator', 'SolverError', 'StickslipError', 'Summary', 'UnsoundError',
    'VerdictError', '__version__', 'critical', 'error_estimate', 'identify', 'load_scene', 'read_run',
    'run_batch', 'scene_names', 'sensitivities', 'simulate', 'simulate_events', 'sweep', 'uncertainty',
]

if not TYPE_CHECKING:   # a type checker knows the names from above, and finds a misspelt one
    _MODULES = {
        '.core.errors': ('InputError', 'RecordingError', 'RecordingWarning', 'SolverError', 'StickslipError',
                         'UnsoundError', 'VerdictError'),
        '.core.types': ('Event', 'EventKind', 'Instant', 'Mode', 'Sample'),
        '.identification.identify': ('identify',),
        '.inputs': ('load_scene',),
        '.inputs.scene_runs': ('simulate', 'simulate_events'),
        '.recording': ('read_run',),
        '.runs': ('Run',),
        '.runs.batch': ('run_batch',),
        '.runs.error_estimate': ('error_estimate',),
        '.scene': ('Scene', 'scene_names'),
        '.sensitivity.sensitivities': ('Sensitivities', 'sensitivities'),
        '.simulation.cycles': ('Cycle', 'Summary'),
        '.simulation.simulator': ('Simulator',),
        '.study.in_memory': ('critical', 'sweep', 'uncertainty'),
    }
    _HOMES = {name: module for module, names in _MODULES.items() for name in names}

    def __getattr__(name):
        """Import what is asked for the first time."""
        if name not in _HOMES:
            raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
        from importlib import import_module

        globals()[name] = found = getattr(import_module(_HOMES[name], __name__), name)
        return found

    def __dir__():
        return sorted(__all__)
