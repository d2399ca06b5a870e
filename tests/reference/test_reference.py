# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The reference simulator against closed forms, the law itself, and its own precision."""

from __future__ import annotations

import json
import math
import random
from decimal import ROUND_UP, Context, Decimal, DefaultContext, Inexact, localcontext
from typing import Any

import pytest

mpmath = pytest.importorskip('mpmath')
from mpmath import mpf  # noqa: E402

from stickslip_sim.reference.exact_run import Run  # noqa: E402
from stickslip_sim.reference.roots import bernstein, first_root  # noqa: E402
from stickslip_sim.reference.series import series, to_binary, to_decimal, working  # noqa: E402
from tests.reference.inclusion import violations  # noqa: E402
from tests.reference.scenes import Parameters, Scene, paper, random_scenes, shipped_scenes  # noqa: E402
from tests.support.stored_objects import exact_run as simulate  # noqa: E402
from tests.support.stored_runs import stored  # noqa: E402


def agrees(number: Any, printed: str | None) -> bool:
    """Compare with a printed figure, to a unit of its last digit (or 3e-16 where it is a double)."""
    if printed is None:
        return True
    mantissa, _, exponent = printed.partition('e')
    digits = len(mantissa.partition('.')[2])
    unit = 10.0 ** (int(exponent or 0) - digits)
    return bool(abs(number - mpf(printed)) <= max(unit, 3e-16 * abs(float(printed))))


# ---- closed forms ---------------------------------------------------------------------------------


def coulomb(
    static: float, kinetic: float, *, stiffness: float = 6e5, damping: float = 0.0, feed: float = 0.005
) -> Parameters:
    """Constant static and kinetic friction, unit normal force."""
    return {
        'axis': {'mass': 350.0, 'drive_stiffness': stiffness, 'drive_damping': damping, 'normal_force': 1.0},
        'contact': {'model': 'rigid'},
        'friction': {
            'static': {'law': 'constant', 'initial': static},
            'kinetic': {'velocities': [0.0], 'coefficients': [kinetic]},
        },
        'drive': [(0.0, feed, 0.0)],
        'force': [(0.0, 0.0, 0.0)],
        'initial': {'position': 0.0, 'velocity': 0.0, 'rest_time': math.inf},
    }


def test_undamped_coulomb_cycle() -> None:
    run = simulate(coulomb(824.0, 412.0), 1.0)
    first, peak, stick, second = run[:4]
    v = mpf(0.005)
    a = mpf(412) / (v * mpmath.sqrt(mpf(6e5) * 350))
    assert [e.kind for e in run[:4]] == ['breakaway', 'decelerate', 'stick', 'breakaway']
    assert abs(second.time - stick.time - 2 * mpf(412) / (mpf(6e5) * v)) < 1e-15
    assert abs(peak.velocity - v * (1 + mpmath.sqrt(1 + a * a))) < 1e-16
    assert agrees(second.time - first.time, '0.3589525')
    assert agrees(second.position - first.position, '1.794762e-3')
    with mpmath.workdps(40):
        omega, a = mpmath.sqrt(mpf(6e5) / 350), mpf(412) / (v * mpmath.sqrt(mpf(6e5) * 350))
        assert abs(stick.time - first.time - 2 / omega * (mpmath.pi - mpmath.atan(a))) < mpf(10) ** -38


def test_damped_slip_with_constant_friction() -> None:
    run = simulate(coulomb(824.0, 412.0, damping=4000.0), 0.5)
    with mpmath.workdps(40):
        omega, v = mpmath.sqrt(mpf(6e5) / 350), mpf(0.005)
        zeta = mpf(4000) / (2 * mpmath.sqrt(mpf(6e5) * 350))
        s, a = mpmath.sqrt(1 - zeta**2), mpf(412) / (v * mpmath.sqrt(mpf(6e5) * 350))
        for tau in (mpf('0.001'), mpf('0.02'), mpf('0.05')):
            sinusoid = mpmath.cos(s * omega * tau) - (a - zeta) / s * mpmath.sin(s * omega * tau)
            exact = v * (1 - mpmath.exp(-zeta * omega * tau) * sinusoid)
            assert abs(run.state_at([run[0].time + tau])[0].velocity - exact) < mpf(10) ** -38


