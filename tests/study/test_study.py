# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Points of a study: the bits of runs of their own, samples, and what is refused."""

import math
import random
from dataclasses import fields
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.figures.distance import seconds_between
from stickslip_sim.figures.point_figures import RUN_FIELDS
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import Scene, changed
from stickslip_sim.study import MOTIONS, EvenGrid, Figures, Motion, Sobol, Study, variation
from stickslip_sim.study.critical import feed_of_theory
from stickslip_sim.study.in_memory import critical, sweep, uncertainty
from stickslip_sim.study.points import runs_alone
from tests.support.scene_files import refusal
from tests.support.tool import refusals

CONSTANT = {'friction.static.law': 'constant', 'friction.static.initial': 0.24,
            'friction.kinetic.velocities': [0.0], 'friction.kinetic.coefficients': [0.12]}


def grid(scene: Scene, *texts: str, duration: float | None = None) -> Study:
    return Study(scene.values, EvenGrid(tuple(map(variation, texts))), duration)


def rounds(events: list[Event]) -> list[list[Event]]:
    """Return the events of each round, from one break-away out of stick to the next, with both."""
    breaks = [k for k, event in enumerate(events) if event.kind == EventKind.BREAKAWAY and event.mode != Mode.STICK]
    return [events[a:b + 1] for a, b in pairwise(breaks)]


def same(one: Figures, other: Figures) -> bool:
    return all(getattr(one, field.name).tobytes() == getattr(other, field.name).tobytes() for field in fields(Figures))


@pytest.mark.parametrize(('name', 'texts'), [
    ('paper_fig7', ('drive.velocity=1e-4:0.06:7:log', 'axis.drive_stiffness=1e5:1e7:3:log')),
    ('paper_fig8', ('drive.velocity=1e-3:0.06:5:log', 'contact.damping=0:3e4:2')),
    ('paper_fig4_falling', ('axis.normal_force=500:5000:4', 'friction.kinetic.coefficients[1]=0.0:0.12:3')),
    ('stribeck', ('friction.kinetic.stribeck_velocity=0.002:0.02:3:log', 'drive.velocity=0.001:0.05:3'))])
def test_figures_are_those_of_runs_of_their_own(name: str, texts: tuple[str, ...]) -> None:
    study = grid(load_scene(name), *texts)
    figures, points = study.figures(0, study.count), study.points(0, study.count)
    slips = 0
    for k, point in enumerate(points):
        run = simulate_events(study.scene_at(point), float(figures.duration[k]))
        cycles = cycle_figures(run.events)
        assert figures.cycles[k] == len(cycles)
        if figures.motion[k] != Motion.STICK_SLIP:
            assert figures.motion[k] == Motion.SMOOTH_SLIDING
            assert math.isnan(figures.period[k])
            continue
        slips += 1
        found = rounds(run.events)
        last, breaks = found[-1], [one[0].time for one in found]
        assert figures.amplitude[k] == max(cycle.slip_travel for cycle in cycle_figures(last))
        assert figures.peak_speed[k] == max(abs(event.velocity) for event in last)
        assert figures.break_away_force[k] == abs(last[0].friction_force)
        assert figures.period[k] == seconds_between(last[0], last[-1])
        assert figures.stick_share[k] == seconds_between(last[-2], last[-1]) / figures.period[k]
        if not figures.settled[k]:
            assert figures.duration[k] > 100.0
        elif math.isnan(figures.settling_time[k]):   # in groups
            assert any(abs(seconds_between(one[0], one[-1]) / figures.period[k] - 1.0) > 1e-6 for one in found[-4:])
        else:
            assert figures.settling_time[k] in breaks
            settled = [seconds_between(one[0], one[-1]) for one in found if one[0].time >= figures.settling_time[k]]
            assert np.abs(np.diff(settled)).max() < 1e-6 * settled[-1]
    assert slips > 3


@pytest.mark.parametrize('name', ['paper_fig7', 'paper_fig8', 'paper_fig4_constant'])
def test_one_after_the_other_gives_the_bits_of_the_batch(name: str) -> None:
    study = grid(load_scene(name), 'drive.velocity=1e-3:0.08:9:log', 'initial.rest_time=0:1:2', duration=7.5)
    points = study.points(0, study.count)
    batch, alone = study.runs(points), runs_alone(study.values, study.names, points, 7.5)
    for field in RUN_FIELDS:
        if field == 'stick_share':   # one sums exactly, one as it goes
            assert batch.stick_share == pytest.approx(alone.stick_share, abs=1e-12)
        elif field != 'settled':
            assert getattr(batch, field).tobytes() == getattr(alone, field).tobytes(), field


