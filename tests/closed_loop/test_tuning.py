# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The linear loops of a controller: closed forms, the closed loop itself, and why it swings."""

import json
import math
import random
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

import stickslip_sim as stickslip
from stickslip_sim.closed_loop.linear_loop import LinearLoop, friction_slope
from stickslip_sim.closed_loop.report import tuning_report, tuning_values, verdicts
from stickslip_sim.controllers import Cascade, Controller
from stickslip_sim.controllers.own_controller import Command, Measurement
from stickslip_sim.core.errors import ControllerError, InputError
from stickslip_sim.report.text import text_lines
from stickslip_sim.report.values import json_text
from tests.support.linear_loop import loop_matrix
from tests.support.own_controllers import Following
from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, done, refused

pytestmark = pytest.mark.slow

REST: dict[str, Any] = {'drive.course': 'constant', 'drive.velocity': 0.0}
LINEAR = {**REST, 'axis.normal_force': 0.0}
SHORT = 0.4   # s
LATE = {'faults.ids': ['late'], 'faults.kinds': ['command_delay'], 'faults.starts': [0.0],
        'faults.durations': [math.inf]}


def scene(changes: dict[str, Any] | None = None, name: str = 'positioning') -> stickslip.Scene:
    return stickslip.load_scene(name, {**REST, **(changes or {})})


def loop_of(controller: Callable[[float, Measurement], Any], of: stickslip.Scene, mode: str = 'slip',
            **options: Any) -> LinearLoop:
    loop = stickslip.tune(controller, of, duration=SHORT, **options).loops[mode]
    assert isinstance(loop, LinearLoop), loop
    return loop


@dataclass
class Proportional:
    """On the position of the slider and its velocity, with a factor on all."""

    gain: float = 12.0
    damping: float = 0.0
    factor: float = 1.0

    def __call__(self, _: float, measured: Measurement) -> float:
        assert measured.setpoint is not None
        wanted = self.gain * (measured.setpoint.position - measured.slider_position)
        return self.factor * (wanted - self.damping * measured.slider_velocity)