def test_exact_critical_speed() -> None:
    """(ζ/s)[2π - asin ζ - atan((A-ζ)/s)] = ½ ln(1 - 2Aζ + A²): the slip ends just below v_c and not just above."""
    zeta = 0.1
    damping, a_c = 2 * zeta * math.sqrt(6e5 * 350), 1.470118
    critical = 412.0 / (a_c * math.sqrt(6e5 * 350))
    below = simulate(coulomb(824.0, 412.0, damping=damping, feed=critical * (1 - 2e-6)), 1.0)
    above = simulate(coulomb(824.0, 412.0, damping=damping, feed=critical * (1 + 2e-6)), 1.0)
    assert 'stick' in [e.kind for e in below]
    assert 'stick' not in [e.kind for e in above]


def leine_table(count: int, top: float) -> dict[str, list[float]]:
    """1/(1 + 3u) as a table, breakpoints equally spaced in ∫ sqrt(f''), i.e. in (1 + 3u)^(-1/2)."""
    end = (1 + 3 * top) ** -0.5
    speeds = [((1 - k / count * (1 - end)) ** -2 - 1) / 3 for k in range(count + 1)]
    return {'velocities': [0.0, *speeds[1:]], 'coefficients': [1.0] + [1 / (1 + 3 * u) for u in speeds[1:]]}


def leine_times(pieces: int) -> tuple[mpf, mpf]:
    """Return the lengths of slip and stick (m = k = F_s = 1, v = 0.2) with the falling law as a table."""
    parameters = coulomb(1.0, 1.0, stiffness=1.0, feed=0.2)
    parameters['axis']['mass'] = 1.0
    parameters['friction']['kinetic'] = leine_table(pieces, 1.5)
    run = [e for e in simulate(parameters, 18.0, digits=20) if e.kind != 'knot']
    first, stick, second = run[0], run[-2], run[-1]
    assert (first.kind, stick.kind, second.kind) == ('breakaway', 'stick', 'breakaway')
    return stick.time - first.time, second.time - stick.time


def test_leine_cycle() -> None:
    """Leine et al. 1998: the error of the table falls with the square of its pieces; extrapolated."""
    coarse, fine = leine_times(50), leine_times(100)
    slip, stick = ((4 * b - a) / 3 for a, b in zip(coarse, fine))
    assert abs(fine[0] - mpf('4.2959995255')) < 1.5e-4
    assert abs(slip - mpf('4.2959995255')) < 3e-5
    assert abs(stick - mpf('7.7050317694')) < 3e-5
    assert abs(slip + stick - mpf('12.0010312948')) < 3e-5


# ---- numbers --------------------------------------------------------------------------------------


@pytest.mark.parametrize('number', [0.0, 1.0, -0.1, math.pi, 5e-324, -1.7976931348623157e308, 2.0**-200, 3e-25])
def test_numbers_keep_the_working_digits_both_ways(number: float) -> None:
    with working(42):
        third = mpf(number) / 3
        converted = to_decimal(mpf(number))
        for given in (mpf(number), third):
            assert abs(to_binary(to_decimal(given)) - given) <= abs(given) * mpf(10) ** -42
        with localcontext(Context(prec=2000)):
            assert abs(converted - Decimal(number)) <= abs(Decimal(number)) / 10**42


@pytest.mark.parametrize('number', [mpmath.inf, -mpmath.inf, mpmath.nan])
def test_what_is_not_finite_is_refused(number: mpf) -> None:
    with working(42), pytest.raises(ValueError, match='finite'):
        to_decimal(number)


