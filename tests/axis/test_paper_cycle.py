# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's axis from mode to mode, at the times that 40-digit arithmetic found for its events.

Nothing is searched here: each mode is begun, moved by the time that it takes, and ended.  The numbers are those of the
paper's data with N = 350 · 9.80665 N, v = 2 mm/s, tau = 0.2 s, from prolonged rest.
"""

import math

import pytest

from stickslip_sim.axis import pack, rows
from stickslip_sim.axis.codes import ACCELERATE, COAST, DECELERATE
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.mode_entry import rest
from stickslip_sim.axis.motion import begin_motion, move_start
from stickslip_sim.axis.rows import EventRow
from stickslip_sim.axis.state_record import State
from stickslip_sim.axis.transitions import arrest, cross_breakpoint, leave_coast, release, turn
from tests.support.axes import COMPLIANT, RIGID, Contact, paper_axis
from tests.support.plain_axes import state

# how it ends, when in s, x in m, ẋ in m/s, F_d in N
Line = tuple[str, float, float, float, float]
RIGID_CYCLE: list[Line] = [
    ('release', 0.67979883333333, 0.0, 0.0, 823.7586),
    ('turn', 0.76770114503556598, 5.3092642091498e-4, 1.45614975366e-2, 552.439531347),
    ('slow down', 0.79961346115854196, 9.9561753352655e-4, 1.45614975366e-2, 311.919643128),
    ('arrest', 0.83862368925988008, 1.3615322557025e-3, 0.0, 197.42907369),
    ('release', 1.3313467055455221, 1.3615322557025e-3, 0.0, 788.696693233),
    ('turn', 1.4173257894649382, 1.8213175147126e-3, 1.26694996285e-2, 565.322440017)]
COMPLIANT_CYCLE: list[Line] = [
    ('release', 0.76256755048235998, 1.6410886285782e-4, 2.14285714061e-4, 823.758600008),
    ('turn', 0.850707630222697, 6.6535579038665e-4, 1.34355898952e-2, 575.893322454),
    ('slow down', 0.88805371587200703, 1.1671224813629e-3, 1.34355898952e-2, 319.648610648),
    ('arrest', 0.92738519742899923, 1.5072615660044e-3, 0.0, 216.505297312),
    ('release', 1.4463032091159095, 1.5828430395267e-3, 2.14282328562e-4, 793.000897909),
    ('speed up', 1.4463032134383819, 1.582843040453e-3, 2.14282328562e-4, 793.00090254)]
CONVENTIONAL_CYCLE: list[Line] = [
    ('release', 0.67979883333333, 0.0, 0.0, 823.7586),
    ('cross', 0.7158107683398723, 7.2167822270819e-4, 0.035, math.nan),
    ('peak', math.nan, math.nan, math.nan, math.nan),
    ('cross', 0.72765171843402951, math.nan, 0.035, math.nan),
    ('arrest', 0.75893741627714234, 1.801901429588e-3, 0.0, -162.41595822),
    ('release', 1.5749466192221413, 1.801901429588e-3, 0.0, math.nan)]


def begun(contact: Contact, *, branches: bool) -> tuple[Parameters, State]:
    """Return the axis at time 0, at rest."""
    p, s = Parameters(pack(paper_axis(contact, branches=branches))), state(v=2e-3)
    rest(p, s)
    s.rest = math.inf
    s.acceleration = 4000.0 * 2e-3 / 350.0 if p.compliant else 0.0     # h v is all that acts
    begin_motion(p, s)
    return p, s


def end(p: Parameters, s: State, how: str) -> EventRow:
    """End the mode, and begin the one that follows."""
    events = rows.Events(1)
    if how == 'cross':
        cross_breakpoint(p, s, events, 0, s.acceleration)
    elif how == 'speed up':
        leave_coast(p, s, events, 0, ACCELERATE)
    elif how == 'slow down':
        leave_coast(p, s, events, 0, DECELERATE)
    else:
        {'release': release, 'arrest': arrest, 'turn': turn, 'peak': turn}[how](p, s, events, 0)
    begin_motion(p, s)
    return events.rows[0]


def time_of_peak(s: State) -> float:
    """Return the time up to the peak of the speed beyond v_gr, where friction is constant and ẍ a damped sine."""
    gamma, omega2 = 4000.0 / (2.0 * 350.0), 6e5 / 350.0
    nu = math.sqrt(omega2 - gamma * gamma)
    jerk = omega2 * (2e-3 - s.velocity) - 2.0 * gamma * s.acceleration
    # ẍ = e^(−γ t) (a cos ν t + (j + γ a)/ν sin ν t), with j the jerk at the crossing
    return math.atan2(-s.acceleration * nu, jerk + gamma * s.acceleration) % math.pi / nu


@pytest.mark.parametrize(('contact', 'branches', 'cycle'), [
    (RIGID, True, RIGID_CYCLE), (COMPLIANT, True, COMPLIANT_CYCLE), (RIGID, False, CONVENTIONAL_CYCLE)],
    ids=['rigid', 'compliant', 'conventional'])
def test_the_axis_of_the_paper_goes_from_mode_to_mode(contact: Contact, branches: bool, cycle: list[Line]) -> None:
    p, s = begun(contact, branches=branches)
    now = 0.0
    for how, time, position, velocity, force in cycle:
        if how == 'peak':
            time = now + time_of_peak(s)
        move_start(p, s, 0.0, time, time - now)
        assert s.drive == pytest.approx(2e-3 * time, rel=1e-13)
        row, now = end(p, s, how), time
        for name, found, expected in (('x', row.position, position), ('ẋ', row.velocity, velocity),
                                      ('F_d', row.drive_force, force)):
            assert math.isnan(expected) or found == pytest.approx(expected, rel=3e-10, abs=1e-12), (how, name)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT], ids=['rigid', 'compliant'])
def test_friction_and_rest_time_of_the_first_cycle(contact: Contact) -> None:
    """mu_s = 0.24, then what half a second of rest gives; friction is continuous from the break-away on."""
    p, s = begun(contact, branches=True)
    cycle = RIGID_CYCLE if contact == RIGID else COMPLIANT_CYCLE
    now, found = 0.0, []
    for how, time, *_ in cycle[:5]:
        move_start(p, s, 0.0, time, time - now)
        found.append(end(p, s, how))
        now = time
    first, coasts, slows, arrests, second = found
    normal = 350 * 9.80665
    assert (first.static, first.friction) == pytest.approx((0.24, 0.24 * normal), rel=1e-14)
    assert first.rest == math.inf
    assert coasts.kind == COAST
    assert coasts.friction == pytest.approx(coasts.drive_force, rel=1e-9)
    assert slows.friction == pytest.approx(normal * (0.12 - 2.0 * slows.velocity), rel=1e-9)
    assert arrests.friction == pytest.approx(0.12 * normal, rel=1e-14)
    assert second.rest == pytest.approx(cycle[4][1] - cycle[3][1], rel=1e-12)
    assert second.static == pytest.approx(0.2297848 if contact == RIGID else 0.23103882, rel=1e-7)
