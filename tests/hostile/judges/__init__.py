# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The judges of any run; each raises Find.  Those that follow the motion itself have files of their own.

`touch` judges a contact that swings without loss.  With mu_s = mu_k(0), no damper and inputs at rest, the contact force
starts on the limit at an arrest and moves inwards.  It is back there after each whole period, exactly, and never
beyond: what breaks away then is invented.  No arithmetic can know, not even that of the reference; the argument does.
"""

import json
import math
import random
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.input_profile import InputProfile
from stickslip_sim.core.types import Event, EventKind, Instant, Mode, Sample
from stickslip_sim.figures.cycles import summary
from stickslip_sim.figures.distance import seconds_between
from stickslip_sim.friction import KineticTable
from stickslip_sim.proof.axes import instant
from stickslip_sim.proof.judges import Find, in_parts, same_bits
from stickslip_sim.proof.transforms import Image
from stickslip_sim.proof.transforms import images as images_of
from stickslip_sim.runs.batch import run_batch

from ..case import LastBits, Run

_SLIPS = (Mode.ACCELERATING, Mode.COASTING, Mode.DECELERATING)
_BEFORE = {EventKind.BREAKAWAY: (Mode.STICK, Mode.YIELDING), EventKind.COAST: (Mode.ACCELERATING, Mode.DECELERATING),
           EventKind.ACCELERATE: (Mode.COASTING, Mode.DECELERATING),
           EventKind.DECELERATE: (Mode.ACCELERATING, Mode.COASTING), EventKind.STICK: (*_SLIPS, Mode.YIELDING),
           EventKind.REVERSE: _SLIPS, EventKind.KNOT: _SLIPS, EventKind.YIELD: (Mode.STICK,)}
_AFTER = {EventKind.BREAKAWAY: (*_SLIPS, Mode.STICK), EventKind.COAST: (Mode.COASTING,),
          EventKind.ACCELERATE: (Mode.ACCELERATING,), EventKind.DECELERATE: (Mode.DECELERATING,),
          EventKind.STICK: (Mode.STICK,), EventKind.REVERSE: (*_SLIPS, Mode.STICK), EventKind.KNOT: _SLIPS,
          EventKind.YIELD: (Mode.YIELDING,)}
_OF_CYCLE = ('rest_time', 'slip_time', 'stick_time', 'period', 'slip_travel', 'jump', 'peak_speed', 'break_away_force',
             'static_coefficient')
_UNBALANCED = 1e-9   # of the throughput
_ROUNDING = 1e-14    # of the forces that add up, along the way: a drive damper may be huge, and its force nothing
_SAME_TIME = 1e-9    # of the duration: times that differ by no more are those of the same events
_MOST_SPLITS = 60    # of the events at whose own times a run is split
_BESIDE = 1e-6       # of a period


def order(run: Run, _: random.Random) -> None:
    """See that each event fits the mode before it, that all numbers are finite, and that time never goes back."""
    for event in run.events:
        if not all(map(math.isfinite, event[5:11])):
            raise Find(f'a number is not finite: {tuple(event)}')
    mode, direction = run.start.mode, run.start.direction
    for event in run.events[len(run.at_start):]:
        if mode not in _BEFORE[event.kind] or event.mode not in _AFTER[event.kind]:
            raise Find(f'{event.kind.name} leads from {mode.name} to {event.mode.name} at {event.time!r} s')
        if event.kind == EventKind.REVERSE:
            direction = -direction
        elif event.kind in (EventKind.BREAKAWAY, EventKind.YIELD):
            direction = event.direction
        turns_back = event.velocity * direction < 0.0 and Mode.YIELDING not in (mode, event.mode)
        if event.direction != direction or turns_back:
            raise Find(f'{event.kind.name} at {event.time!r} s goes {event.direction:+d} at {event.velocity!r} m/s, '
                       f'after {direction:+d}')
        mode = event.mode
    end = run.stretches[-1][1]
    if mode != end.mode:
        raise Find(f'it ends in {end.mode.name} and not in {mode.name}')
    times = [event.instant for event in run.events]
    if any(b < a for a, b in pairwise([*times, end.instant])) or any(not 0.0 <= at.fraction < 1.0 for at in times):
        raise Find('time goes back')


def bounds(run: Run, _: random.Random) -> None:
    """See that the account of energy closes, and that no speed is beyond what an axis can reach."""
    bound = speed_bound(run)
    for state in _states(run):
        if not abs(state.velocity) <= bound:
            raise Find(f'a speed of {state.velocity!r} m/s at {state.time!r} s; no more than {bound:.6g} is possible')
    residual = abs(run.energy.residual)
    if not residual <= _UNBALANCED * _energy(run) + _ROUNDING * _forces(run) * _way(run):
        raise Find(f'the account of energy does not close: a residual of {residual:.3g} J of {_energy(run):.3g} J')


def images(run: Run, rng: random.Random) -> None:
    """Run the mirror image and the scene in other units; raise Find, or LastBits, unless all are the same."""
    for image in images_of(run.parts, rng):
        _compare_image(image, image.of_events(run.events))


def parts(run: Run, rng: random.Random) -> None:
    """Run with stops at random instants, at events, and through a checkpoint."""
    end = run.stretches[-1][1]
    times = [instant(rng.random() * run.parts.duration) for _ in range(10)]
    times += [event.instant for event in run.events[:_MOST_SPLITS]]
    split = run.parts.simulator()
    seen = in_parts(split, [*sorted(time for time in times if time <= end.instant), end.instant])
    _same_run('in parts', run, seen, split.sample())
    _from_checkpoint(run, rng.choice(times))


def batch(run: Run, _: random.Random) -> None:
    """Run an axis under constant inputs in a batch; raise Find where a figure differs."""
    parts = run.parts
    constants = [profile.values[0] for profile in (parts.drive, parts.force)
                 if len(profile.starts) == 1 and profile.rates == (0.0,) and not profile.sinusoids
                 and profile.period == math.inf]
    if parts.load is not None or len(constants) < 2:
        return
    figures = run_batch(parts.axis, parts.duration, drive_velocity=constants[0], external_force=constants[1],
                        initial=parts.initial, threads=1)
    events = run.events
    known = summary(events, parts.duration, run.start.mode if parts.initial.velocity != 0.0 else Mode.STICK)
    slips = [e.time for e in events if e.kind == EventKind.REVERSE or
             (e.kind == EventKind.BREAKAWAY and e.mode != Mode.STICK)]
    wanted = {'events': float(len(events)), 'cycles': float(known.cycles), 'complete': 1.0,
              'final_mode': float(run.stretches[-1][1].mode), 'first_break_away': slips[0] if slips else math.nan}
    for name in _OF_CYCLE:
        wanted[name] = float(getattr(known.last, name)) if known.last is not None else math.nan
    for name, value in wanted.items():
        got = float(getattr(figures, name)[0])
        if not (got == value or (math.isnan(got) and math.isnan(value))):
            raise Find(f'{name} is {got!r} in a batch and {value!r} in a simulator')


def touch(run: Run, _: random.Random) -> None:
    """Raise Find where a contact that only touches its limit breaks away."""
    axis, drive, force = run.parts.axis, run.parts.drive, run.parts.force
    contact = axis.contact
    if not isinstance(contact, CompliantContact) or contact.damping > 0.0 or axis.drive_damping > 0.0:
        return
    if contact.undeflected or contact.ends_by_drive:   # it does not begin on its limit
        return
    if any(drive.values) or any(drive.rates) or drive.sinusoids or force.sinusoids or any(force.rates) \
            or len(force.values) > 1 or run.parts.load is not None:
        return
    if any(side.static.initial != side.kinetic.coefficients[0] for side in axis.friction.sides):
        return
    period = 2.0 * math.pi / math.sqrt((axis.drive_stiffness + contact.stiffness) / axis.mass)
    for before, event in pairwise(run.events):
        turns = seconds_between(before, event) / period
        whole = round(turns)
        if (before.kind, event.kind) == (EventKind.STICK, EventKind.BREAKAWAY) and whole > 0 and (
                abs(turns - whole) < _BESIDE):
            raise Find(f'a break-away at {event.time!r} s, {(turns - whole) * period:.3g} s beside a touch of the '
                       f'limit, {whole} periods after the arrest')


JUDGES: Mapping[str, Callable[[Run, random.Random], None]] = {
    one.__name__: one for one in (order, bounds, images, parts, batch, touch)}


def _compare_image(image: Image, wanted: Sequence[Event]) -> None:
    try:
        seen = image.parts.events()
    except SolverError as error:
        raise Find(f'{image.name}: refused: {error}') from None
    try:
        same_bits(seen, wanted, image.name)
    except Find as find:
        alike = len(seen) == len(wanted) and all(
            (a.kind, a.mode) == (b.kind, b.mode) and abs(a.time - b.time) <= _SAME_TIME * image.parts.duration
            for a, b in zip(seen, wanted))
        raise (LastBits if alike else Find)(str(find)) from None


def _from_checkpoint(run: Run, at: Instant) -> None:
    parts, end = run.parts, run.stretches[-1][1]
    first, second = parts.simulator(), parts.simulator()
    seen = first.advance(min(at, end.instant))
    second.restore(json.loads(json.dumps(first.checkpoint())), parts.axis, parts.drive, parts.force)
    seen += second.advance(end.instant)
    _same_run(f'from a checkpoint at {at.seconds!r} s', run, seen, second.sample())


def _same_run(how: str, run: Run, seen: Sequence[Event], end: Sample) -> None:
    same_bits(seen, run.events, how)
    if end != run.stretches[-1][1]:
        raise Find(f'{how}: the end is {end} and not {run.stretches[-1][1]}')


def speed_bound(run: Run) -> float:
    """Return a speed (m/s) that no slider can pass.

    Seen from the drive, E = m (ẋ − v)²/2 + c (s − x)²/2 changes by the power of F_e and friction, the damper only
    takes: sqrt(2 E/m) grows by (|F_e| + N mu)/m per second at the most, and by |dv|.  A rest begins anew.
    """
    axis, drive, force = run.parts.heaviest, run.parts.drive, run.parts.force
    end = run.parts.duration
    fastest, changes = _most(drive, end), _changes(drive, end)
    held = axis.normal_force * max(_coefficients(axis, run))
    # a damper on the slideway is one on the drive and a force against its velocity
    pull = _most(force, end) + held + axis.slideway_damping * fastest
    start = abs(run.parts.initial.velocity)
    # a slip begins with a stretch that a rest can hold; one rest is as good as any other
    stretch = held + _most(force, end) + axis.drive_damping * (fastest + start)
    stored = stretch / math.sqrt(axis.drive_stiffness * axis.mass) if axis.drive_stiffness > 0.0 else 0.0
    return 1.001 * (start + 2.0 * fastest + changes + stored + pull / axis.mass * end) + 1e-300


def _energy(run: Run) -> float:
    """Return the throughput, or what a spring at the limit stores: a drive that comes back leaves no work."""
    axis, energy = run.parts.heaviest, run.energy
    limit = axis.normal_force * max(side.static.initial for side in axis.friction.sides)
    return max(energy.throughput, energy.stored, energy.stored_at_start,
               limit * limit / axis.drive_stiffness if axis.drive_stiffness > 0.0 else 0.0)


def _forces(run: Run) -> float:
    axis, end = run.parts.heaviest, run.parts.duration
    fastest = _most(run.parts.drive, end) + max(abs(state.velocity) for state in _states(run))
    stretch = max((abs(e.drive_force) for e in run.events), default=0.0)
    steepest = axis.normal_force * max(_steepest(side.kinetic) for side in axis.friction.sides)
    return (2.0 * (axis.drive_damping + steepest) * fastest + stretch + _most(run.parts.force, end)
            + axis.normal_force * max(_coefficients(axis, run)))


def _steepest(table: KineticTable) -> float:
    points = pairwise(zip(table.velocities, table.coefficients))
    return max([abs(table.end_slope), *(abs((b - a) / (w - v)) for (v, a), (w, b) in points)])


def _way(run: Run) -> float:
    return 2.0 * _most(run.parts.drive, run.parts.duration) * run.parts.duration + max(
        abs(state.position - run.start.position) for state in _states(run))


def _states(run: Run) -> list[Event | Sample]:
    return [run.start, *run.events, *(sample for _, sample in run.stretches)]


def _coefficients(axis: Axis, run: Run) -> list[float]:
    return [*(mu for side in axis.friction.sides for mu in (*side.kinetic.coefficients, side.static.initial)),
            *(event.static_coefficient for event in run.events)]


def _most(profile: InputProfile, end: float) -> float:
    values = [abs(v) + abs(r) * max(min(end, stop) - t, 0.0) for t, stop, v, r in zip(
        profile.starts, (*profile.starts[1:], profile.period), profile.values, profile.rates)]
    return max(values) + sum(abs(w.amplitude) for w in profile.sinusoids)


def _changes(profile: InputProfile, end: float) -> float:
    """Return a bound on how much the profile changes up to the end."""
    stops = (*profile.starts[1:], min(profile.period, end))
    rise = sum(abs(r) * max(min(end, stop) - t, 0.0) for t, stop, r in zip(profile.starts, stops, profile.rates))
    finals = [v + r * (stop - t) for t, stop, v, r in zip(profile.starts, stops, profile.values, profile.rates)]
    jumps = sum(abs(b - a) for a, b in zip(finals, profile.values[1:])) + abs(profile.values[0] - finals[-1])
    turns = max(1.0, math.ceil(end / profile.period)) if profile.period < math.inf else 1.0
    sinusoids = sum(abs(w.amplitude) * (4.0 * w.frequency * end + 2.0) for w in profile.sinusoids)
    return (rise + jumps) * turns + sinusoids
