# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Least squares within a region: at borders, and over plateaus beyond them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import lsq_linear

import stickslip_sim as stickslip
from benchmarks.identify.axes import DURATION, SyntheticAxis, axes
from benchmarks.identify.measuring import measure
from stickslip_sim import Sample, Simulator, load_scene
from stickslip_sim.axis import Friction
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.identification.axis_model import put_in_order, with_table
from stickslip_sim.identification.certainty import certainty_of, combinations_of
from stickslip_sim.identification.direct import with_delay
from stickslip_sim.identification.force_noise import NoiseFilter, filters_of, with_quiet_rests
from stickslip_sim.identification.free_parameters import FreeParameter, Region, region_of
from stickslip_sim.identification.least_squares import Solution, bounded_step, minimise
from stickslip_sim.identification.motions import MeasuredMotion, motions_of, track_of
from stickslip_sim.identification.readings import (
    LINE,
    Channel,
    InputReadings,
    SensorReadings,
    instants_of,
    profile_through,
    quantum_of,
    readings_of,
    travelled,
    velocity_within,
)
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.scene.build import friction_of

KINETIC, STATIC, LIMIT = 'friction.kinetic.initial', 'friction.static.initial', 'friction.static.limit'
VALUES = {KINETIC: 0.1, STATIC: 0.15, LIMIT: 0.2, 'friction.static.law': 'exponential'}


def parameters(*names: str, low: float = 0.05, high: float = 0.5) -> list[FreeParameter]:
    return [FreeParameter(name, '', VALUES[name], low, high) for name in names]   # type: ignore[arg-type]


def test_a_step_in_ranges_is_that_of_scipy() -> None:
    random = np.random.default_rng(0)
    for _ in range(50):
        slopes, residuals = random.normal(size=(12, 5)), 3.0 * random.normal(size=12)
        point = random.uniform(-1.0, 1.0, 5)
        point[random.integers(5)] = 1.0
        region = Region(np.full(5, -1.0), np.full(5, 1.0))
        step = bounded_step(slopes.T @ slopes, slopes.T @ residuals, 0.0, point, region)
        right = lsq_linear(slopes, -residuals, (-1.0 - point, 1.0 - point), tol=1e-14).x
        assert step == pytest.approx(right, abs=1e-6)


def test_a_step_in_order_is_the_best_of_those_in_order() -> None:
    random = np.random.default_rng(1)
    region = Region(np.zeros(4), np.full(4, 9.0), (0, 2, 3))
    for _ in range(30):
        slopes, residuals = random.normal(size=(9, 4)), 5.0 * random.normal(size=9)
        point = region.inside(random.uniform(0.0, 9.0, 4))
        end = point + bounded_step(slopes.T @ slopes, slopes.T @ residuals, 0.0, point, region)
        assert end == pytest.approx(region.inside(end), abs=1e-12)
        others = [region.inside(end + size * random.normal(size=4)) for size in (1e-3, 0.1, 3.0) for _ in range(100)]
        costs = [float(np.sum((residuals + slopes @ (other - point))**2)) for other in [end, *others]]
        assert costs[0] <= min(costs) + 1e-9


def test_a_fit_leaves_a_border_beyond_which_a_number_does_nothing() -> None:
    """Static friction as the model sees it is never below kinetic friction: from a start below, it must be found."""
    region = region_of(parameters(KINETIC, STATIC, LIMIT), VALUES)
    true = np.log([0.11, 0.13, 0.19])

    def residuals(point: Numbers) -> Numbers:
        kinetic, static, limit = np.maximum.accumulate(point)
        return 1e3 * np.array([kinetic + 0.1 * static, static - 0.3 * limit, limit + static * kinetic])

    for start in ([0.4, 0.06, 0.06], [0.2, 0.2, 0.2], [0.5, 0.5, 0.5], [0.05, 0.3, 0.1]):
        found = minimise(lambda point: residuals(point) - residuals(true), np.log(start), region, most=40,
                         tolerance=1e-9)
        assert np.exp(found.point) == pytest.approx([0.11, 0.13, 0.19], rel=1e-6), start
        assert found.is_settled


