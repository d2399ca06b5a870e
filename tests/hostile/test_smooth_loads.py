# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The judges of a normal force that varies smoothly: they agree with each other, and each of them can fail."""

import math
import random
from collections.abc import Callable, Sequence

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.types import EnergyBalance, Event, EventKind, Mode, Sample
from stickslip_sim.proof.axes import Parts, instant
from stickslip_sim.proof.judges import Find
from stickslip_sim.reference import ReferenceRun, simulate
from tests.hostile.case import Case, Run, Undecided
from tests.hostile.generators import GENERATORS
from tests.hostile.judges import brute
from tests.support.axes import COMPLIANT, RIGID, Contact, paper_axis

pytestmark = pytest.mark.slow

pytest.importorskip('mpmath')

ADAPTIVE = {'solver.name': 'adaptive'}


def sine(amplitude: float, frequency: float) -> InputProfile:
    return InputProfile((0.0,), (0.0,), (0.0,), math.inf, (Sinusoid(amplitude, frequency, 0.0),))


def parts_of(contact: Contact, load: InputProfile, duration: float) -> Parts:
    return Parts(paper_axis(contact), InitialState(), constant(0.002), constant(0.0), duration, load)


def followed(parts: Parts) -> ReferenceRun:
    return simulate(parts.axis, parts.initial, parts.drive, parts.force, parts.duration, load=parts.load)


def as_run(parts: Parts) -> Run:
    """Return the reference's run as the engine would give it; the inputs have one piece each."""
    done = followed(parts)
    start, end = (Sample(*instant(time), state.mode, 1, float(state.position), float(state.velocity), 0.0,
                         float(state.drive_position), 0.0, float(state.drive_force), 0.0, float(state.friction_force),
                         0.0, 0.0, parts.initial.rest_time)
                  for time, state in zip((0.0, parts.duration), done.exact.state_at([0.0, parts.duration])))
    return Run(parts, [], start, [(done.events, end)], EnergyBalance(*[0.0] * len(EnergyBalance._fields)),
               len(done.events))


YIELDING = parts_of(COMPLIANT, sine(343.2, 25.0), 1.35)
RIGID_RUN = parts_of(RIGID, sine(1000.0, 7.0), 1.2)


@pytest.fixture(scope='module', params=[RIGID_RUN, YIELDING], ids=['rigid', 'yielding'])
def good(request: pytest.FixtureRequest) -> Run:
    return as_run(request.param)


# without 4 and 6 of the smooth loads: contacts that ring for seconds, which take 9 s for 4 events
@pytest.mark.parametrize(('name', 'seeds'), [('paper_loads', range(6)), ('smooth_loads', (1, 2, 3, 5))])
def test_brute_force_and_reference_agree(name: str, seeds: Sequence[int]) -> None:
    compared = 0
    for seed in seeds:
        case = GENERATORS[name](random.Random(f'agree/{seed}'))
        parts = Case(case.values | ADAPTIVE, case.duration).parts
        try:
            events = brute.brute_force(parts)
        except Undecided:
            continue
        if len(events) > 16:
            parts = parts._replace(duration=0.5 * (events[14].time + events[15].time))
        compared += brute.compare(parts, followed(parts).events)
    assert compared > 35


def test_no_break_away_of_the_trial_is_missed_by_brute_force() -> None:
    events = brute.brute_force(parts_of(RIGID, sine(1000.0, 7.0), 8.0))
    assert (len(events), [event.kind for event in events].count(EventKind.BREAKAWAY)) == (137, 31)


def test_a_good_run_passes(good: Run) -> None:
    assert len(good.events) > 8
    assert (Mode.YIELDING in {event.mode for event in good.events}) is (good.parts is YIELDING)
    assert brute.wrong_guards(good) == []
    assert brute.compare(good.parts, good.events) >= len(good.events) - 1


@pytest.mark.parametrize('wrong', [
    lambda _: [], lambda event: [event._replace(fraction=event.fraction + 1e-10)],
    lambda event: [event._replace(drive_force=event.drive_force * (1.0 + 1e-8))]],
    ids=['missed', 'at another time', 'with another force'])
def test_a_wrong_event_is_seen(wrong: Callable[[Event], list[Event]], good: Run) -> None:
    """The last event of each kind and mode: to go from each event to its end is slow."""
    end = good.stretches[0][1]
    for k in {(event.kind, event.mode): k for k, event in enumerate(good.events)}.values():
        events = [*good.events[:k], *wrong(good.events[k]), *good.events[k + 1:]]
        assert brute.wrong_guards(good._replace(stretches=[(events, end)])), good.events[k]


def test_brute_force_sees_a_missed_break_away(good: Run) -> None:
    leaps = [k for k, event in enumerate(good.events) if event.kind == EventKind.BREAKAWAY]
    with pytest.raises(Find, match='BREAKAWAY'):
        brute.compare(good.parts, good.events[:leaps[-1]])
    late = good.events[leaps[0]]
    with pytest.raises(Find, match='moved by'):
        brute.compare(good.parts, [late._replace(fraction=late.fraction + 1e-7), *good.events[leaps[0] + 1:]])