def test_where_the_points_are_cut_changes_no_bit() -> None:
    study = grid(load_scene('paper_fig7'), 'drive.velocity=1e-4:0.06:40:log', 'axis.normal_force=1000:5000:3')
    whole = study.figures(0, 120)
    for first, last in ((0, 120), (7, 8), (31, 77)):
        part = study.figures(first, last)
        assert same(part, Figures(**{f.name: getattr(whole, f.name)[first:last] for f in fields(Figures)}))


@pytest.mark.parametrize('damping', [100.0, 1000.0, 5000.0])
def test_the_map_changes_at_the_critical_feed_of_the_theory(damping: float) -> None:
    scene = load_scene('paper_fig4_constant', {**CONSTANT, 'axis.drive_damping': damping})
    critical = feed_of_theory(scene.axis)
    assert critical is not None
    study = grid(scene, f'drive.velocity={0.5 * critical!r}:{2.0 * critical!r}:60')
    slips = study.figures(0, 60).motion == Motion.STICK_SLIP
    assert (slips == (study.points(0, 60)[:, 0] < critical)).all()


def test_a_damper_in_the_friction_moves_the_critical_feed_as_one_in_the_drive() -> None:
    both = {**CONSTANT, 'axis.drive_damping': 600.0, 'friction.kinetic.end_slope': 400.0 / 3432.3275}
    moved, plain = (load_scene('paper_fig4_constant', changes).axis
                    for changes in (both, {**CONSTANT, 'axis.drive_damping': 1000.0}))
    expected = feed_of_theory(plain)
    assert expected is not None
    assert feed_of_theory(moved) == pytest.approx(expected, rel=1e-12)
    feed = f'drive.velocity={expected * (1.0 - 1e-6)!r}:{expected * (1.0 + 1e-6)!r}:2'
    motions = grid(load_scene('paper_fig4_constant', both), feed).figures(0, 2).motion
    assert motions.tolist() == [Motion.STICK_SLIP, Motion.SMOOTH_SLIDING]


@pytest.mark.parametrize(('changes', 'expected'), [
    ({}, None), ({**CONSTANT, 'axis.drive_damping': 0.0}, math.inf), ({**CONSTANT, 'axis.drive_damping': 3e4}, 0.0),
    ({**CONSTANT, 'contact.model': 'compliant', 'contact.stiffness': 5e6}, None),
    ({**CONSTANT, 'axis.drive_stiffness': 0.0}, None),
    ({**CONSTANT, 'friction.static.law': 'kato', 'friction.static.limit': 0.3, 'friction.static.initial': 0.12,
      'friction.static.time_constant': 0.1, 'friction.static.exponent': 0.5, 'axis.drive_damping': 0.0}, math.inf)])
def test_the_theory_says_only_what_it_knows(changes: dict[str, object], expected: float | None) -> None:
    assert feed_of_theory(load_scene('paper_fig4_falling', changes).axis) == expected


def test_motions_have_their_words() -> None:
    scene = load_scene('paper_fig7', {'friction.static.initial': 0.2, 'drive.velocity': 0.0})
    study = grid(scene, 'force.constant=0:2000:4', 'initial.velocity=0:1e-3:2')
    words = [MOTIONS[Motion(int(code))] for code in study.figures(0, 8).motion]
    assert words == ['at rest'] * 8   # the drive stands still: they stop, at once or after a slip
    moved = grid(scene, 'drive.velocity=1e-3:2e-3:2', 'force.constant=0:200:2').figures(0, 4)
    assert (moved.motion == Motion.STICK_SLIP).all()
    assert [MOTIONS[Motion(int(code))] for code in
            grid(load_scene('fast_feed'), 'drive.velocity=0.1:0.2:2').figures(0, 2).motion] == ['smooth sliding'] * 2


def test_inputs_that_change_with_time_run_one_after_the_other() -> None:
    study = grid(load_scene('cutting_force'), 'force.period=0.05:0.0625:2', duration=3.0)
    figures = study.figures(0, 2)
    run = simulate_events(load_scene('cutting_force'), 3.0)
    assert run.summary.last is not None
    assert figures.period[1] == run.summary.last.period
    assert not study.works_in_batches
    assert study.chunk < 100