def test_a_search_ends_where_it_crawls_far_from_noise() -> None:
    """A long valley leads to the best point, along which a step gains less than a thousandth of a large misfit."""
    sums: list[float] = []

    def found(misfit: float, far: float) -> tuple[Solution, int]:
        def residuals(point: Numbers) -> Numbers:
            x, y = point
            sums.append(0.0)
            return np.array([misfit, 300.0 * (y - x * x), 3.0 * (1.0 - x)])

        sums.clear()
        region = Region(np.full(2, -3.0), np.full(2, 3.0))
        return minimise(residuals, np.array([-1.2, 1.0]), region, most=60, tolerance=1e-9, far=far), len(sums)

    (near, of_near), (same, of_same) = found(10.0, np.inf), found(10.0, 1e5)
    assert near.point == pytest.approx([1.0, 1.0], abs=1e-4)
    assert (same.point.tolist(), of_same) == (near.point.tolist(), of_near)
    (whole, of_whole), (soon, of_soon) = found(1e3, np.inf), found(1e3, 1e5)
    assert soon.is_settled
    assert soon.cost == pytest.approx(whole.cost, rel=1e-4)
    assert of_soon < 0.1 * of_whole


def test_slopes_at_a_corner_of_the_order_are_those_of_each_number() -> None:
    region = region_of(parameters(KINETIC, STATIC, LIMIT), VALUES)
    matrix = np.array([[3.0, 1.0, 0.5], [0.2, 2.0, -1.0], [1.0, 0.0, 4.0]])
    corner = np.full(3, np.log(0.1))
    found = minimise(lambda point: matrix @ (np.maximum.accumulate(point) - corner), corner, region, most=1,
                     tolerance=1e-3)
    assert found.information == pytest.approx(matrix.T @ matrix, rel=1e-6)


def test_numbers_that_are_not_free_are_borders() -> None:
    region = region_of(parameters(STATIC, LIMIT), VALUES)
    assert np.exp(region.inside(np.log([0.06, 0.06]))) == pytest.approx([0.1, 0.1])
    assert np.exp(region_of(parameters(LIMIT), VALUES).low) == pytest.approx([0.15])
    assert np.exp(region_of(parameters(KINETIC, STATIC), VALUES).high) == pytest.approx([0.2, 0.2])
    assert np.exp(region_of(parameters(KINETIC, LIMIT), VALUES).high) == pytest.approx([0.15, 0.5])
    held = region_of(parameters(KINETIC, STATIC, LIMIT), VALUES).holding(1, float(np.log(0.12)))
    assert np.exp(held.high) == pytest.approx([0.12, 0.12, 0.5])
    assert np.exp(held.low) == pytest.approx([0.05, 0.12, 0.12])
    assert np.exp(held.at(np.full(3, 0.5))) == pytest.approx([(0.05 * 0.12)**0.5, 0.12, (0.12 * 0.5)**0.5])


def test_ranges_that_begin_at_0_are_in_order_too() -> None:
    free = [FreeParameter(KINETIC, '', 0.1, 0.0, 0.4), FreeParameter(STATIC, '', 0.15, 0.0, 0.8)]
    values = {name: value for name, value in VALUES.items() if name != LIMIT}
    inside = region_of(free, values).inside(np.array([0.75, 0.1]))   # shares of the ranges: 0.3 and 0.08
    assert [one.outer(number) for one, number in zip(free, inside)] == pytest.approx([0.3, 0.3])


# What a singular JᵀJ says: parameters that the data do not tell apart are not known, however exact the data are.

SIGMA = 1e-9    # of a reading, relative


def numbers(count: int) -> list[FreeParameter]:
    return [FreeParameter(f'axis.number_{k}', '', 1.0, 0.5, 2.0) for k in range(count)]


def information(jacobian: Numbers, error: float) -> Numbers:
    """Return JᵀJ of derivatives in units of the noise, with relative errors as differences have them."""
    noisy = jacobian * (1.0 + error * np.random.default_rng(5).standard_normal(jacobian.shape)) / SIGMA
    return np.asarray(noisy.T @ noisy)


