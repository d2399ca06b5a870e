# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A slice of the attack on the engine, and that each of its judges can fail.  `make hostile` attacks for longer."""

import math
import random
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.proof.judges import Find
from tests.hostile.attack import Counts, Found, judge_again, one_round, read, write
from tests.hostile.case import Case, Run, Undecided, Values, run
from tests.hostile.generators import GENERATORS, draw
from tests.hostile.judges import JUDGES, brute, guards, reference

pytestmark = pytest.mark.slow

RNG = random.Random(0)
CASE = Case(draw.paper() | draw.constant(0.002), 3.0)
TOUCHING = Case(draw.axis(350.0, 6e5, 0.0, 3432.3275) | draw.contact(5e6, 0.0) | draw.static(0.12)
                | draw.kinetic([0.0], [0.12]) | draw.constant(0.0)
                | {'initial.velocity': 0.1, 'initial.rest_time': 0.0}, 1.0)
KATO = (draw.paper() | draw.contact(5e6, 15000.0)
        | draw.static(0.12, 0.12000001110800634, 70.98870335904223, 'kato', 0.9904340921138295)
        | draw.kinetic([0.0, 0.035], [0.12, 0.05], branches=True) | draw.constant(0.006978529282690192)
        | {'initial.rest_time': 0.001})

# what only rounding of the data decides, each with the seconds to run it and the event that it decides
ROUNDING = {
    'coasting in a thin band': (
        draw.axis(350.0, 24887095.86501167, 93329.97135301224, 3432.3275)
        | draw.contact(199096766.92009336, 263977.0225266447)
        | draw.static(0.33840202163103306, 0.3384020219694351, 0.10675718973292454)
        | draw.kinetic([0.0, 1.494939476299893e-06, 0.007354503689041886],
                       [0.33840202163103306, 0.3384020191120692, 0.33839268284750085], branches=True)
        | draw.constant(0.001175453461710623), 0.156, 14),
    'a drive that turns with the force on the limit': (
        draw.axis(1.0, 96.04318947087962, 0.0, 9.80665) | draw.contact() | draw.static(0.635)
        | draw.kinetic([0.0], [0.635])
        | {'friction.static.backward.initial': 0.0, 'friction.kinetic.backward.coefficients': [0.0]}
        | draw.steps('drive', 'velocities', [0.0, 0.11195091109888311], [0.25771644732135, -0.25771644732135])
        | {'drive.period': 0.22390182219776622}, 0.23, 0),
    'a stop without acceleration': (
        draw.axis(11263.317678828129, 99930437.14051418, 0.0, 152160.13762930935) | draw.contact() | draw.static(0.66)
        | draw.kinetic([0.0], [0.5])
        | {'friction.static.backward.initial': 0.0, 'friction.kinetic.backward.coefficients': [0.0]}
        | draw.steps('drive', 'velocities', [0.0, 0.05919900698385758], [0.0, -0.06912301661272699])
        | {'initial.stretch': -0.0006377745895225377}, 0.16, 5),
}

