# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Cycle figures and summary of a run, from its events."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from stickslip_sim.axis import Axis, Friction, InitialState
from stickslip_sim.check.measures import CIRCLE_KINDS, KINDS
from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.input_profile import table
from stickslip_sim.core.time_grid import Instants
from stickslip_sim.core.types import Event, EventKind, Instant, Mode, Sample
from stickslip_sim.figures.catalogue import CATALOGUE, OF_A_CYCLE, head_of, label_of, unit_of
from stickslip_sim.figures.cycles import (
    SWINGS_ON,
    Cycle,
    EventTally,
    ModeSpan,
    Round,
    cycle_figures,
    mode_spans,
    summary,
    summary_report,
)
from stickslip_sim.figures.distance import (
    cycle_difference,
    event_difference,
    first_difference,
    first_mismatch,
    pair,
    seconds_between,
    shift_between,
)
from stickslip_sim.figures.point_figures import FIGURES
from stickslip_sim.figures.slips import events_of_slips
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.report.text import text_lines
from stickslip_sim.runs import simulate_events
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import COMPLIANT, RIGID, Contact, make, paper_axis, run_events


@pytest.mark.parametrize(('contact', 'period', 'jump', 'peak', 'break_force', 'stick_force'), [
    (RIGID, 0.619075168, 1.238150336e-3, 1.23285921663e-2, 781.443710909, 235.301790949),
    (COMPLIANT, 0.659065697, 1.31813139e-3, 1.16642823367e-2, 788.081203029, 246.606758267)])
def test_limit_cycle_of_the_model(contact: Contact, period: float, jump: float, peak: float, break_force: float,
                                  stick_force: float) -> None:
    figures = summary(run_events(paper_axis(contact), 0.002, 60.0), 60.0)
    last = figures.last
    assert figures.motion == 'stick-slip'
    assert figures.settled
    assert last is not None
    assert last.period == pytest.approx(period, abs=6e-10)
    assert last.jump == pytest.approx(jump, abs=6e-12)
    assert last.peak_speed == pytest.approx(peak, abs=6e-14)
    assert last.break_away_drive_force == pytest.approx(break_force, abs=6e-10)
    assert last.arrest_drive_force == pytest.approx(stick_force, abs=6e-10)
    assert last.break_away_force == pytest.approx(last.static_coefficient * 350 * 9.80665, rel=1e-12)
    assert last.rest_time == pytest.approx(last.stick_time, rel=1e-12)
    assert last.direction == 1


def test_first_cycles_follow_the_events_of_the_model() -> None:
    first, second, *_ = cycle_figures(run_events(paper_axis(RIGID), 0.002, 3.0))
    assert first.begin == pytest.approx(0.67979883333333, abs=1e-14)
    assert first.rest_time == math.inf
    assert first.slip_time == pytest.approx(0.83862368925988008 - 0.67979883333333, abs=1e-14)
    assert first.stick_time == pytest.approx(1.3313467055455221 - 0.83862368925988008, abs=1e-14)
    assert first.period == pytest.approx(first.slip_time + first.stick_time, abs=1e-15)
    assert first.peak_speed == pytest.approx(1.45614975366e-2, abs=1e-13)
    assert first.slip_travel == first.jump == pytest.approx(1.3615322557025e-3, abs=1e-15)
    assert second.static_coefficient == pytest.approx(0.2297848, abs=6e-8)


def test_a_compliant_contact_gives_way_in_stick() -> None:
    last = cycle_figures(run_events(paper_axis(COMPLIANT), 0.002, 60.0))[-1]
    assert last.jump > last.slip_travel > 0.9 * last.jump


def test_mean_over_the_last_cycles() -> None:
    events = run_events(paper_axis(RIGID), 0.002, 20.0)
    figures = summary(events, 20.0)
    cycles = cycle_figures(events)[-10:]
    assert figures.mean is not None
    assert figures.averaged == len(cycles) == 10
    assert figures.mean.period == pytest.approx(sum(cycle.period for cycle in cycles) / 10, rel=1e-14)
    assert figures.mean.direction == 1