@pytest.mark.parametrize('error', [0.0, 1e-9, 1e-7])
def test_a_slope_known_to_all_digits_leaves_both_ends_open(error: float) -> None:
    """The first column alone, and two whose ratio alone matters."""
    t = np.linspace(0.0, 1.0, 400)
    found = information(np.stack([np.sin(9.0 * t), t, -t], axis=1), error)
    certainty = certainty_of(found, 1.0, numbers(3))
    assert certainty.known.tolist() == [True, False, False]
    assert 6e-11 < certainty.deviations[0] < 1e-8    # and not that of the other two
    (combination,) = combinations_of(found, numbers(3))
    assert combination.names == ('axis.number_1', 'axis.number_2')


def test_what_the_data_tell_apart_is_known_as_before() -> None:
    t = np.linspace(0.0, 1.0, 400)
    jacobian = np.stack([np.sin(9.0 * t), t, t + 1e-3 * t**2], axis=1)
    found = information(jacobian, 0.0)
    certainty = certainty_of(found, 2.0, numbers(3))
    assert certainty.known.all()
    assert certainty.covariance == pytest.approx(2.0 * np.linalg.inv(found), rel=1e-6, abs=0.0)
    assert combinations_of(found, numbers(3)) == ()


def test_what_is_held_is_not_known() -> None:
    certainty = certainty_of(np.diag([4.0e18, 0.0]), 1.0, numbers(2))
    assert certainty.known.tolist() == [True, False]
    assert certainty.covariance[0, 0] == pytest.approx(2.5e-19, abs=0.0)


# What noise of a measured force does to the motion, and filters that take it out.

TIMES: Numbers = np.arange(4000, dtype=np.float64) * 1e-3
NONE: Numbers = np.array([])


def measured(name: str, resolution: float, times: Numbers = TIMES) -> SensorReadings:
    channel = Channel(name, 'm', np.zeros(len(times)), resolution, 0.0, np.ones(len(times)))
    return SensorReadings(times, 0.0, 1e-3, (channel,), None, None, ())


def filtered(one: NoiseFilter | None, residuals: Numbers) -> Numbers:
    assert one is not None
    return one.white(residuals) / one.deviation


@pytest.mark.parametrize(('name', 'resolution'), [*(('position', noise) for noise in (1e-10, 1.4e-8, 3e-7, 1e-5)),
                                                  *(('velocity', noise) for noise in (1e-7, 3e-6, 1e-4))])
def test_noise_of_a_force_becomes_white(name: str, resolution: float) -> None:
    """A mass under a force with noise that is linear between readings, seen by a sensor with noise of its own."""
    random, mass, noise, period = np.random.default_rng(1), 95.0, 0.3, 1e-3
    times: Numbers = np.arange(20_000, dtype=np.float64) * period
    accelerations = random.normal(0.0, noise / mass, len(times))
    steps = 0.5 * (accelerations[1:] + accelerations[:-1]) * period
    velocity = np.append(0.0, np.cumsum(steps))
    moves = velocity[:-1] * period + (2.0 * accelerations[:-1] + accelerations[1:]) * period**2 / 6.0
    motion = velocity if name == 'velocity' else np.append(0.0, np.cumsum(moves))
    residuals = motion + random.normal(0.0, resolution, len(times))
    (one,) = filters_of(measured(name, resolution, times), noise, mass, NONE)
    white = filtered(one, residuals)
    assert white.std() == pytest.approx(1.0, abs=0.03)
    correlations = [float(white[lag:] @ white[:-lag]) / float(white @ white) for lag in range(1, 50)]
    assert np.abs(correlations).max() < 0.04


def test_after_a_gap_the_filter_starts_anew() -> None:
    """What came before, a drift of 1 mm, is not taken for something new."""
    times = np.concatenate([TIMES[:1000], TIMES[1500:]])
    (one,) = filters_of(measured('position', 1e-7, times), 0.3, 95.0, np.array([2.5]))
    residuals = np.where(times < 1.2, 0.0, 1e-3 * np.cos(times))
    white = filtered(one, residuals)
    assert np.abs(white[times < 2.5]).max() == 0.0   # nor what nobody knows of the force in the gap, up to a stop
    assert np.abs(white[times > 2.6]).max() > 0.0


