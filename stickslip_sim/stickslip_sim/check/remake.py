# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Steps made again: as a node made them, or as an offline run did."""

from collections import deque
from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple, Protocol

from ..bags.topics import RIG_EVENT
from ..core.errors import InputError, RecordingError
from ..core.types import Event, EventKind, Progress, Sample
from ..recording import RecordedRun
from ..recording.run import CHECKPOINT_FILE
from ..runs import simulate
from ..scene import Scene
from ..simulation import Rig
from .origin import Offline, begins_in_mid_run, checkpoint_of, offline_of
from .recorded_steps import Orders, RecordedStep


class Made(NamedTuple):
    """A step made again: its events without those of kind knot, and the state at its end."""

    number: int
    events: list[Event]
    sample: Sample


class Maker(Protocol):
    """Makes steps one after the other; `start` is the last one that was made before."""

    start: int

    def make(self, step: RecordedStep) -> Iterator[Made]:
        """Yield all steps up to a recorded one, which begins with what was ordered before it; raises SolverError."""


def maker_of(run: RecordedRun, scene: Scene, fixed: Collection[str] = (), progress: Progress = None) -> Maker:
    """Return what makes a run again from its scene, or from another whose `fixed` parameters nothing changes.

    A run that begins with a checkpoint takes the axis of the scene alone.  Raises RecordingError and InputError.
    """
    offline = offline_of(run)
    return _OfflineMaker(run, scene, offline, progress) if offline else _NodeMaker(run, scene, fixed)


class _NodeMaker:
    """Follows the orders of the recording."""

    def __init__(self, run: RecordedRun, scene: Scene, fixed: Collection[str]) -> None:
        self._rig, self._known = _rig(run, scene)
        self._orders = Orders(run.bag, scene, self._rig, fixed)
        self.start = self._rig.step

    def make(self, step: RecordedStep) -> Iterator[Made]:
        while self._rig.step + 1 < step.number:
            yield self._made()
        events = [order for order in step.orders if order.type == RIG_EVENT.type][:self._known]
        self._known = 0
        for order in step.orders:
            if order not in events:
                self._orders.give(order)
        yield self._made()

    def _made(self) -> Made:
        result = self._orders.make_step()
        return Made(result.step, _without_knots(result.events), result.sample)


def _rig(run: RecordedRun, scene: Scene) -> tuple[Rig, int]:
    """Return the rig as the recording began, and how many of the first events it has behind it.

    With another scene a recording from the start of its own begins at the start of that.
    """
    checkpoint = checkpoint_of(run)
    if checkpoint is None or (scene is not run.scene and not begins_in_mid_run(run)):
        return scene.make_rig(), 0
    rig = run.scene.make_rig()
    try:
        rig.restore(checkpoint)
        known = int(checkpoint['notes'])
    except (InputError, LookupError, TypeError, ValueError, OverflowError) as error:
        raise RecordingError(f'{run.bag.path}: its {CHECKPOINT_FILE} is damaged or of another version: {error}'
                             ) from None
    rig.change_axis(scene.axis)
    return rig, known


class _OfflineMaker:
    """Follows the input profiles of the scene."""

    start = -1

    def __init__(self, run: RecordedRun, scene: Scene, offline: Offline, progress: Progress) -> None:
        self._path = run.bag.path
        again = simulate(scene, offline.duration, offline.sample_period, progress)
        self._samples = enumerate(again.sample_rows())
        self._events = deque(_without_knots(again.events))

    def make(self, step: RecordedStep) -> Iterator[Made]:
        for number, sample in self._samples:
            events = []
            while self._events and self._events[0].instant <= sample.instant:
                events.append(self._events.popleft())
            yield Made(number, events, sample)
            if number == step.number:
                return
        raise RecordingError(f'{self._path}: step {step.number} is beyond the duration of the run')


def _without_knots(events: Sequence[Event]) -> list[Event]:
    return [event for event in events if event.kind != EventKind.KNOT]
