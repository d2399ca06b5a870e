# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Steps made again: as a node made them, or as an offline run did."""

import hashlib
import json
import shlex
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from ..bags import topics
from ..bags.bag import METADATA
from ..core.arrays import Columns
from ..core.errors import InputError, RecordingError, one_line
from ..core.types import Event, EventKind, Mode, Progress, Sample
from ..core.version import __version__
from ..figures.cycles import summary
from ..recording import Bag, MeasuredRun, RecordedMessage, RecordedRun
from ..recording.run import CHECKPOINT_FILE, SCENE_FILE, RunFacts, checkpoint_file
from ..runs import SimulatedRun, simulate
from ..runs.samples import GATHERED, MOST_HELD, HeldSamples, RemadeSamples, Samples, joined
from ..runs.simulated import columns_of_rows
from ..scene import Scene, changed, scene_from_values
from ..scene.schema import BY_NAME
from ..simulation import Fault, Rig, RigEventKind, StepResult
from .observed_run import first_command_of

_MAKERS = 'version', 'python', 'platform', 'numpy', 'hot_path'


class Offline(NamedTuple):
    """How long an offline run was, and how often it was sampled."""

    duration: float            # s
    sample_period: Fraction    # s


def doubts_about(run: RecordedRun) -> tuple[str, ...]:
    """Return what is doubtful about a run, for people; raises RecordingError when it cannot be run again."""
    bag = run.bag
    if isinstance(run, MeasuredRun):
        raise RecordingError(f'{bag.path}: a measurement; only simulated runs can be verified')
    if not bag.is_complete and not bag.topics:
        raise RecordingError(f'{bag.path}: cut off before its first message was written')
    facts = _facts_of(run)
    if part := facts.get('part'):
        raise RecordingError(f'{bag.path}: part {part} of a recording that was split, which begins with another file; '
                             'give the folder of the whole bag')
    _ = run.scene, checkpoint_of(run), offline_of(run)
    return tuple(map(one_line, _doubts(run, facts)))


def checkpoint_of(run: RecordedRun) -> Mapping[str, Any] | None:
    """Return the checkpoint that a run began from; None when it began at the start of its scene."""
    return run.bag.values(CHECKPOINT_FILE) if CHECKPOINT_FILE in run.bag.attachments else None


def begins_in_mid_run(run: RecordedRun) -> bool:
    """Return whether a run began elsewhere than its scene does: not so after a reset, while time stands still at 0."""
    checkpoint = checkpoint_of(run)
    if checkpoint is None:
        return False
    rig = run.scene.make_rig()
    rig.make_step()
    return bool(json.loads(checkpoint_file(rig.checkpoint())[CHECKPOINT_FILE]) != checkpoint)


def offline_of(run: RecordedRun) -> Offline | None:
    """Return how an offline run was carried out; None for a node's.  Raises RecordingError when it does not say."""
    facts = _facts_of(run)
    if facts.get('origin') == 'node':
        return None
    try:
        return Offline(float(facts['duration']), Fraction(facts['sample_period']))
    except (KeyError, ValueError, ZeroDivisionError):
        raise RecordingError(f'{run.bag.path}: it does not say whether a node or the tool made it; recorded by another '
                             'version?') from None


def made_with(run: RecordedRun) -> str:
    """Return what of the recording's versions and machine is not as here, and what is here instead; for people."""
    recorded, here = _facts_of(run), RunFacts.of(run.scene).as_metadata()
    others = [f'{name} {recorded[name]} (here {here[name]})' for name in _MAKERS
              if recorded.get(name, here[name]) != here[name]]
    return one_line(', '.join(others)) or 'the same versions on the same kind of machine'


def _facts_of(run: RecordedRun) -> Mapping[str, str]:
    if METADATA not in run.bag.metadata:
        raise RecordingError(f'{run.bag.path}: its scene and solver are missing; give a run that stickslip recorded')
    return run.bag.metadata[METADATA]


def _doubts(run: RecordedRun, facts: Mapping[str, str]) -> Iterator[str]:
    if facts.get('version') != __version__:
        yield f'recorded by stickslip {facts.get("version")}, this is {__version__}: the numbers may differ'
    if hashlib.sha256(run.bag.attachments[SCENE_FILE]).hexdigest() != facts.get('scene_hash'):
        yield f'{SCENE_FILE} was changed after the recording'
    elif run.scene.hash != facts.get('scene_hash'):
        yield f'{SCENE_FILE} means something else in this version'
    if run.bag.next_file:
        yield f'the recording {run.bag.continuation}'
    elif not run.is_complete:
        yield 'the recording has no end: cut off, or still being written'
    if dropped := run.receipt.get('dropped_messages'):
        yield f'{dropped} messages were dropped while recording'