@pytest.mark.parametrize('moves', [False, True])
def test_a_start_in_motion_counts_from_its_first_stop_on(moves: bool) -> None:
    (one,) = filters_of(measured('position', 1e-7), 0.3, 95.0, np.array([2.5]), moves)
    white = filtered(one, np.random.default_rng(1).normal(0.0, 1e-7, len(TIMES)))
    assert bool(np.any(white[TIMES < 2.4])) is not moves
    assert np.any(white[TIMES > 2.6])


def test_a_force_without_noise_needs_no_filter() -> None:
    assert filters_of(measured('position', 1e-6), 1e-9, 95.0, NONE) == (None,)
    assert filters_of(measured('drive_force', 1e-6), 0.3, 95.0, NONE) == (None,)


# The force on a slider that rests is smoothed, and nothing else: noise must not decide when it breaks away.

MOTION = MeasuredMotion(1.0, 1.5, 0.0, 1e-3, (1.1, 1.2, 1.25, 1.3, 1.4))   # at rest before 1.1 s and from 1.5 s on
NOISE = 0.2   # N


def smoothed(force: Numbers) -> tuple[Numbers, Numbers]:
    """Return the readings of a force, and what is taken for it (n,)."""
    readings = InputReadings(TIMES, force + np.random.default_rng(1).normal(0.0, NOISE, len(TIMES)), LINE)
    found = with_quiet_rests(SensorReadings(TIMES, 0.0, 1e-3, (), None, readings.profile(), (),
                                            force_readings=readings), [MOTION])
    assert found.force is not None
    assert found.force_readings is readings
    return readings.values, found.force.values_at(TIMES)


def test_noise_goes_only_while_the_slider_rests() -> None:
    force = 50.0 * np.sin(3.0 * TIMES)
    readings, found = smoothed(force)
    moves = (TIMES > 1.101) & (TIMES < 1.499)
    np.testing.assert_allclose(found[moves], readings[moves], atol=1e-9)
    assert np.std((found - force)[TIMES < 1.0]) < 0.3 * NOISE
    assert np.std((found - force)[TIMES > 1.6]) < 0.3 * NOISE


def test_a_step_of_the_force_stays_one() -> None:
    force = np.where(TIMES < 0.5, 0.0, 20.0)
    _, found = smoothed(force)
    assert np.abs(found - force).max() < 5.0 * NOISE


# The step in which a sensor counts.


@pytest.mark.parametrize(('counts', 'step'), [
    ((1, 2), 1.0), ((2, 3), 1.0), ((3, 5), 1.0), ((6, 10, 15), 1.0), ((4, 6), 2.0), ((2, 4, 6), 2.0)])
def test_a_sensor_counts_in_the_greatest_step_of_which_its_changes_are_whole_numbers(counts: tuple[int, ...],
                                                                                     step: float) -> None:
    random = np.random.default_rng(0)
    readings = np.cumsum(random.choice(counts, 400) * random.choice([-1, 1], 400))
    for quantum in (1e-6, 0.02, 1.0 / 3.0):
        assert quantum_of(readings * quantum) == pytest.approx(step * quantum, rel=1e-9)
        rounded = np.round(1000.0 * readings / 3.0) * quantum   # as a file has it: to thousandths of a step
        assert quantum_of(rounded) == pytest.approx(step * 1000.0 / 3.0 * quantum, rel=1e-3)


@pytest.mark.parametrize('number', [20, 50, 1000])
def test_noise_counts_in_no_step(number: int) -> None:
    random = np.random.default_rng(number)
    assert not any(quantum_of(random.normal(size=number)) for _ in range(100))


# What a measured force and the motion that it makes tell by themselves: how late the force was read.

MICROMETRE = 1e-6
MASS = FreeParameter('axis.mass', 'kg', 70.0, 50.0, 200.0)