class TestClosedForms:
    """Spring, damper and mass between drive and slider, the drive held over a step."""

    AXIS = scene().axis
    RATES = np.array([[0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0]], dtype=float)
    RATES[1] = np.array([-AXIS.drive_stiffness, -AXIS.drive_damping, AXIS.drive_stiffness,
                         AXIS.drive_damping]) / AXIS.mass

    def open_loop(self, frequency: float, period: float) -> complex:
        """Return L of Proportional() from the matrix exponential of the axis."""
        motion = expm(period * self.RATES)
        z = np.exp(2j * math.pi * frequency * period)
        state = np.linalg.inv(z * np.eye(3) - motion[:3, :3]) @ motion[:3, 3]
        return complex(12.0 * state[0])

    @pytest.mark.parametrize('every', [1, 8])
    def test_margins_of_a_gain_on_the_position(self, every: int) -> None:
        loop = loop_of(Proportional(), scene(LINEAR), rate=1000.0 / every)
        period = 1e-3 * every
        expected = [self.open_loop(frequency, period) for frequency in loop.frequencies]
        assert np.abs(loop.open / expected - 1.0).max() < 1e-7
        assert len(loop.controller.a) == 0
        motion = expm(period * self.RATES)

        def largest_pole(gain: float) -> float:
            matrix = motion[:3, :3] - gain * np.outer(motion[:3, 3], [1.0, 0.0, 0.0])
            return float(np.abs(np.linalg.eigvals(matrix)).max())
        least, largest = loop.stable_gains
        assert least == 0.0
        assert largest_pole(12.0 * largest) == pytest.approx(1.0, abs=1e-9)
        assert largest_pole(12.0 * 0.999 * largest) < 1.0 < largest_pole(12.0 * 1.001 * largest)
        margin, crossing = loop.phase_margin
        at = self.open_loop(crossing, period)
        assert abs(at) == pytest.approx(1.0, abs=1e-7)
        assert margin == pytest.approx((math.degrees(np.angle(at)) + 360.0) % 360.0 - 180.0, abs=1e-6)

    @pytest.mark.parametrize('gains', [Cascade(), Cascade(20.0, 2.0, 0.05), Cascade(5.0, 16.0, math.inf)])
    def test_the_poles_of_the_cascade(self, gains: Cascade) -> None:
        loop = loop_of(Following(Controller(gains)), scene(LINEAR))
        assert len(loop.controller.a) == (0 if math.isinf(gains.integral_time) else 1)
        assert loop.controller.integrates == math.isfinite(gains.integral_time)
        for extra in range(4):
            found, expected = (sorted(poles[np.abs(poles) > 1e-3], key=lambda pole: (round(abs(pole), 6), pole.imag))
                               for poles in map(np.linalg.eigvals, (loop.closed(extra=extra),
                                                                    loop_matrix(self.AXIS, gains, extra))))
            unmoved = math.isinf(gains.integral_time)    # the closed form keeps its integral part all the same
            assert found == pytest.approx([pole for pole in expected if not (unmoved and pole == 1.0)], abs=1e-6)

    @pytest.mark.parametrize('gain', [2.0, 8.0, 25.0])
    def test_the_largest_delay_of_the_cascade(self, gain: float) -> None:
        gains = Cascade(velocity_gain=gain)
        largest = next(delay for delay in range(99)
                       if np.abs(np.linalg.eigvals(loop_matrix(self.AXIS, gains, delay + 1))).max() >= 1.0)
        assert loop_of(Following(Controller(gains)), scene(LINEAR)).largest_delay == largest

    def test_a_compliant_stick_moves_by_the_share_of_its_spring(self) -> None:
        loop = loop_of(Proportional(), scene(), 'stick')
        contact = self.AXIS.contact.stiffness   # type: ignore[union-attr]
        share = self.AXIS.drive_stiffness / (self.AXIS.drive_stiffness + contact)
        slow = 2j * math.pi * loop.frequencies[0]
        assert abs(slow * loop.slider[0]) == pytest.approx(share, rel=1e-3)

    def test_a_rigid_stick_does_not_answer(self) -> None:
        loop = loop_of(Following(Controller(Cascade())), scene(name='paper_fig7'), 'stick')
        assert not loop.slider.any()
        assert not loop.open.any()
        assert loop.stable_gains == (0.0, math.inf)
        assert loop.is_stable()
        assert loop.largest_delay is None
        assert not loop.follows_setpoint

    def test_friction_of_slip_is_a_damper(self) -> None:
        loop = loop_of(Proportional(), scene(), feed=0.02)
        slope = (0.05 - 0.12) / 0.035 * 3432.3275
        assert friction_slope(loop.scene, 0.02) == pytest.approx(slope)
        poles = np.log(np.linalg.eigvals(loop.plant.a[:3, :3]).astype(complex)) * 1000.0
        assert poles.real.max() * 2.0 * self.AXIS.mass == pytest.approx(-(self.AXIS.drive_damping + slope))
        assert loop_of(Proportional(), scene(), feed=0.05).is_stable()      # friction is constant from 0.035 m/s on

    def test_the_step_response_is_that_of_the_closed_loop(self) -> None:
        of = scene({**LINEAR, 'encoder.delay': 0.003, 'encoder.velocity_steps': 2})
        own = Proportional(10.0, 0.5)
        times, positions = loop_of(own, of).step_response
        run = stickslip.close_loop(own, of, 1.0, setpoint=lambda _: 1e-3)
        assert run.samples['position'][:1000] == pytest.approx(1e-3 * positions[:1000], abs=1e-13)
        assert times[10] == pytest.approx(0.01)
        overshoot, settling = loop_of(own, of).overshoot_and_settling
        assert overshoot == pytest.approx(1e3 * run.samples['position'].max() - 1.0, abs=1e-4)
        late = run.samples['time'] >= settling
        off = np.abs(1e3 * run.samples['position'] - 1.0)
        assert off[late].max() <= 0.02 < off[~late][-1]