def test_share_of_time_in_stick_adds_up() -> None:
    events = run_events(paper_axis(RIGID), 0.002, 10.0)
    spans = mode_spans(events, 0.0, 10.0, Mode.STICK)
    stick = sum(span.end - span.begin for span in spans if span.mode == Mode.STICK)
    assert sum(span.end - span.begin for span in spans) == pytest.approx(10.0, rel=1e-14)
    assert all(a.end == b.begin and a.mode != b.mode for a, b in pairwise(spans))
    assert summary(events, 10.0).stick_share == pytest.approx(stick / 10.0, rel=1e-14)


def test_smooth_sliding_has_no_cycles() -> None:
    events = run_events(paper_axis(RIGID), 0.2, 5.0)
    figures = summary(events, 5.0)
    assert figures.motion == 'smooth sliding'
    assert (figures.cycles, figures.last, figures.mean, figures.settled) == (0, None, None, False)
    assert figures.stick_share < 0.05


@pytest.mark.parametrize('changes', [
    {'drive.velocity': 0.025, 'axis.normal_force': 2300.0, 'initial.velocity': 0.024, 'initial.rest_time': 0.0},
    {'drive.velocity': 0.2, 'drive.amplitudes': [1e-4], 'drive.frequencies': [20.0]}])
def test_a_vibration_that_lasts_without_a_stick_has_its_own_name(changes: dict[str, object]) -> None:
    for duration in (20.0, 60.0):
        assert simulate_events(load_scene('paper_fig8', changes), duration).summary.motion == SWINGS_ON


def test_a_run_that_starts_sliding_counts_from_its_start() -> None:
    initial = InitialState(velocity=0.2)
    events = run_events(paper_axis(RIGID), 0.2, 2.0, initial=initial)
    figures = summary(events, 2.0, Mode.DECELERATING)
    assert figures.motion == 'smooth sliding'
    assert figures.stick_share == 0.0


def test_rest_and_single_slip_are_distinguished() -> None:
    assert summary([], 1.0).motion == 'at rest'
    assert summary([], 1.0).stick_share == 1.0
    pull = table('drive', (0.0, 0.75, 0.76), (0.002, 0.002, 0.0))
    single = summary(run_events(paper_axis(RIGID), pull, 5.0), 5.0)
    assert (single.motion, single.cycles, single.events[EventKind.BREAKAWAY]) == ('single slip', 0, 1)


def test_directions_are_reported() -> None:
    profile = table('drive', (0.0, 3.0, 3.01), (0.002, 0.002, -0.002))
    cycles = cycle_figures(run_events(paper_axis(RIGID), profile, 12.0))
    assert {cycle.direction for cycle in cycles} == {-1, 1}
    assert all(cycle.slip_travel > 0.0 and cycle.peak_speed > 0.0 for cycle in cycles)


def test_the_mean_of_both_directions_has_the_drive_forces_along_each_slip() -> None:
    """They would cancel: a run there and back had a mean of a tenth of each."""
    there = summary(run_events(paper_axis(RIGID), 0.002, 8.0), 8.0)
    profile = table('drive', (0.0, 5.0, 5.01), (0.002, 0.002, -0.002))
    both = summary(run_events(paper_axis(RIGID), profile, 10.0), 10.0)
    assert there.mean is not None
    assert both.mean is not None
    assert (there.mean.direction, both.mean.direction) == (1, 0)
    assert both.mean.break_away_drive_force == pytest.approx(there.mean.break_away_drive_force, rel=0.2)


def test_reversal_at_once_ends_one_slip_and_begins_another() -> None:
    events = [_event(1.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.0, 0.0),
              _event(1.5, EventKind.DECELERATE, Mode.DECELERATING, 1, 0.5, 2.0),
              _event(2.0, EventKind.REVERSE, Mode.ACCELERATING, -1, 1.0, 0.0),
              _event(2.5, EventKind.DECELERATE, Mode.DECELERATING, -1, 0.5, -3.0),
              _event(3.0, EventKind.STICK, Mode.STICK, -1, 0.25, 0.0),
              _event(4.5, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.25, 0.0)]
    there, back = cycle_figures(events)
    assert (there.direction, there.slip_time, there.stick_time, there.slip_travel, there.peak_speed) == (1, 1, 0, 1, 2)
    assert (back.direction, back.slip_time, back.stick_time, back.slip_travel, back.peak_speed) == (-1, 1, 1.5, 0.75, 3)


