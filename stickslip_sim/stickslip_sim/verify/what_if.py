# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run beside what would have been with other parameters, under the same orders."""

from collections.abc import Mapping

import numpy as np

from ..core.errors import InputError
from ..core.types import Event, Sample
from ..recording import RecordedRun
from ..runs import SimulatedRun
from ..runs.samples import HeldSamples
from ..runs.simulated import columns_of_rows
from ..scene import Scene, changed
from ..scene.schema import BY_NAME
from ..simulation.cycles import summary
from .origin import checkpoint_of, offline_of
from .remake import Progress, maker_of
from .steps import steps_of


def other_scene(run: RecordedRun, changes: Mapping[str, object]) -> Scene:
    """Return the scene with changes; raises InputError on those that this recording leaves no room for."""
    is_of_node, begins_in_mid_run = offline_of(run) is None, checkpoint_of(run) is not None
    for name, value in changes.items():
        entry = BY_NAME.get(name)
        if is_of_node and name.startswith('time.'):
            raise InputError(name, value, 'as in the recording', 'its orders are counted in steps')
        if begins_in_mid_run and entry is not None and not entry.live:
            raise InputError(name, value, 'a parameter that can change while the axis runs',
                             'this recording begins in mid-run; take one from the start')
    return changed(run.scene, changes)


def other_run(run: RecordedRun, scene: Scene, changes: Mapping[str, object], progress: Progress = None) -> SimulatedRun:
    """Return the same steps under the same orders with another scene, which `changes` made of that of the recording.

    Raises RecordingError when an order makes no sense any more, SolverError when the solver gives up.
    """
    maker = maker_of(run, scene, changes.keys(), progress)
    samples: list[Sample] = []
    events: list[Event] = []
    for step in steps_of(run, maker.start):
        for made in maker.make(step):
            samples.append(made.sample)
            events += made.events
    begin, end = samples[0].time, samples[-1].time
    figures = summary([event for event in events if begin <= event.time <= end], end - begin, samples[0].mode, begin)
    columns = HeldSamples(columns_of_rows(np.array(samples)))
    return SimulatedRun(scene, end, None, events, columns, figures, begin=begin)
