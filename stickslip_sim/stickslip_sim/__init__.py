# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Exact, event-driven simulation of a feed axis with stick-slip friction.

    import stickslip_sim as stickslip

    run = stickslip.simulate(stickslip.load_scene('paper_fig8'), duration=10.0)
    run.plot('run.png')

All names of `__all__` are imported when they are first used (docs/python.md shows them).  Each room, a folder here,
says in the first line of its __init__ what is in it and what is next door; CONTRIBUTING.md has the map.
"""

from .core.version import __version__

TYPE_CHECKING = False   # what type checkers take for true; `typing` itself is not imported before it is needed

if TYPE_CHECKING:
    from .check.report import plot_runs
    from .closed_loop import close_loop, close_loops, tune
    from .controllers.own_controller import Command
    from .core.errors import (
        ControllerError,
        InputError,
        RecordingError,
        RecordingWarning,
        SolverError,
        StickslipError,
        UnsoundError,
        VerdictError,
    )
    from .core.types import Event, EventKind, Instant, Mode, Sample
    from .figures.cycles import Cycle, Summary
    from .identification.identify import identify
    from .identification.prediction import predict
    from .identification.run_friction import friction_curve
    from .inputs import load_scene
    from .inputs.measurement import Measurement
    from .inputs.scene_files import simulate, simulate_events
    from .recording import read_run
    from .runs import Run
    from .runs.batch import run_batch
    from .runs.error_estimate import error_estimate
    from .scene import Scene, scene_names
    from .sensitivity.experiments import design
    from .sensitivity.sensitivities import Sensitivities, sensitivities
    from .simulation.simulator import Simulator
    from .study.in_memory import critical, sweep, uncertainty

__all__ = [
    'Command', 'ControllerError', 'Cycle', 'Event', 'EventKind', 'InputError', 'Instant', 'Measurement', 'Mode',
    'RecordingError', 'RecordingWarning', 'Run', 'Sample', 'Scene', 'Sensitivities', 'Simulator', 'SolverError',
    'StickslipError', 'Summary', 'UnsoundError', 'VerdictError', '__version__', 'close_loop', 'close_loops',
    'critical', 'design', 'error_estimate', 'friction_curve', 'identify', 'load_scene', 'plot_runs', 'predict',
    'read_run', 'run_batch', 'scene_names', 'sensitivities', 'simulate', 'simulate_events', 'sweep', 'tune',
    'uncertainty',
]

if not TYPE_CHECKING:   # a type checker knows the names from above, and finds a misspelt one
    _MODULES = {
        '.check.report': ('plot_runs',),
        '.closed_loop': ('close_loop', 'close_loops', 'tune'),
        '.controllers.own_controller': ('Command',),
        '.core.errors': ('ControllerError', 'InputError', 'RecordingError', 'RecordingWarning', 'SolverError',
                         'StickslipError', 'UnsoundError', 'VerdictError'),
        '.core.types': ('Event', 'EventKind', 'Instant', 'Mode', 'Sample'),
        '.figures.cycles': ('Cycle', 'Summary'),
        '.identification.identify': ('identify',),
        '.identification.prediction': ('predict',),
        '.identification.run_friction': ('friction_curve',),
        '.inputs': ('load_scene',),
        '.inputs.measurement': ('Measurement',),
        '.inputs.scene_files': ('simulate', 'simulate_events'),
        '.recording': ('read_run',),
        '.runs': ('Run',),
        '.runs.batch': ('run_batch',),
        '.runs.error_estimate': ('error_estimate',),
        '.scene': ('Scene', 'scene_names'),
        '.sensitivity.experiments': ('design',),
        '.sensitivity.sensitivities': ('Sensitivities', 'sensitivities'),
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