@pytest.mark.parametrize(('changes', 'rate'), [
    ({}, 1000.0), ({}, 250.0), ({'encoder.delay': 0.004, 'encoder.velocity_steps': 3}, 500.0),
    ({**LATE, 'faults.values': [0.003]}, 500.0)])
class TestTheLoopItself:
    """Without friction it decays just below the limits that were found, and grows just above."""

    OWN = Proportional(10.0, 2.0)

    def growth(self, changes: dict[str, Any], rate: float, factor: float = 1.0) -> float:
        """Return the ratio of the speeds late and early in a run; it is infinite at the limit of the command."""
        try:
            run = stickslip.close_loop(replace(self.OWN, factor=factor), scene({**LINEAR, **changes}), 6.0, rate,
                                       lambda _: 1e-7)
        except ControllerError:
            return math.inf
        speeds = np.abs(run.samples['velocity'])
        return float(speeds[5000:].max() / speeds[2000:3000].max())

    def test_the_largest_gain(self, changes: dict[str, Any], rate: float) -> None:
        _, largest = loop_of(self.OWN, scene({**LINEAR, **changes}), rate=rate).stable_gains
        assert self.growth(changes, rate, 0.98 * largest) < 1.0 < self.growth(changes, rate, 1.02 * largest)

    def test_the_largest_delay(self, changes: dict[str, Any], rate: float) -> None:
        largest = loop_of(self.OWN, scene({**LINEAR, **changes}), rate=rate).largest_delay
        assert largest
        there = round(1000.0 * changes.get('faults.values', [0.0])[0])

        def grown(extra: int) -> float:
            return self.growth({**changes, **LATE, 'faults.values': [1e-3 * (there + extra)]}, rate)
        assert grown(largest) < 1.0 < grown(largest + 1)


class TestWhyItSwings:
    def cascade(self, **gains: float) -> Following:
        return Following(Controller(Cascade(**gains)))

    def test_an_unstable_loop_grows_as_it_says(self) -> None:
        late = scene({**LINEAR, **LATE, 'faults.values': [0.006]})
        found = stickslip.tune(self.cascade(), late, duration=1.0)
        loop = found.linear['slip']
        frequency, growth = loop.worst
        assert growth > 0.0
        assert loop.largest_delay == -1
        assert loop.stable_gains[1] < 1.0
        run = stickslip.close_loop(self.cascade(), late, 1.0, setpoint=lambda _: 1e-9)
        speed = run.samples['velocity'][300:]
        rises = np.flatnonzero((speed[:-1] < 0.0) & (speed[1:] >= 0.0))
        assert 1000.0 / np.diff(rises).mean() == pytest.approx(frequency, rel=0.01)
        peaks = [speed[first:last].max() for first, last in pairwise(rises)]
        assert np.polyfit(1e-3 * rises[:-1], np.log(peaks), 1)[0] == pytest.approx(growth, rel=0.02)
        assert f'The loop about slip is unstable: it oscillates at {frequency:.3g} Hz' in next(verdicts(
            replace(found, loops={'slip': loop})))

    def test_falling_friction_beyond_the_damping(self) -> None:
        found = stickslip.tune(Proportional(1.0), scene(), feed=0.02, duration=4.0)
        assert not found.linear['slip'].is_stable()
        assert {swing.cause for swing in found.swings} == {'unstable'}
        assert 'friction falls there by 6.86 kN s/m, the damping of the drive is 4 kN s/m' in next(verdicts(found))

    def test_an_integrator_hunts_over_static_friction(self) -> None:
        found = stickslip.tune(self.cascade(), scene(name='paper_fig7'), feed=5e-4)
        assert all(loop.is_stable() for loop in found.linear.values())
        swing = found.swings[-1]
        assert (swing.during, swing.cause) == ('hold', 'friction')
        run = found.run
        late = [event.time for event in run.events if event.kind == stickslip.EventKind.BREAKAWAY and event.time > 15.0]
        assert swing.period == pytest.approx(2.0 * np.diff(late).mean(), rel=0.02)     # there and back
        positions = run.samples['position'][run.samples['time'] > 15.0]
        assert swing.amplitude == pytest.approx(0.5 * np.ptp(positions), rel=0.02)
        assert 0.7 < swing.stick_share < 0.85
        last = list(verdicts(found))[-1]
        assert last.startswith('At a setpoint that stands still the slider swings by ±45.')
        assert last.endswith('a stick-slip limit cycle, though the loop is stable about stick and about slip; static '
                             'friction is up to 824 N, kinetic 412 N: in stick the drive and the integrator of the '
                             'controller wind the spring up until it breaks away.')

    def test_counts_of_the_encoder(self) -> None:
        found = stickslip.tune(self.cascade(), scene({**LINEAR, 'encoder.resolution': 1e-5}), feed=1e-3, duration=8.0)
        assert [(swing.during, swing.cause) for swing in found.swings] == [('feed', 'encoder')]
        assert 'counts of the encoder, 10 µm each' in next(verdicts(found))
        fine = stickslip.tune(self.cascade(), scene(LINEAR), feed=1e-3, duration=8.0)
        assert [*verdicts(fine)] == ['No swing lasts at 1 mm/s and a setpoint that stands still (8 s were simulated).']

    def test_what_the_controller_does_itself(self) -> None:
        found = stickslip.tune(lambda time, _: 1e-3 * math.sin(20.0 * time), scene(), duration=8.0)
        assert {swing.cause for swing in found.swings} == {'other'}
        assert 0.31 < found.swings[0].period < 0.32
        assert 'by what the controller does itself' in next(verdicts(found))

    def test_a_run_that_ends_early(self) -> None:
        found = stickslip.tune(Proportional(3e5), scene(LINEAR), duration=SHORT)
        assert found.swings == []
        assert found.run.duration < SHORT
        assert 'The closed loop ended early: velocity of Proportional after step' in list(verdicts(found))[-1]