# The messages of a recording, step by step.

# What was ordered in a recorded run, done again to a rig.

_ORDERS = RigEventKind.COMMAND_TIMEOUT, RigEventKind.FAULT_INJECTED, RigEventKind.FAULT_CLEARED
_VALUES = {1: 'bool_value', 2: 'integer_value', 3: 'double_value', 4: 'string_value', 5: 'byte_array_value',
           6: 'bool_array_value', 7: 'integer_array_value', 8: 'double_array_value', 9: 'string_array_value'}


def is_order(bag: Bag, message: RecordedMessage) -> bool:
    """Return whether a rig event was ordered from outside; the others follow by themselves."""
    return bag.decode(message).kind in _ORDERS


class Orders:
    """Orders to a rig of a scene; `fixed` parameters stay as they are when others were changed while the axis ran."""

    def __init__(self, bag: Bag, scene: Scene, rig: Rig, fixed: Collection[str]) -> None:
        self._bag, self._rig, self._fixed = bag, rig, fixed
        self._velocity: float | None = None    # for the next step, m/s
        self._force: float | None = None       # N
        self._values = scene.values
        self._doers = {topics.DRIVE_VELOCITY.type: self._command_velocity,
                       topics.EXTERNAL_FORCE.type: self._command_force,
                       topics.RIG_EVENT.type: self._event, topics.PARAMETER_EVENTS.type: self._change}

    def give(self, message: RecordedMessage) -> None:
        """Order what a message says; raises RecordingError when the rig refuses."""
        try:
            self._doers[message.type](self._bag.decode(message))
        except InputError as error:
            raise self._refused(message.sequence, error) from None

    def make_step(self) -> StepResult:
        """Make the next step, under the commands given before it; raises RecordingError when the rig refuses them."""
        velocity, force, self._velocity, self._force = self._velocity, self._force, None, None
        try:
            return self._rig.make_step(velocity, force)
        except InputError as error:
            raise self._refused(self._rig.step + 1, error) from None

    def _refused(self, step: int, error: InputError) -> RecordingError:
        return RecordingError(f'{self._bag.path}: the command before step {step} is refused: {error}')

    def _command_velocity(self, message: Any) -> None:
        self._velocity = message.velocity

    def _command_force(self, message: Any) -> None:
        self._force = message.force

    def _event(self, message: Any) -> None:
        if message.kind == RigEventKind.COMMAND_TIMEOUT:
            self._rig.time_out(message.value)
        elif message.kind == RigEventKind.FAULT_INJECTED:
            self._rig.inject(Fault(message.id, message.fault, message.start, message.duration, message.value))
        elif message.id:
            self._rig.clear_fault(message.id)
        else:
            self._rig.clear_faults()

    def _change(self, message: Any) -> None:
        self._values = self._values | {parameter.name: _value(parameter.value)
                                       for parameter in message.changed_parameters if parameter.name not in self._fixed}
        self._rig.change_axis(scene_from_values(self._values).axis)


def _value(value: Any) -> object:
    """Return the value of a parameter; None when it has none."""
    found: Any = getattr(value, _VALUES[value.type]) if value.type in _VALUES else None
    return found.tolist() if hasattr(found, 'tolist') else found


ORDERS = topics.DRIVE_VELOCITY, topics.EXTERNAL_FORCE, topics.RIG_EVENT, topics.PARAMETER_EVENTS
_OUTPUTS = topics.SLIDER_STATE, topics.FRICTION_FORCE, topics.MODE_EVENT
MOST_MISSING = 1_000_000           # steps that are made again without being compared
_HALF, _WHOLE = 1 << 31, 1 << 32   # the file has 32 bits for the number of a step


class RecordedStep(NamedTuple):
    """What was recorded of a step: what was ordered before it, and what came of it, by type of topic."""

    number: int
    orders: list[RecordedMessage]
    outputs: dict[topics.Topic, list[RecordedMessage]]

    @property
    def is_whole(self) -> bool:
        """Whether the state at its end was recorded."""
        return bool(self.outputs[topics.SLIDER_STATE] and self.outputs[topics.FRICTION_FORCE])