def test_a_slip_whose_end_is_unknown_is_no_cycle() -> None:
    events = [_event(1.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.0, 0.0),
              _event(4.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.25, 0.0),
              _event(5.0, EventKind.STICK, Mode.STICK, 1, 0.5, 0.0)]
    assert cycle_figures(events) == []
    assert cycle_figures(events[:1]) == []


def test_a_break_away_that_does_not_move_belongs_to_the_stick() -> None:
    events = [_event(1.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.0, 0.0),
              _event(2.0, EventKind.STICK, Mode.STICK, 1, 0.5, 0.0),
              _event(3.0, EventKind.BREAKAWAY, Mode.STICK, 1, 0.5, 0.0),
              _event(4.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.5, 0.0)]
    [cycle] = cycle_figures(events)
    assert (cycle.slip_time, cycle.stick_time) == (1.0, 2.0)


def test_a_contact_that_yields_belongs_to_the_time_after_the_slip_and_is_no_stick() -> None:
    events = [_event(1.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.0, 0.0),
              _event(2.0, EventKind.STICK, Mode.STICK, 1, 1.0, 0.0),
              _event(3.0, EventKind.YIELD, Mode.YIELDING, 1, 0.75, -0.5),
              _event(3.5, EventKind.STICK, Mode.STICK, 1, 0.5, -0.25),
              _event(4.0, EventKind.YIELD, Mode.YIELDING, 1, 0.5, -0.5),
              _event(4.5, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.5, 0.0)]
    [cycle] = cycle_figures(events)
    assert (cycle.slip_time, cycle.stick_time, cycle.slip_travel, cycle.jump) == (1.0, 2.5, 1.0, 0.5)
    figures = summary(events, 5.0)
    assert (figures.stick_share, figures.events[EventKind.YIELD]) == ((1.0 + 1.0 + 0.5) / 5.0, 2)
    assert summary(events[1:3], 5.0).motion == 'single slip'   # nothing slides on while a contact yields


@pytest.mark.parametrize('scene', ['paper_fig7', 'paper_fig8'])
def test_cycles_that_only_touch_rest_are_counted_apart(scene: str) -> None:
    """Without friction and damping v (1 − cos ω t) is 0 once a period, and no force is left there."""
    free = simulate_events(load_scene(scene, {'axis.normal_force': 0.0, 'axis.drive_damping': 0.0}), 10.0)
    assert 0 < free.summary.touches <= free.summary.cycles
    note = free.receipt['results']['note']
    assert note.startswith(f'{free.summary.touches} of {free.summary.cycles} cycles only touch rest')
    assert f'{"note":22} {note}' in [*text_lines(summary_report(free.summary))]
    real = simulate_events(load_scene(scene), 10.0)
    assert (real.summary.touches, 'note' in real.receipt['results']) == (0, False)
    assert not any('touch' in line for line in text_lines(summary_report(real.summary)))


def test_a_turn_under_a_force_touches_nothing() -> None:
    pull = {'force.course': 'sine', 'force.amplitude': 3000.0, 'force.frequency': 1.0, 'axis.normal_force': 100.0}
    figures = simulate_events(load_scene('paper_fig7', pull), 10.0).summary
    assert (figures.events[EventKind.REVERSE] > 10, figures.touches) == (True, 0)


def test_times_late_in_a_run_keep_their_digits() -> None:
    begin = Event(1e9, 0.25, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0, 0, 0, 0, 0, 0.2, 1.0)
    end = begin._replace(fraction=0.25 + 1e-9, kind=EventKind.STICK, mode=Mode.STICK)
    after = begin._replace(second=1e9 + 1, fraction=0.0)
    [cycle] = cycle_figures([begin, end, after])
    assert isinstance(cycle, Cycle)
    assert cycle.slip_time == pytest.approx(1e-9, rel=1e-6)
    assert cycle.period == 0.75