def test_a_sobol_sample_fills_the_ranges_and_its_parts_are_those_of_the_whole() -> None:
    ranges = tuple(variation(text, drawn=True) for text in ('drive.velocity=1e-4:1e-1:log', 'axis.mass=100:500'))
    sample = Sobol(ranges, 256, seed=3)
    points = sample.points(0, 256)
    assert (points[:, 0] > 1e-4).all()
    assert (points[:, 1] < 500.0).all()
    assert np.histogram(np.log10(points[:, 0]), 16, (-4.0, -1.0))[0].tolist() == [16] * 16
    assert np.array_equal(points[100:131], sample.points(100, 131))
    assert np.array_equal(points[:100], Sobol(ranges, 100, seed=3).points(0, 100))
    assert not np.array_equal(points, Sobol(ranges, 256, seed=4).points(0, 256))


def test_a_grid_has_every_combination_with_both_ends() -> None:
    points = EvenGrid((variation('axis.mass=100:400:4'), variation('drive.velocity=1e-3:1e-1:3:log'))).points(0, 12)
    assert points[:3, 1] == pytest.approx([1e-3, 1e-2, 1e-1])
    assert sorted(set(points[:, 0])) == [100.0, 200.0, 300.0, 400.0]
    assert len({*map(tuple, points.tolist())}) == 12


@pytest.mark.parametrize(('text', 'said'), refusals(Path(__file__).with_name('variations_refused.txt')))
def test_a_variation_without_a_meaning_is_refused(text: str, said: str) -> None:
    assert said in str(refusal(variation, text))


@pytest.mark.parametrize(('name', 'texts', 'said'), [
    ('paper_fig7', ('contact.stiffness=1e6:1e7:3',), 'contact.model'),
    ('paper_fig7', ('friction.static.initial=0.1:0.2:3',), 'friction.static.initial'),
    ('paper_fig7', ('friction.static.initial=0.12:0.3:3',), 'friction.static.limit'),
    ('paper_fig7', ('friction.kinetic.coefficients[2]=0.1:0.2:3',), 'has 2'),
    ('paper_fig7', ('axis.mass=1:2:3', 'axis.mass=1:2:3'), 'once'),
    ('paper_fig7', tuple(f'axis.mass=1:{k + 2}:2' for k in range(11)), 'once to 10'),
    ('cutting_force', ('axis.mass=300:400:3',), 'duration')])
def test_a_study_with_a_corner_that_is_no_scene_is_refused(name: str, texts: tuple[str, ...], said: str) -> None:
    assert said in str(refusal(grid, load_scene(name), *texts))


@pytest.mark.parametrize('duration', [0.0, -1.0, math.nan, 1e12])
def test_a_duration_without_a_meaning_is_refused(duration: float) -> None:
    with pytest.raises(InputError, match='duration'):
        grid(load_scene('paper_fig7'), 'axis.mass=300:400:3', duration=duration)


@pytest.mark.parametrize('seed', range(3))
def test_a_run_twice_as_long_ends_in_the_same_cycle(seed: int) -> None:
    rng = random.Random(seed)
    scene = load_scene(rng.choice(['paper_fig7', 'paper_fig8']),
                       {'axis.mass': rng.uniform(100, 600), 'drive.velocity': rng.uniform(5e-4, 2e-2)})
    study = grid(scene, 'axis.drive_damping=500:8000:6')
    figures = study.figures(0, 6)
    for k, point in enumerate(study.points(0, 6)):
        longer = simulate_events(study.scene_at(point), 2.0 * float(figures.duration[k])).summary
        if figures.motion[k] == Motion.STICK_SLIP:
            assert longer.last is not None
            assert longer.last.period == pytest.approx(figures.period[k], rel=1e-6)
            assert longer.last.slip_travel == pytest.approx(figures.amplitude[k], rel=1e-5)
        else:
            assert longer.events[EventKind.STICK] <= figures.cycles[k] + 1


def test_a_slider_that_coasts_nearly_as_fast_as_its_drive_is_not_yet_sliding_for_ever() -> None:
    """Its second slip brings no event for seconds, at 6.8 mm/s; then it sticks and slips on."""
    scene = load_scene('paper_fig8', {
        'axis.mass': 115.82957334408503, 'axis.drive_stiffness': 1899777.28494845,
        'axis.drive_damping': 4534.61867091659, 'axis.normal_force': 3745.8605070997946,
        'contact.stiffness': 1334524.75239396, 'contact.damping': 3705.5319733103565,
        'friction.static.time_constant': 0.1873409621137062})
    figures = grid(scene, 'drive.velocity=0.0066:0.0070:5').figures(0, 5)
    assert (figures.motion == Motion.STICK_SLIP).all()
    late = simulate_events(load_scene('paper_fig8', {**scene.values, 'drive.velocity': 0.0068}), 100.0).events
    assert sum(event.kind == EventKind.STICK and event.time > 50.0 for event in late) > 100