# what the attack, and audits before it, found wrong: each with the seconds to run it
KNOWN = {
    'a steep fall overflows': (
        draw.axis(1.0, 2.0, 0.0, 1.0) | draw.contact() | draw.static(1.5)
        | draw.kinetic([0.0, 0.00273], [1.5, 1.0]) | draw.constant(0.1), 60.0),
    'a step underflows near critical damping': (
        draw.paper(**{'axis.drive_damping': 28982.753})
        | draw.kinetic([0.0, 0.001, 0.003, 0.01, 0.035], [0.12, 0.12, 0.12, 0.12, 0.05])
        | draw.constant(0.0286, -300.0), 1.0),
    'psi ends right behind the break-away': (
        draw.paper() | draw.contact(5e6, 15000.0) | draw.kinetic([0.0, 0.035], [0.12, 0.05], branches=True)
        | {'friction.excess.velocities': [0.0, 0.00021428571427], 'friction.excess.fractions': [1.0, 0.0]}
        | draw.constant(0.002), 1.2),
    'a fast fade ends in a falling segment': (
        draw.axis(1.0, 0.0, 0.0, 1.0) | draw.contact() | draw.static(0.1)
        | draw.kinetic([0.0, 1e-6], [0.1, 0.001], 1e9) | draw.constant(0.0)
        | {'initial.velocity': 1000.0, 'initial.rest_time': 0.0}, 1.0),
    'a contact that swings without loss touches its limit': (TOUCHING.values, TOUCHING.duration),
    'inputs jump just before a standstill': (
        draw.axis(1645.171484711213, 1366171.24229858, 0.0, 16133.620940543216)
        | draw.contact(2991554.454609089) | draw.static(0.9747166831802524, 1.2293964031446205, 0.0024)
        | draw.kinetic([0.0, 0.00014838233998598884], [0.8898629567849358, 0.5017861868224635])
        | draw.steps('drive', 'velocities', [0.0, 4.985474025992694e-06], [-2.3909339958413123e-05, 0.0])
        | draw.steps('force', 'forces', [0.0, 4.985474025992694e-06], [5951.615297993354, -25499.80368371414])
        | {'initial.velocity': 2.3909339958413123e-05, 'initial.rest_time': 0.0}, 1.0),
    'inputs jump 3e-16 s behind a breakpoint': (
        draw.axis(10842.618240937254, 3909994.376985498, 0.0, 106329.76217248732) | draw.contact()
        | draw.static(0.414685514075227)
        | draw.kinetic([0.0, 0.04006154993181895], [0.4017584183515003, 0.3032136640736198])
        | draw.steps('drive', 'velocities', [0.0, 5.474463056003837], [0.00170958991821635, 0.0034191798364327])
        | draw.steps('force', 'forces', [0.0, 5.474463056003837], [8237.754924945439, -79949.06925104363]), 6.0),
    'a contact damper leaves no digits of a free motion': (
        draw.axis(4.64e-5, 111.0, 0.0, 0.0024) | draw.contact(1.22e11, 4e13) | draw.static(2.46e-6, 3.16e-4, 0.0024)
        | draw.kinetic([0.0], [2.46e-6], 6.7e-9) | draw.constant(-3e5, 1.85e-8), 1e-3),
    'a contact has rung for 6e12 rad when it breaks away': (
        draw.axis(0.00010022608670339883, 3032835609.206795, 2.072837170140976e-06, 380584646086039.75)
        | draw.contact(2.195934537987053e+16) | draw.static(5.793267347457344)
        | draw.kinetic([0.0, 11.84509070112242], [5.793267347457344, 2.7749957786770683])
        | draw.constant(-1791.6329384264484), 830.0),
    'no damper anywhere under a ramp away from a side that holds nothing': (
        draw.axis(88.37409450229083, 65196271.5573849, 0.0, 447.20364453557835) | draw.contact(499668931.7451392)
        | draw.static(0.731345904128406, 1.4730985940752366, 0.10383028427939264, 'hyperbolic')
        | draw.kinetic([0.0, 0.0006233869652845942], [0.731345904128406, 0.3921349202309617])
        | {'friction.static.backward.initial': 0.0, 'friction.static.backward.limit': 0.0,
           'friction.kinetic.backward.coefficients': [0.0, 0.0], 'drive.course': 'ramp',
           'drive.acceleration': 0.0007310528496116081}, 0.5),
    "Kato's law all but exponential, from an arrest on its limit": (KATO, 2.0),
    'mu_s waits for 13 ps': (
        draw.axis(11.799584113343863, 5112853.415158913, 2256.4520231740685, 73.96390721626602) | draw.contact()
        | draw.static(0.8689223977642208, 0.9092787578147266, 0.20686718395072204)
        | draw.kinetic([0.0, 0.0035394194975010124], [0.8689223977642208, 0.5249314697124853], branches=True)
        | draw.constant(-0.001424813853457483, -24.36896357165652)
        | {'friction.static.delay': 1.3100050399632882e-11, 'initial.velocity': -0.001424813853457483,
           'initial.rest_time': 0.0}, 0.29505057499772314),
    'a force on a limit that waits, and moves on': (
        draw.axis(2.0, 4.0, 1.0, 8.0) | draw.contact() | draw.static(0.25, 0.5, 0.5) | draw.kinetic([0.0], [0.25])
        | draw.constant(0.0, -2.0) | {'axis.damper': 'slideway', 'friction.static.delay': 1.5, 'drive.course': 'ramp',
                                      'drive.acceleration': -3.0, 'initial.rest_time': 0.0}, 3.0),
    'a rest that begins a last bit beyond its delay of hours': (
        draw.axis(20424.671705516645, 9339414764.468754, 0.0, 200297.60678090478)
        | draw.contact(12038283639.701122) | draw.static(0.7857669235010063, 1.2975801128561235, 0.06232322983494321)
        | draw.kinetic([0.0, 0.00022206069658608536], [0.7857669235010063, 0.349438724250315])
        | draw.constant(0.00031070307959729963, -49770.195483764175)
        | {'friction.static.delay': 74495.24881522506, 'initial.rest_time': 74495.24881522507}, 0.3),
    'a breakpoint at which friction is so steep that its speed says the time to 1 ns': (
        draw.axis(1.0, 11042.748312913618, 0.0, 9.80665) | draw.contact() | draw.static(0.6364111565212552)
        | draw.kinetic([0.0, 0.0003903367743122229, 0.00039033692996265406],
                       [0.6364111565212552, 0.636411138952865, 0.9546167347818828])
        | draw.constant(0.00022595791444022452), 2.72),
    "Kato's law all but exponential under a sinusoid": (
        KATO | {'drive.amplitudes': [0.0005], 'drive.frequencies': [3.0], 'drive.phases': [0.1]}, 1.0),
}