def test_spans_within_a_window() -> None:
    events = [_event(1.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.0, 0.0),
              _event(2.0, EventKind.STICK, Mode.STICK, 1, 0.5, 0.0)]
    assert mode_spans(events, 1.5, 3.0, Mode.STICK) == [
        ModeSpan(1.5, 2.0, Mode.ACCELERATING), ModeSpan(2.0, 3.0, Mode.STICK)]


def test_only_time_within_the_window_counts() -> None:
    events = [_event(1.0, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.0, 0.0),
              _event(2.0, EventKind.STICK, Mode.STICK, 1, 0.5, 0.0),
              _event(3.5, EventKind.BREAKAWAY, Mode.ACCELERATING, 1, 0.5, 0.0),
              _event(3.75, EventKind.STICK, Mode.STICK, 1, 1.0, 0.0)]
    assert summary(events, 1.5, Mode.STICK, begin=1.5).stick_share == 2 / 3
    assert summary(events, 4.0).stick_share == (1.0 + 1.5 + 0.25) / 4.0


def test_a_tally_knows_at_any_time_what_a_summary_says() -> None:
    events = run_events(paper_axis(COMPLIANT), 0.002, 20.0)
    tally = EventTally()
    for count, event in enumerate(events, 1):
        tally.add(event)
        assert tally.latest_time == event.time
        assert tally.summary(event.time + 0.01) == summary(events[:count], event.time + 0.01)


def _event(time: float, kind: EventKind, mode: Mode, direction: int, position: float, velocity: float) -> Event:
    return Event(math.floor(time), time - math.floor(time), kind, mode, direction, position, velocity, position, 10.0,
                 10.0, 0.2, 1.0)


# Runs of very many events in one call: they go on as long as time does.

STIFFNESS = 6e5
NO_FRICTION = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.0, 0.0), KineticTable((0.0,), (0.0,)), None)


def swinging(mass: float) -> Simulator:
    """Return a slider on an undamped spring, which turns round twice a swing for ever."""
    return make(Axis(mass, STIFFNESS, 0.0, 0.0, RIGID, NO_FRICTION), 0.0, initial=InitialState(velocity=0.1))


def test_a_long_call_has_any_number_of_events() -> None:
    whole, parts, skipped = swinging(350.0), swinging(350.0), swinging(350.0)
    end = Instant(9000.0, 0.0)
    turns = [event for event in whole.advance(end) if event.kind == EventKind.REVERSE]
    assert len(turns) == math.floor(9000.0 * math.sqrt(STIFFNESS / 350.0) / math.pi + 0.5) > 100_000
    assert [event for k in range(1, 10) for event in parts.advance(Instant(1000.0 * k, 0.0))
            if event.kind == EventKind.REVERSE] == turns
    skipped.skip(end)
    assert skipped.sample() == parts.sample() == whole.sample()


@pytest.mark.parametrize('go_on', [
    lambda simulator: simulator.advance(Instant(1.0, 0.0)), lambda simulator: simulator.skip(Instant(1.0, 0.0)),
    lambda simulator: simulator.take_samples(Instants(np.array([1.0]), np.array([0.0])),
                                             np.empty((1, len(Sample._fields))))])
def test_a_call_in_which_time_stands_ends(go_on: Callable[[Simulator], object]) -> None:
    """It reverses 250 million times a second."""
    simulator = swinging(1e-12)
    times = []
    for _ in range(2):
        with pytest.raises(SolverError, match=r'^1000\d\d events up to t = .* time hardly advances'):
            go_on(simulator)
        times.append(simulator.time.seconds)
    assert 0.0 < times[0] < times[1] < 0.001


# Distances of two lists of events: what each of the meanings sees.

DURATION = 3.0
EVENTS = run_events(paper_axis(RIGID), 0.002, DURATION)