def test_where_the_slider_only_just_comes_to_rest_the_events_are_those_of_the_reference() -> None:
    """The corner of the grid of docs/maps.md in which scipy misses break-aways."""
    pytest.importorskip('mpmath')
    from stickslip_sim.reference import simulate
    scene = load_scene('paper_fig7', {'drive.velocity': 0.03, 'axis.drive_stiffness': 3e6})
    events = simulate_events(scene, 2.0).events
    expected = simulate(scene.axis, scene.initial, scene.drive, scene.force, 2.0).events
    assert [event.kind for event in events] == [event.kind for event in expected]
    assert sum(event.kind == EventKind.BREAKAWAY for event in events) == 30
    for event, other in zip(events, expected):
        assert event.time == pytest.approx(other.time, abs=1e-12)


# Studies from Python: what the tool finds, without a folder.

SCENE = load_scene('paper_fig7')
KNOWN = {'axis.mass': {'distribution': 'uniform', 'low': 300.0, 'high': 400.0}}


def test_a_sweep_has_the_figures_of_its_study() -> None:
    found = sweep(SCENE, 'drive.velocity=1e-3:1e-1:5:log', 'axis.mass=300.0:400.0:2')
    figures = Study(SCENE.values, EvenGrid((variation('drive.velocity=1e-3:1e-1:5:log'),
                                        variation('axis.mass=300.0:400.0:2')))).figures(0, 10)
    assert list(found.columns)[:3] == ['drive.velocity', 'axis.mass', 'motion']
    assert found.columns['period'].tolist() == pytest.approx(figures.period.tolist(), rel=0, nan_ok=True)
    assert found.motions[0] == 'stick-slip'
    assert found.motions[-1] == 'smooth sliding'


@pytest.mark.parametrize(('solver', 'duration'), [('exact', 20.0), ('exact', None), ('adaptive', 10.0)])
def test_sliding_that_swings_on_is_called_so_as_by_a_run(solver: str, duration: float | None) -> None:
    """By 19 mm/s about the feed of 30 mm/s, for ever, though steady sliding is stable."""
    scene = load_scene('paper_fig8', {'axis.normal_force': 1500.0, 'solver.name': solver})
    found = sweep(scene, 'drive.velocity=0.03:0.0301:2', duration=duration)
    assert found.motions == ['sliding that swings on'] * 2
    assert found.columns['settled'].tolist() == [0.0, 0.0]
    alone = simulate_events(changed(scene, {'drive.velocity': 0.03}), duration or 20.0)
    assert alone.summary.motion == found.motions[0]


def test_points_can_be_drawn() -> None:
    shares: list[float] = []
    found = sweep(SCENE, 'drive.velocity=1e-3:1e-1:log', sobol=8, duration=2.0, progress=shares.append)
    assert len(set(found.columns['drive.velocity'].tolist())) == 8
    assert found.columns['duration'].tolist() == [2.0] * 8
    assert shares[-1] == 1.0


def test_a_sweep_as_a_data_frame() -> None:
    pytest.importorskip('pandas')
    frame = sweep(SCENE, 'drive.velocity=1e-3:1e-1:3:log').frame()
    assert list(frame['motion']) == ['stick-slip', 'stick-slip', 'smooth sliding']


def test_a_critical_value() -> None:
    conventional = load_scene('paper_fig4_falling')
    found = critical(conventional, 'drive.velocity', (1e-3, 1.0), accuracy=1e-3)
    (transition,) = found.from_rest.transitions
    assert 1e-3 < transition.value < 1.0
    with pytest.raises(InputError, match='LOW < HIGH'):
        critical(conventional, 'drive.velocity', (1.0, 1e-3))


def test_uncertainty_of_a_parameter() -> None:
    found = uncertainty(SCENE, KNOWN, samples=16, seed=3)
    assert found == uncertainty(SCENE, KNOWN, samples=16, seed=3)
    assert found.points == 32
    assert found.stick_slip == 1.0
    index = (found.indices['period'] or {})['axis.mass']
    assert math.isfinite(index.first_order)


def test_refused() -> None:
    with pytest.raises(InputError, match='did you mean axis'):
        sweep(SCENE, 'axis.mas=1.0:2.0:3')
    with pytest.raises(InputError, match='given once'):
        sweep(SCENE)
    with pytest.raises(InputError, match='distribution'):
        uncertainty(SCENE, {'axis.mass': 'about 300'})
    with pytest.raises(InputError, match="parameters = 'list' is refused: must be the path of a file, or names with"):
        uncertainty(SCENE, ['axis.mass'])    # type: ignore[arg-type]