def steps_of(run: RecordedRun, start: int) -> Iterator[RecordedStep]:
    """Yield the recorded steps after `start` (−1: all); raises RecordingError when they do not follow each other.

    An offline run has no orders: its commands only repeat what its input profiles did.
    """
    bag = run.bag
    ordered = () if offline_of(run) else [topic for topic in ORDERS if topic.type in bag.topics.values()]
    kinds = {bag.name_of(topic): topic for topic in (*ordered, *_OUTPUTS)}
    messages = (message for message in bag.messages(kinds) if kinds[message.topic] != topics.RIG_EVENT
                or is_order(bag, message))
    number, missing = start, 0
    for sequence, group in groupby(_numbered(messages, kinds, start), key=lambda item: item[0]):
        ahead = (sequence - number + _HALF) % _WHOLE - _HALF
        if ahead < 0:
            raise RecordingError(f'{bag.path}: step {number + ahead} after step {number}; give a recording of one run')
        missing += max(ahead - 1, 0)
        if missing > MOST_MISSING:
            raise RecordingError(f'{bag.path}: step {number + ahead} after step {number}; a recording that lacks more '
                                 f'than {MOST_MISSING} steps is damaged')
        number += ahead
        if number > start:     # what was in force at the checkpoint is recorded again
            yield _step(number, [message for _, message in group], kinds)


def _numbered(messages: Iterable[RecordedMessage], kinds: dict[str, topics.Topic], start: int
              ) -> Iterator[tuple[int, RecordedMessage]]:
    """Yield messages with the number of their step; events at the very start belong to step 0, which is none."""
    is_at_start = start < 0
    for message in messages:
        is_at_start = is_at_start and kinds[message.topic] != topics.SLIDER_STATE
        yield 0 if is_at_start and kinds[message.topic] == topics.MODE_EVENT else message.sequence, message


def _step(number: int, messages: list[RecordedMessage], kinds: dict[str, topics.Topic]) -> RecordedStep:
    outputs: dict[topics.Topic, list[RecordedMessage]] = {topic: [] for topic in _OUTPUTS}
    orders: list[RecordedMessage] = []
    for message in messages:
        outputs.get(kinds[message.topic], orders).append(message)
    return RecordedStep(number, orders, outputs)


class Made(NamedTuple):
    """A step made again: its events without those of kind knot, and the state at its end."""

    number: int
    events: list[Event]
    sample: Sample


class _NodeMaker:
    """Follows the orders of the recording."""

    def __init__(self, run: RecordedRun, scene: Scene, fixed: Collection[str]) -> None:
        self._rig, self._known = _rig(run, scene)
        self._orders = Orders(run.bag, scene, self._rig, fixed)
        self.start = self._rig.step

    def make(self, step: RecordedStep) -> Iterator[Made]:
        """Yield all steps up to a recorded one, which begins with what was ordered before it; raises SolverError."""
        while self._rig.step + 1 < step.number:
            yield self._made()
        events = [order for order in step.orders if order.type == topics.RIG_EVENT.type][:self._known]
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
        """Yield all steps up to a recorded one; raises SolverError."""
        for number, sample in self._samples:
            events = []
            while self._events and self._events[0].instant <= sample.instant:
                events.append(self._events.popleft())
            yield Made(number, events, sample)
            if number == step.number:
                return
        raise RecordingError(f'{self._path}: step {step.number} is beyond the duration of the run')


Maker = _NodeMaker | _OfflineMaker   # of steps, one after the other; `start` is the last one that was made before


def maker_of(run: RecordedRun, scene: Scene, fixed: Collection[str] = (), progress: Progress = None) -> Maker:
    """Return what makes a run again from its scene, or from another whose `fixed` parameters nothing changes.

    A run that begins with a checkpoint takes the axis of the scene alone.  Raises RecordingError and InputError.
    """
    offline = offline_of(run)
    return _OfflineMaker(run, scene, offline, progress) if offline else _NodeMaker(run, scene, fixed)


def _without_knots(events: Sequence[Event]) -> list[Event]:
    return [event for event in events if event.kind != EventKind.KNOT]


# A recorded run beside what would have been with other parameters, under the same orders.

def other_scene(run: RecordedRun, changes: Mapping[str, object]) -> Scene:
    """Return the scene with changes; raises InputError on those that this recording leaves no room for."""
    is_of_node, is_in_mid_run = offline_of(run) is None, begins_in_mid_run(run)
    for name, value in changes.items():
        entry = BY_NAME.get(name)
        if is_of_node and name.startswith('time.'):
            raise InputError(name, value, 'as in the recording', 'its commands are counted in steps')
        if is_in_mid_run and entry is not None and not entry.live:
            raise InputError(name, value, 'a parameter that can change while the axis runs',
                             'this recording begins in mid-run; use one from the start')
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