@pytest.fixture(scope='module')
def good() -> Run:
    return run(CASE.parts)


def changed(good: Run, at: int, **changes: Any) -> Run:
    """Return the run with an event changed; every border but the last is at its end."""
    events, end = good.stretches[0]
    return good._replace(stretches=[([*events[:at], events[at]._replace(**changes), *events[at + 1:]], end)])


def without(good: Run, *gone: int) -> Run:
    """Return the run without some events."""
    events, end = good.stretches[0]
    return good._replace(stretches=[([e for k, e in enumerate(events) if k not in gone], end)])


@pytest.mark.parametrize('generator', GENERATORS)
def test_nothing_is_found_wrong(generator: str) -> None:
    found = one_round('slice', Counts(), [generator], count=4, share=0.0)
    assert not found, '\n'.join(f'{one.judge}: {one.text}' for one in found)


@pytest.mark.parametrize('name', KNOWN)
def test_a_scene_that_was_judged_wrong_is_right(name: str) -> None:
    values, duration = KNOWN[name]
    assert judge_again(Case(values, duration), name, reference_too=False) == []


def test_static_friction_that_grows_at_another_pace_backwards_has_its_mirror() -> None:
    values = (
        draw.axis(0.3288631327083222, 75.96179940463232, 3.559400307358461, 0.634053678166018)
        | draw.contact(14484.959926784997, 207.05584678557912)
        | draw.static(0.4465107385689329, 1.0847314600674487, 0.0010919341287886721, 'hyperbolic')
        | draw.kinetic([0.0, 0.0014016217145850442], [0.4465107385689329, 0.20766323124768016])
        | {'friction.static.backward.initial': 0.0, 'friction.static.backward.limit': 0.0,
           'friction.static.backward.time_constant': 0.005870751414489745,
           'friction.static.delay': 0.018327716641371044, 'friction.kinetic.backward.coefficients': [0.0, 0.0],
           'friction.kinetic.backward.end_slope': 0.0, 'normal_load.course': 'table',
           'normal_load.times': [0.0, 2.65536484021828, 4.0112716121144105],
           'normal_load.forces': [0.0, -0.14150061307215842, -0.4134769168690229],
           'normal_load.period': 5.0032182166500725, 'initial.stretch': -0.009054261187449158}
        | {'force.course': 'constant', 'force.constant': 0.10391245435299258}
        | draw.steps('drive', 'velocities', [0.0, 1.3256421049903107, 3.7643910571801076],
                     [0.0, 0.0008935195261258836, 0.0]))
    JUDGES['images'](run(Case(values, 3.6).parts), RNG)


def test_a_good_run_passes_every_judge() -> None:
    assert judge_again(CASE, 'good') == []