@pytest.mark.parametrize(('held', 'late', 'delay'), [(True, 0, 0.5e-3), (False, 0, 0.0), (False, 3, 3e-3)])
def test_a_delay_of_the_force_shows_in_the_motion(held: bool, late: int, delay: float) -> None:
    """It does where the force has more than one frequency; one that is held acts half a period later than a line."""
    random = np.random.default_rng(3)
    times: Numbers = np.arange(3000, dtype=np.float64) * 1e-3
    force = 60.0 * np.sin(25.0 * times) + 60.0 * np.sin(7.0 * times)
    scene = load_scene('paper_fig7', {'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0, 'axis.mass': 95.0,
                                      'axis.normal_force': 100.0, 'drive.velocity': 0.0,
                                      'friction.acceleration_dependence': False, 'friction.kinetic.velocities': (0.0,),
                                      'friction.kinetic.coefficients': (0.1,), 'friction.kinetic.end_slope': 2.0})
    simulator = Simulator(scene.axis, scene.initial, scene.drive, profile_through(times, force, held))
    rows = np.empty((len(times), len(Sample._fields)))
    simulator.take_samples(instants_of(times), rows)
    position = np.round(rows[:, Sample._fields.index('position')] / MICROMETRE) * MICROMETRE
    channel = Channel('position', 'm', position, 3e-7, MICROMETRE, np.ones(len(times)))
    read = np.append(force[late:], np.full(late, force[-1])) + random.normal(0.0, 0.3, len(times))
    readings = InputReadings(times, read, LINE)
    parameters, found = with_delay((MASS,), SensorReadings(times, 0.0, 1e-3, (channel,), None, readings.profile(), (),
                                                           force_readings=readings), 70.0)
    assert bool(found.notes) is (delay != 0.0)
    assert len(parameters) == 1 + bool(delay)
    if delay:
        assert parameters[-1].name == 'sensor.external_force.delay'
        assert parameters[-1].start == pytest.approx(delay, abs=2e-4)


# Trial values of smooth laws of friction as tables.

BACKWARDS: dict[str, object] = {
    'friction.static.backward.limit': 0.25, 'friction.kinetic.backward.initial': 0.13,
    'friction.kinetic.backward.stribeck_velocity': 0.02}


def scene(**changes: object) -> Scene:
    return scene_from_values({
        'scene': 'both_ways', 'axis.mass': 100.0, 'axis.drive_stiffness': 3e5, 'axis.normal_force': 1000.0,
        'friction.static.law': 'exponential', 'friction.static.initial': 0.15, 'friction.static.limit': 0.2,
        'friction.static.time_constant': 0.2, 'friction.kinetic.law': 'stribeck', 'friction.kinetic.initial': 0.12,
        'friction.kinetic.limit': 0.07, 'friction.kinetic.stribeck_velocity': 0.01, 'friction.kinetic.viscous': 0.2,
        **changes})


def by_table(friction: Friction) -> Friction:
    """Return friction whose kinetic tables do not know which law they stand for."""
    kinetic = replace(friction.kinetic, law=None, error=0.0, tolerance=0.0)
    return replace(friction, kinetic=kinetic, backward=friction.backward and by_table(friction.backward))


def test_static_friction_of_either_way_is_not_below_kinetic_friction() -> None:
    """By rounding, as of the exponential of a logarithm, it was on the way back: no start, and a traceback."""
    values = dict(scene(**{'friction.static.backward.initial': 0.1, 'friction.kinetic.backward.initial': 0.1}).values)
    values['friction.kinetic.backward.initial'] = 0.1 + 1e-15
    put_in_order(values)
    assert values['friction.static.backward.initial'] == 0.1 + 1e-15
    assert values[STATIC] == 0.15
    scene_from_values(values)