def test_a_run_is_no_distance_from_itself() -> None:
    assert first_difference(EVENTS, EVENTS) is None
    assert first_mismatch(EVENTS, EVENTS) == len(EVENTS) > 8
    assert shift_between(EVENTS, EVENTS, DURATION) == (0.0, 0.0, DURATION)
    assert event_difference(EVENTS, EVENTS, DURATION) == 0.0
    assert cycle_difference(*cycle_figures(EVENTS)[:1] * 2) == 0.0


def test_an_event_that_is_late_differs_and_does_not_mismatch() -> None:
    late = [*EVENTS]
    late[3] = late[3]._replace(fraction=late[3].fraction + 1e-6)
    assert (first_difference(EVENTS, late), first_mismatch(EVENTS, late)) == (3, len(EVENTS))
    assert shift_between(EVENTS, late, DURATION).time == seconds_between(EVENTS[3], late[3]) > 0.9e-6


def test_a_missing_event_ends_the_common_part_and_leaves_the_other_pairs() -> None:
    short = [*EVENTS[:4], *EVENTS[5:]]
    assert first_difference(EVENTS, short) == first_mismatch(EVENTS, short) == 4
    assert shift_between(EVENTS, short, DURATION).until == EVENTS[4].time
    points = [(event.time, event.position) for event in EVENTS]
    assert pair(points, [*points[:4], *points[5:]], DURATION) == [(one, one) for one in points if one != points[4]]


def test_a_cycle_that_one_run_alone_has_ends_the_common_part() -> None:
    starts = [k for k, event in enumerate(EVENTS) if event.kind == EventKind.BREAKAWAY]
    without = [*EVENTS[:starts[1]], *EVENTS[starts[2]:]]
    assert [event.kind for event in without] == [event.kind for event in EVENTS[:len(without)]]
    assert first_mismatch(EVENTS, without) == len(without)
    assert shift_between(EVENTS, without, DURATION) == (0.0, 0.0, EVENTS[starts[1]].time)


# The catalogue of figures: all that runs, studies and limits have, and how it is worded.

NOT_FIGURES = {'second', 'fraction', 'kind', 'mode', 'direction'}   # instant and state


@pytest.mark.parametrize('names', [Cycle._fields, Round._fields, FIGURES, KINDS, CIRCLE_KINDS, Event._fields,
                                   Sample._fields])
def test_all_figures_are_in_the_catalogue_with_their_formula(names: tuple[str, ...]) -> None:
    assert {*names} - NOT_FIGURES <= CATALOGUE.keys()
    assert all(CATALOGUE[name].formula for name in {*names} - NOT_FIGURES)


def test_labels_and_units() -> None:
    assert [(head_of(name), unit_of(name)) for name in OF_A_CYCLE] == [
        ('period', 's'), ('stick', 's'), ('slip', 's'), ('jump', 'm'), ('peak speed', 'm/s'),
        ('break-away force', 'N'), ('drive force at arrest', 'N'), ('static coefficient', '')]
    assert [label_of(name) for name in ('stick_time', 'stick_slip', 'begin')] == [
        'stick time', 'stick-slip', 'break-away']


# Slips by the speed alone: where they begin and end between two samples, and what is none.

THRESHOLD = 0.5   # m/s


@pytest.mark.parametrize('direction', [1, -1])
def test_a_slip_begins_and_ends_where_its_speed_passes_the_threshold(direction: int) -> None:
    """One slip of 4 m/s between two samples of 1 s; before it a swing of less than five times the threshold."""
    speed = np.array([0.0, 2.0, 0.0, 0.0, 4.0, 4.0, 0.0, 0.0], dtype=np.float64)
    still = dict.fromkeys(('position', 'drive_position', 'drive_force', 'friction_force'), np.zeros(len(speed)))
    time = np.arange(8, dtype=np.float64)
    events = events_of_slips({'time': time, 'velocity': direction * speed, **still}, THRESHOLD)
    assert [(event.kind, event.direction, event.time) for event in events] == [
        (EventKind.BREAKAWAY, direction, 3.125), (EventKind.DECELERATE, direction, 4.0),
        (EventKind.STICK, direction, 5.875)]
    assert [event.rest_time for event in events[:1]] == [3.125]