def backlash(_: float, measured: Measurement) -> float:
    return 0.1 * math.copysign(max(abs(measured.slider_velocity) - 1e-7, 0.0), measured.slider_velocity)


class TestWhatCannotBeProbed:
    def reason(self, controller: Callable[[float, Measurement], Any], mode: str = 'stick') -> str:
        found = stickslip.tune(controller, scene(), duration=SHORT)
        loop = found.loops[mode]
        assert isinstance(loop, str)
        assert f'note: The controller cannot be probed about {mode}: {loop}.' in list(text_lines(tuning_report(found)))
        assert tuning_values(found)['loops'][mode] == {'not_linear': loop}
        return loop

    def test_constants(self) -> None:
        for constant in (lambda *_: 1e-3, lambda *_: Command(1e-3), lambda *_: Command(None)):
            assert self.reason(constant).startswith('its answers do not depend on what it measures')

    def test_thresholds(self) -> None:
        assert 'it is not linear: its answers are ' in self.reason(backlash)
        assert 'it is not linear: its answers are ' in self.reason(
            lambda _, measured: 1e-3 * float(np.sign(measured.slider_velocity)))

    def test_a_threshold_at_rest_is_linear_in_motion(self) -> None:
        loop = loop_of(lambda _, measured: 1e-3 * math.copysign(1.0, measured.slider_velocity)
                       - measured.slider_velocity, scene())
        assert loop.controller.d[0, 1] == pytest.approx(-1.0)

    def test_chance(self) -> None:
        assert 'asked the same again' in self.reason(lambda *_: 1e-6 * random.random())

    def test_a_force(self) -> None:
        assert 'it orders a force' in self.reason(lambda *_: Command(0.0, 1.0))

    def test_a_long_memory(self) -> None:
        class Mean:
            def reset(self) -> None:
                self.all = [0.0] * 400

            def __call__(self, _: float, measured: Measurement) -> float:
                self.all = [*self.all[1:], measured.slider_velocity]
                return -sum(self.all) / len(self.all)
        assert 'memory of more than 150 asks' in self.reason(Mean())

    def test_an_error_is_none_of_that(self) -> None:
        with pytest.raises(ControllerError, match='raised ZeroDivisionError'):
            stickslip.tune(lambda *_: 1.0 / 0.0, scene(), duration=SHORT)
        with pytest.raises(ControllerError, match='must be a number'):
            stickslip.tune(lambda *_: math.nan, scene(), duration=SHORT)