@pytest.mark.parametrize(('values', 'time'), [
    (draw.axis(0.00022014883903248228, 1721685.3950933928, 26069555372686.043, 9.851792463275056e-08)
     | draw.contact(0.00028203416586925975, 0.029887747675971698) | draw.static(0.020383594601269636)
     | draw.kinetic([0.0, 0.03], [0.020383594601269636, 0.02])
     | draw.constant(-0.0004349433786457962, 36232.958778810345), 1.3046313973565834e-21),
    (draw.axis(0.00017559494300188863, 0.0, 1095715766076.7305, 0.016653874911793685)
     | draw.contact(223496462.78035644) | draw.static(1.035499518042733e-05)
     | draw.kinetic([0.0], [1.035499518042733e-05]) | draw.constant(-246705.3512867859), 1.0022648210915373e-18)],
    ids=['2e-9 N beside 1e10 N', '2e-7 N beside 3e17 N'])
def test_a_contact_that_holds_little_beside_the_drive_breaks_away_in_time(values: Values, time: float) -> None:
    case = Case(values, 9.518786489179013e-15)
    assert run(case.parts).events[0].fraction == pytest.approx(time, rel=1e-14, abs=0.0)
    reference.judge(run(case.parts))


def test_the_same_seed_makes_the_same_scenes() -> None:
    for make in GENERATORS.values():
        assert make(random.Random('again')).values == make(random.Random('again')).values


def test_a_missed_event_is_seen(good: Run) -> None:
    events = good.stretches[0][0]
    crossing = next(k for k, e in enumerate(events) if e.kind == EventKind.KNOT)
    assert any('breakpoint' in text and 'passed' in text for text in guards.judge([without(good, crossing)])[0])
    stick = next(k for k, e in enumerate(events) if e.kind == EventKind.STICK)
    assert any('standstill was passed' in text for text in guards.judge([without(good, stick)])[0])
    assert any('static limit was passed' in text for text in guards.judge([good._replace(stretches=[
        ([], good.stretches[0][1]._replace(mode=Mode.STICK, position=0.0, velocity=0.0))])])[0])


@pytest.mark.parametrize('later', [-1e-10, 1e-10])
def test_an_event_at_another_time_is_seen(good: Run, later: float) -> None:
    for k, event in enumerate(good.stretches[0][0]):
        assert guards.judge([changed(good, k, fraction=event.fraction + later)])[0], event


def test_another_state_is_seen(good: Run) -> None:
    for k, event in enumerate(good.stretches[0][0]):
        for name in ('position', 'velocity', 'drive_force'):
            value = getattr(event, name)
            other = value * (1.0 + 1e-9) if value else 1e-9
            assert guards.judge([changed(good, k, **{name: other})])[0], (name, event)


def test_an_invented_event_is_seen(good: Run) -> None:
    events, end = good.stretches[0]
    invented = events[0]._replace(fraction=events[0].fraction - 0.1, drive_force=events[0].drive_force - 120.0)
    assert guards.judge([good._replace(stretches=[([invented, *events], end)])])[0]


@pytest.mark.parametrize('closure', [{'contact.arrest': 'undeflected'}, {'contact.break_away': 'drive_force'},
                                     {'friction.static.delay': 0.1}, {'axis.damper': 'slideway'}], ids=repr)
def test_another_closure_is_seen(closure: Values) -> None:
    values = CASE.values | draw.contact(5e6, 15000.0) | draw.constant(0.02)   # breaks away while the contact rings
    usual, other = run(Case(values, 1.0).parts), run(Case(values | closure, 1.0).parts)
    assert guards.judge([usual, other]) == [[], []]
    assert guards.judge([usual._replace(parts=other.parts)])[0]
    assert guards.judge([other._replace(parts=usual.parts)])[0]


def test_a_graze_between_samples_is_seen() -> None:
    # the force peaks 1e-9 above the limit, for 6e-5 s
    peak = 0.24 * 3432.3275 * (1.0 + 1e-9)
    values = draw.paper(**{'axis.drive_damping': 0.0, 'drive.course': 'ramp', 'drive.velocity': 2.0 * peak / 6e5,
                           'drive.acceleration': -2.0 * peak / 6e5})
    done = run(Case(values, 1.7).parts)
    assert done.size > 0
    still = done.start._replace(second=1.0, fraction=0.7, drive_force=peak * (1.0 - 0.49))
    assert any('static limit was passed' in text for text in guards.judge([done._replace(
        stretches=[([], still)])])[0])