def test_the_default_context_of_decimal_has_no_say(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = [(e.kind, e.time) for e in simulate(coulomb(824.0, 412.0), 0.2, 20)]
    for name, value in {'rounding': ROUND_UP, 'Emin': -9, 'Emax': 9}.items():
        monkeypatch.setattr(DefaultContext, name, value)
    monkeypatch.setitem(DefaultContext.traps, Inexact, True)
    with mpmath.workdps(60):
        assert [(e.kind, e.time) for e in simulate(coulomb(824.0, 412.0), 0.2, 20)] == usual


# ---- root search ----------------------------------------------------------------------------------


@pytest.mark.parametrize('depth', ['1e-4', '1e-12', '1e-24'])
def test_grazing_minimum_is_found_and_a_miss_is_not(depth: str) -> None:
    """(τ - 0.3)² ∓ depth: two near roots, or none."""
    with working(60):
        d = mpf(depth)
        centre = mpf(3) / 10
        touch = series(centre**2 - d, -2 * centre, mpf(1))
        miss = series(centre**2 + d, -2 * centre, mpf(1))
        assert abs(first_root(touch, mpf(1), mpf(1), mpf(1)) - (centre - mpmath.sqrt(d))) < mpf(10) ** -45
        assert first_root(miss, mpf(1), mpf(1), mpf(1)) is None


@pytest.mark.parametrize('digits', [20, 40])
def test_an_acceleration_that_touches_zero_is_no_event_however_long_the_run(digits: int) -> None:
    """An undamped axis without friction under a ramp of the feed: 1 - cos ωt, zero at each of 46 periods."""
    parameters = coulomb(0.0, 0.0, feed=0.0)
    parameters['axis']['normal_force'] = 0.0
    parameters['drive'] = [(0.0, 0.0, 1e-9)]
    assert [event.kind for event in simulate(parameters, 7.0, digits)] == ['breakaway']


@pytest.mark.parametrize(('contact', 'normal_force', 'coefficient'), [
    ('rigid', 1.0, 824.0), ('rigid', 1.0, 1e-20), ('rigid', 1.0, 0.0), ('rigid', 0.0, 1.0),
    ('compliant', 1.0, 0.0), ('compliant', 0.0, 1.0),
])
def test_a_speed_that_touches_zero_is_a_stick_in_any_precision(
    contact: str, normal_force: float, coefficient: float
) -> None:
    """Undamped, with as much friction in motion as at rest: v (1 - cos ωt), however light the friction."""
    parameters = coulomb(coefficient, coefficient)
    parameters['axis']['normal_force'] = normal_force
    if contact == 'compliant':
        parameters['contact'] = {'model': 'compliant', 'stiffness': 5e6, 'damping': 0.0}
    for digits in (20, 25, 30, 40):
        events = simulate(parameters, 0.5, digits)
        assert [(e.kind, e.direction) for e in events[:5]] == [
            (kind, 1) for kind in ('breakaway', 'decelerate', 'stick', 'breakaway', 'decelerate')
        ][:len(events)]
        with mpmath.workdps(60):
            period = 2 * mpmath.pi / mpmath.sqrt(mpf(6e5) / 350)
            assert abs(events[2].time - events[0].time - period) < mpf(10) ** -digits


def test_bernstein_coefficients_of_a_parabola() -> None:
    assert bernstein([1, 2, 4]) == [1, 2, 7]


# ---- the law itself, rules at the edges ---------------------------------------------------------------


def random_times(scene: Scene, run: Run, n: int) -> list[float]:
    rng = random.Random(scene.name)
    near = [float(e.time) + side for e in run[:8] for side in (-1e-9, 1e-9)]
    return [t for t in [rng.random() * scene.duration for _ in range(n)] + near if 0 < t < scene.duration]


@pytest.mark.parametrize('index', [6, 30, 45])
def test_random_scene_keeps_the_set_valued_law(index: int) -> None:
    scene = random_scenes()[index]
    run = simulate(scene.parameters, scene.duration)
    times = random_times(scene, run, 25)
    assert violations(run, scene.parameters, times) == []
    wrong = {**scene.parameters, 'axis': {**scene.parameters['axis'], 'mass': scene.parameters['axis']['mass'] * 1.001}}
    assert violations(run, wrong, times) != []


def test_mirror_image_gives_mirrored_events() -> None:
    there = simulate(paper(contact='compliant'), 1.0)
    back = simulate(paper(contact='compliant', velocity=-0.002), 1.0)
    with mpmath.workdps(60):
        assert [(e.kind, e.direction, e.time, e.position) for e in there] == [
            (e.kind, -e.direction, e.time, -e.position) for e in back
        ]


def test_start_beyond_the_limit_breaks_away_at_once() -> None:
    parameters = paper()
    parameters['force'] = [(0.0, 2000.0, 0.0)]
    first = simulate(parameters, 0.2)[0]
    assert (first.kind, first.time, first.direction) == ('breakaway', 0, 1)


def test_a_contact_without_a_normal_force_gives_way_at_once() -> None:
    """However little it is pushed beside what the damper of the drive would do."""
    parameters = coulomb(1.0, 1.0, stiffness=1e8, damping=2e14, feed=-5000.0)
    parameters['axis'] |= {'mass': 0.0003, 'normal_force': 0.0}
    parameters['contact'] = {'model': 'compliant', 'stiffness': 22000.0, 'damping': 0.0}
    first = simulate(parameters, 1e-16, 30)[0]
    assert (first.kind, first.time, first.direction) == ('breakaway', 0, -1)


def test_initial_velocity_is_a_slip_without_excess() -> None:
    parameters = paper()
    parameters['initial']['velocity'] = 0.01
    first = simulate(parameters, 0.2)[0]
    assert first.kind == 'stick'


def test_steady_sliding_stays() -> None:
    """R = 0 at ẋ = v with E = 0: F_d = 0 and F_e = N mu_k."""
    parameters = coulomb(2.0, 1.0, damping=100.0)
    parameters['initial']['velocity'] = 0.005
    parameters['force'] = [(0.0, 1.0, 0.0)]
    run = simulate(parameters, 10.0)
    assert run == []
    assert run.state_at([10.0])[0].velocity == mpf(0.005)


@pytest.mark.parametrize('exponent', [0.4, 1.0, 2.5])
def test_kato_with_unit_exponent_is_exponential(exponent: float) -> None:
    """The limit is reached where |F| = N mu_s, with any exponent; with 1 both laws agree."""
    parameters = paper()
    parameters['friction']['static'] |= {'law': 'kato', 'exponent': exponent}
    run = simulate(parameters, 1.5)
    again = run[4]
    rise = 1 - mpmath.exp(-((again.rest_time / mpf(0.2)) ** mpf(exponent)))
    limit = mpf(3432.3275) * (mpf(0.12) + (mpf(0.24) - mpf(0.12)) * rise)
    assert again.kind == 'breakaway'
    assert abs(again.drive_force - limit) < 1e-12
    if exponent == 1.0:
        assert abs(again.time - simulate(paper(), 1.5)[4].time) < mpf(10) ** -38


def test_result_does_not_depend_on_the_working_precision() -> None:
    scene = random_scenes()[31]
    low, high = (simulate(scene.parameters, scene.duration, digits=d) for d in (30, 45))
    assert [e.kind for e in low] == [e.kind for e in high]
    assert max(abs(a.time - b.time) for a, b in zip(low, high)) < mpf(10) ** -26


# ---- the paper's data: first events, static coefficients and limit cycles, digit by digit ---------------

# kind, t, x, velocity, drive force: every digit counts
RIGID = [
    ('breakaway', '0.67979883333333', '0', '0', '823.7586'),
    ('coast', '0.76770114503556598', '5.3092642091498e-4', '1.45614975366e-2', '552.439531347'),
    ('decelerate', '0.79961346115854196', '9.9561753352655e-4', '1.45614975366e-2', '311.919643128'),
    ('stick', '0.83862368925988008', '1.3615322557025e-3', '0', '197.42907369'),
    ('breakaway', '1.3313467055455221', '1.3615322557025e-3', '0', '788.696693233'),
    ('coast', '1.4173257894649382', '1.8213175147126e-3', '1.26694996285e-2', '565.322440017'),
]
COMPLIANT = [
    ('breakaway', '0.76256755048235998', '1.6410886285782e-4', '2.14285714061e-4', '823.758600008'),
    ('coast', '0.850707630222697', '6.6535579038665e-4', '1.34355898952e-2', '575.893322454'),
    ('decelerate', '0.88805371587200703', '1.1671224813629e-3', '1.34355898952e-2', '319.648610648'),
    ('stick', '0.92738519742899923', '1.5072615660044e-3', '0', '216.505297312'),
    ('breakaway', '1.4463032091159095', '1.5828430395267e-3', '2.14282328562e-4', '793.000897909'),
    ('accelerate', '1.4463032134383819', '1.582843040453e-3', '2.14282328562e-4', '793.00090254'),
]
CONVENTIONAL = [
    ('breakaway', '0.67979883333333', '0', '0', None),
    ('knot', '0.7158107683398723', '7.2167822270819e-4', '0.035', None),
    ('decelerate', None, None, None, None),
    ('knot', '0.72765171843402951', None, '0.035', None),
    ('stick', '0.75893741627714234', '1.801901429588e-3', '0', '-162.41595822'),
    ('breakaway', '1.5749466192221413', None, '0', None),
]


def assert_events(run: Run, expected: list[tuple[str, str | None, str | None, str | None, str | None]]) -> None:
    for event, (kind, *figures) in zip(run, expected):
        found = (event.time, event.position, event.velocity, event.drive_force)
        assert event.kind == kind
        assert [agrees(a, b) for a, b in zip(found, figures)] == [True] * 4, (kind, found)


@pytest.mark.parametrize(
    ('parameters', 'expected'),
    [(paper(), RIGID), (paper(contact='compliant'), COMPLIANT), (paper(dependence=False), CONVENTIONAL)],
    ids=['rigid', 'compliant', 'conventional'],
)
def test_first_events_of_the_paper_data(parameters: Parameters, expected: list[Any]) -> None:
    assert_events(simulate(parameters, 1.65), expected)


def test_static_coefficients_of_the_paper_data() -> None:
    found = {
        'rigid': simulate(paper(), 1.4)[4].static_coefficient,
        'compliant': simulate(paper(contact='compliant'), 1.45)[4].static_coefficient,
        'conventional': simulate(paper(dependence=False), 1.6)[5].static_coefficient,
    }
    assert agrees(found['rigid'], '0.2297848')
    assert agrees(found['compliant'], '0.23103882')
    assert agrees(found['conventional'], '0.2379712')


@pytest.mark.parametrize(
    ('name', 'period', 'jump', 'peak', 'force', 'stick_force'),
    [
        ('paper_fig7', '0.619075168', '1.238150336e-3', '1.23285921663e-2', '781.443710909', '235.301790949'),
        ('paper_fig8', '0.659065697', '1.31813139e-3', '1.16642823367e-2', '788.081203029', '246.606758267'),
    ],
)
def test_limit_cycles_of_the_paper_data(
    name: str, period: str, jump: str, peak: str, force: str, stick_force: str
) -> None:
    events = stored()[name]['events']

    def last(kind: str, column: str) -> list[Any]:
        return [mpf(x) for k, x in zip(events['kind'], events[column]) if k == kind][-2:]

    times, places = last('breakaway', 'time'), last('breakaway', 'position')
    assert agrees(times[1] - times[0], period)
    assert agrees(places[1] - places[0], jump)
    assert agrees(last('coast', 'velocity')[1], peak)
    assert agrees(last('breakaway', 'drive_force')[1], force)
    assert agrees(last('stick', 'drive_force')[1], stick_force)


# ---- the stored runs: what the reference computes today, of the scenes as they are ---------------------


def test_stored_data_is_not_stale() -> None:
    data = stored()['random_2026_6']
    run, events = simulate(data['parameters'], data['duration']), data['events']
    assert [e.kind for e in run] == events['kind']
    for column in ('time', 'position', 'velocity', 'drive_force'):
        assert [mpmath.nstr(getattr(e, column), 25) for e in run] == events[column]


def test_stored_runs_are_of_the_shipped_scenes_as_they_are() -> None:
    """Else: python -m tests.reference.make_data --only NAME."""
    for scene in shipped_scenes():
        assert stored()[scene.name]['duration'] == scene.duration
        assert json.loads(json.dumps(scene.parameters)) == stored()[scene.name]['parameters'], scene.name


def test_stored_data_holds_enough() -> None:
    names = list(stored())
    assert len([n for n in names if n.startswith('random')]) >= 40
    assert {'paper_fig7', 'paper_fig8', 'conventional_rigid', 'A', 'B', 'C', 'D'} <= set(names)