@pytest.mark.parametrize(('options', 'changes', 'words'), [
    ({'feed': 0.0}, {}, 'feed = 0.0 is refused: must be within ±1 m/s'),
    ({'feed': math.nan}, {}, 'feed = nan is refused'),
    ({'rate': 333.0}, {}, 'rate = 333.0 is refused'),
    ({'duration': 0.01}, {}, r'duration = 0.01 is refused: must be at least 200 steps \(0.2 s\)'),
    ({'duration': math.nan}, {}, 'duration = nan is refused'),
    ({}, {'encoder.delay': 0.3}, 'delays = .* is refused: must be at most 250 steps together')])
def test_bad_input(options: dict[str, Any], changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        stickslip.tune(Proportional(), scene(changes), **options)


def test_values_and_picture(tmp_path: Path) -> None:
    found = stickslip.tune(Following(Controller(Cascade())), scene(), feed=5e-4, duration=6.0)
    values = tuning_values(found)
    assert values['loops']['slip']['phase_margin'] == pytest.approx(27.986, abs=1e-3)
    assert values['swings'][0]['cause'] == 'friction'
    assert len(json_text(values)) > 1000
    found.plot(tmp_path / 'tune.svg')
    drawn = (tmp_path / 'tune.svg').read_text(encoding='utf-8')
    assert all(word in drawn for word in ('about stick', 'about slip', 'the slider sticks', 'Following on positioning'))
    stickslip.tune(lambda *_: 0.0, scene(), duration=SHORT).plot(tmp_path / 'none.svg')
    assert 'nothing linear' in (tmp_path / 'none.svg').read_text(encoding='utf-8')


class TestTheVerb:
    PAGE = (ROOT / 'docs/closed_loop.md').read_text(encoding='utf-8')

    @pytest.fixture(autouse=True)
    def folder(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.chdir(tmp_path)
        (tmp_path / 'my_controller.py').write_text(re.findall(r'^```python\n(.*?)^```$', self.PAGE, re.M | re.S)[0])

    def test_the_command_says_what_was_written(self, capsys: Capture) -> None:
        """Before that the report, which the page shows: tests/house/test_pages_run.py."""
        code, out, _ = answered(capsys, 'tune', 'my_controller.py:Cascade', '--scene', 'positioning', '--duration', '1',
                                '--plot', 'tune.png')
        title, *_, written = out.splitlines()
        assert (code, written) == (0, 'written: tune.png')
        assert title.startswith('Cascade on positioning, asked 1000 times a second: its loop about stick, and about ')

    def test_json(self, capsys: Capture) -> None:
        out = done(capsys, 'tune', 'my_controller.py:Cascade', '--scene', 'positioning', '--json', '-', '--gain',
                   'integral_time=0.2', '--rate', '500', '--duration', '1')
        found = json.loads(out)
        assert (found['controller'], found['rate']) == ('Cascade', 500.0)
        assert found['feed'] == 0.01
        assert found['loops']['slip']['stable'] is True

    @pytest.mark.parametrize(('options', 'words'), [
        (('my_controller.py:Cascada', '--scene', 'positioning'), 'did you mean Cascade?'),
        (('my_controller.py:Cascade', '--scene', 'positionings'), 'did you mean positioning?'),
        (('my_controller.py:Cascade', '--scene', 'positioning', '--feed', '2'), 'feed = 2.0 is refused'),
        (('my_controller.py:Cascade', '--scene', 'positioning', '--gain', 'kp'), '--gain = '),
        (('my_controller.py:Cascade', '--scene', 'positioning', '--plot', 'tune.bmp'), 'tune.bmp')])
    def test_bad_input_in_one_line(self, capsys: Capture, options: tuple[str, ...], words: str) -> None:
        assert words in refused(capsys, 'tune', *options)