def test_other_bits_are_seen(good: Run) -> None:
    k = len(good.stretches[0][0]) - 1
    bent = changed(good, k, position=good.stretches[0][0][k].position * (1.0 + 2.0 ** -52))
    for judge in ('images', 'parts'):
        with pytest.raises(Find):
            JUDGES[judge](bent, RNG)
    with pytest.raises(Find):
        JUDGES['batch'](changed(good, k, velocity=1.0)._replace(
            parts=good.parts._replace(drive=constant(0.003))), RNG)


def test_a_speed_and_an_energy_without_a_source_are_seen(good: Run) -> None:
    with pytest.raises(Find, match='speed'):
        JUDGES['bounds'](changed(good, 3, velocity=3.8e98), RNG)
    with pytest.raises(Find, match='energy'):
        JUDGES['bounds'](good._replace(
            energy=good.energy._replace(friction_loss=good.energy.friction_loss + 1e-6)), RNG)


@pytest.mark.parametrize(('at', 'changes', 'text'), [
    (1, {'position': math.nan}, 'not finite'), (1, {'mode': Mode.STICK}, 'leads from'),
    (2, {'direction': -1}, 'goes -1'), (2, {'velocity': -0.01}, 'at -0.01 m/s'), (3, {'fraction': 0.1}, 'back'),
    (3, {'fraction': 1.0}, 'back')])
def test_an_order_that_cannot_be_is_seen(good: Run, at: int, changes: Values, text: str) -> None:
    with pytest.raises(Find, match=text):
        JUDGES['order'](changed(good, at, **changes), RNG)
    with pytest.raises(Find, match='ends in'):
        JUDGES['order'](good._replace(stretches=[(good.events, good.start._replace(mode=Mode.YIELDING))]), RNG)


def test_a_break_away_at_a_touch_is_seen() -> None:
    done = run(TOUCHING.parts)
    stick = next(event for event in done.events if event.kind == EventKind.STICK)
    period = 2.0 * math.pi / math.sqrt((6e5 + 5e6) / 350.0)
    invented = stick._replace(kind=EventKind.BREAKAWAY, fraction=stick.fraction + 3.0 * period + 1e-10)
    with pytest.raises(Find, match='3 periods'):
        JUDGES['touch'](done._replace(stretches=[([stick, invented], done.stretches[-1][1])]), RNG)


def test_the_reference_sees_a_missed_event(good: Run) -> None:
    pytest.importorskip('mpmath')
    short = good._replace(parts=good.parts._replace(duration=1.0))
    events = [event for event in good.events if event.time <= 1.0]
    reference.compare(short.parts, events, 20)
    with pytest.raises(Find):
        reference.compare(short.parts, events[:-1], 20)


@pytest.mark.parametrize('scene', ROUNDING)
def test_what_rounding_of_the_data_may_change_is_undecided_and_no_more(scene: str) -> None:
    pytest.importorskip('mpmath')
    values, duration, k = ROUNDING[scene]
    done = run(Case(values, duration).parts)
    with pytest.raises(Undecided, match=r'rounding of the data|double root'):
        reference.judge(done)
    events = done.events
    events[k] = events[k]._replace(fraction=events[k].fraction + 1e-8)
    with pytest.raises(Find):
        reference.compare(done.parts, events, len(events))


def test_coasts_of_a_moment_are_passed_over_and_longer_ones_are_not() -> None:
    def slip(coasting: float) -> list[brute.BruteEvent]:
        return [brute.BruteEvent(at, kind, Mode.COASTING, -1, -1e-3, False)
                for at, kind in ((1.0, EventKind.COAST), (1.0 + coasting, EventKind.DECELERATE))]
    assert brute.plain(slip(1e-15), 1e-9) == slip(1e-15)[1:]
    assert brute.plain(slip(1e-6), 1e-9) == slip(1e-6)


def test_a_find_is_written_and_judged_again(tmp_path: Path) -> None:
    place = write(Found('slopes', 'a/b', 'guards', 'text', CASE), tmp_path, None)
    case, seed = read(place)
    assert seed == 'a/b'
    assert case.parts == CASE.parts
    assert judge_again(case, seed, reference_too=False) == []