@pytest.mark.parametrize('accelerates', [False, True])
@pytest.mark.parametrize('backwards', [{}, BACKWARDS])
def test_the_table_of_a_smooth_law_is_that_of_the_scene_in_each_direction(backwards: dict[str, object],
                                                                          accelerates: bool) -> None:
    given = scene(**backwards, **{'friction.acceleration_dependence': accelerates})
    law = given.axis.friction.kinetic.law
    assert law is not None
    found = by_table(friction_of(with_table(dict(given.values), law.shape)))
    true = by_table(given.axis.friction)
    assert (found.backward is None) == (not backwards)
    for one, other in ((found, true), (found.backward or found, true.backward or true)):
        assert one.static == other.static
        assert one.kinetic.velocities == pytest.approx(other.kinetic.velocities)
        assert one.kinetic.coefficients == pytest.approx(other.kinetic.coefficients)
        assert (one.excess is None) == (other.excess is None) == (not accelerates)
        if one.excess is not None and other.excess is not None:
            assert one.excess.velocities == pytest.approx(other.excess.velocities)


# The motions that are found in a measured position are the slips of the axis, no more and no less.

LEAST = 2e-5   # m: what a sensor of 1 µm shows as a slip
LATE = 0.02    # s


def true_slips(axis: SyntheticAxis) -> list[tuple[float, float, float]]:
    """Return begin, end (s) and way (m) of each slip of an axis that is to be seen."""
    found, begin = [], None
    for event in stickslip.simulate_events(axis.truth, DURATION).events:
        starts = event.kind in (EventKind.BREAKAWAY, EventKind.REVERSE)
        if begin is not None and (starts or event.mode == Mode.STICK):
            found.append((begin.time, event.time, event.position - begin.position))
            begin = None
        if starts:
            begin = event
    return [slip for slip in found if abs(slip[2]) > LEAST]


@pytest.mark.parametrize('index', [0, 7, 16], ids=['slips after a long way', 'rings after it', 'rings'])
def test_the_motions_of_a_run_are_its_slips(tmp_path: Path, index: int) -> None:
    axis = axes(index + 1)[index]
    run = measure(axis.truth, DURATION, np.random.default_rng(axis.seed)).as_run(tmp_path / 'run')
    measurement = readings_of(run, axis.start, {})
    motions = motions_of(track_of(measurement, axis.start.drive))
    slips = true_slips(axis)
    seen = [[motion for motion in motions if begin - LATE < motion.begin < end] for begin, end, _ in slips]
    assert all(seen)   # two where the feed, and with it what is a rest, changes in mid-slip
    assert sum(map(len, seen)) == len(motions)
    for (_, end, way), (motion, *others) in zip(slips, seen):
        if not others:
            assert motion.end == pytest.approx(end, abs=LATE)
            assert motion.stop - motion.start == pytest.approx(way, rel=0.02, abs=1e-5)   # it begins slowly


# Measured inputs: the way of a drive within the resolution of its encoder.



def test_an_even_feed_that_was_counted_is_even() -> None:
    profile = velocity_within(TIMES, np.round(TIMES * 0.00263 / MICROMETRE) * MICROMETRE, 0.5 * MICROMETRE)
    assert len(profile.starts) <= 5
    assert profile.values_at(TIMES[:3900]) == pytest.approx(np.full(3900, 0.00263), rel=1e-4)


def test_the_way_of_a_drive_turns_where_it_must_and_is_near_the_true_one() -> None:
    """Two feeds, a rest, a sine; differences of the readings are off by 1e-3 m/s."""
    turning = np.where(TIMES > 2.5, 2e-4 * np.sin(3.0 * (TIMES - 2.5)), 0.0)
    true = np.interp(TIMES, [0.0, 1.0, 1.5], [0.0, 0.002, 0.0025]) + turning
    places = np.round(true / MICROMETRE) * MICROMETRE
    profile = velocity_within(TIMES, places, 0.5 * MICROMETRE)
    off = travelled(profile, TIMES) - true
    assert np.abs(off - off[0]).max() < 0.6 * MICROMETRE
    assert len(profile.starts) < 150
    velocity = profile.values_at(TIMES)
    for first, last, feed in ((50, 950, 0.002), (1050, 1450, 0.001), (1550, 2450, 0.0)):
        assert np.abs(velocity[first:last] - feed).max() < 2e-6
