# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run beside what would have been with other parameters, under the same orders."""

import shlex
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..core.arrays import Columns
from ..core.errors import InputError, one_line
from ..core.types import Event, Mode, Progress, Sample
from ..figures.cycles import summary
from ..recording import RecordedRun
from ..runs import SimulatedRun
from ..runs.samples import GATHERED, MOST_HELD, HeldSamples, RemadeSamples, Samples, joined
from ..runs.simulated import columns_of_rows
from ..scene import Scene, changed
from ..scene.schema import BY_NAME
from .observed_run import first_command_of
from .origin import begins_in_mid_run, offline_of
from .remake import Maker, maker_of, steps_of


def other_scene(run: RecordedRun, changes: Mapping[str, object]) -> Scene:
    """Return the scene with changes; raises InputError on those that this recording leaves no room for."""
    is_of_node, is_in_mid_run = offline_of(run) is None, begins_in_mid_run(run)
    for name, value in changes.items():
        entry = BY_NAME.get(name)
        if is_of_node and name.startswith('time.'):
            raise InputError(name, value, 'as in the recording', 'its orders are counted in steps')
        if is_in_mid_run and entry is not None and not entry.live:
            raise InputError(name, value, 'a parameter that can change while the axis runs',
                             'this recording begins in mid-run; take one from the start')
    return changed(run.scene, changes)


def feedback_note(run: RecordedRun, changes: Mapping[str, object]) -> str:
    """Return that a controller would have given other commands, and how to ask it; empty for a run without commands."""
    if first_command_of(run) is None:
        return ''
    known = run.receipt.get('controller')
    controller: Mapping[str, Any] = known if isinstance(known, dict) else {}
    command = str(controller.get('command') or f'stickslip close-loop FILE.py:{controller.get("name", "NAME")} --scene '
                  f'{run.scene.name} --duration {run.duration:g}')
    changed = shlex.join(word for name, value in changes.items() for word in ('--set', f'{name}={value}'))
    return one_line('the commands are those of the recording; a controller that sees the other axis answers otherwise: '
                    f'{command} {changed}')


def other_run(run: RecordedRun, scene: Scene, changes: Mapping[str, object], progress: Progress = None) -> SimulatedRun:
    """Return the same steps under the same orders with another scene, which `changes` made of that of the recording.

    Raises RecordingError when an order makes no sense any more, SolverError when the solver gives up.
    """
    def made(progress: Progress = None) -> Iterator[tuple[Columns, list[Event]]]:
        return _blocks(run, maker_of(run, scene, changes.keys(), progress))

    held: list[Columns] = []
    events: list[Event] = []
    count, begin, end, start = 0, 0.0, 0.0, Mode.STICK
    for block, new in made(progress):
        if not count:
            begin, start = float(block['time'][0]), Mode(int(block['mode'][0]))
        count, end = count + len(block['time']), float(block['time'][-1])
        events += new
        if count <= MOST_HELD:
            held.append(block)
    figures = summary([event for event in events if begin <= event.time <= end], end - begin, start, begin)
    samples: Samples = (HeldSamples(joined(held)) if count <= MOST_HELD
                        else RemadeSamples(lambda: (block for block, _ in made()), count))
    return SimulatedRun(scene, end, None, events, samples, figures, begin=begin, setpoint=run.setpoint)


def _blocks(run: RecordedRun, maker: Maker) -> Iterator[tuple[Columns, list[Event]]]:
    """Yield the samples and the events of the steps of a recording, made again, block by block."""
    samples: list[Sample] = []
    events: list[Event] = []
    for step in steps_of(run, maker.start):
        for made in maker.make(step):
            samples.append(made.sample)
            events += made.events
        if len(samples) >= GATHERED:
            yield columns_of_rows(np.array(samples)), events
            samples, events = [], []
    if samples:
        yield columns_of_rows(np.array(samples)), events
