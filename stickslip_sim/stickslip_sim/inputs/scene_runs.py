# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of a scene, or of the one of a name or path."""

from fractions import Fraction

from .. import runs
from ..core.callbacks import Progress
from .scene_files import SceneOrName, scene_of


def simulate(scene: SceneOrName, duration: float, sample_period: float | Fraction | None = None,
             progress: Progress = None) -> runs.SimulatedRun:
    """Simulate `duration` seconds of a scene, with a sample every `sample_period` seconds from 0 on (None: each step).

    `progress` is called with the share that is done.  Raises InputError on times without a meaning and on a run too
    long to hold, SolverError when the solver gives up, and what `load_scene` raises.
    """
    return runs.simulate(scene_of(scene), duration, sample_period, progress)


def simulate_events(scene: SceneOrName, duration: float, progress: Progress = None) -> runs.SimulatedRun:
    """Simulate as `simulate` does, without any sample: for long runs, and where events say all."""
    return runs.simulate_events(scene_of(scene), duration, progress)
