# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers in a closed loop, against closed forms, their own measurements and their bags."""

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

import stickslip_sim as stickslip
from stickslip_sim.check.verification import verify
from stickslip_sim.closed_loop import ClosedLoopRun
from stickslip_sim.controllers import Moves
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.core.errors import ControllerError, InputError
from stickslip_sim.recording import RecordedRun, read_run

GAIN = 12.0   # 1/s
REST: dict[str, Any] = {'drive.course': 'constant', 'drive.velocity': 0.0}
LINEAR = {**REST, 'axis.normal_force': 0.0}
NOISY = {'encoder.resolution': 1e-6, 'encoder.delay': 0.002, 'encoder.noise': 1e-7,
         'faults.ids': ['a', 'b', 'c'], 'faults.kinds': ['encoder_dropout', 'command_loss', 'friction_scale'],
         'faults.starts': [0.1, 0.2, 0.5], 'faults.durations': [0.3, 0.3, 0.2], 'faults.values': [0.2, 0.2, 0.7]}


def late(steps: int) -> dict[str, Any]:
    return {'faults.ids': ['late'], 'faults.kinds': ['command_delay'], 'faults.starts': [0.0],
            'faults.durations': [math.inf], 'faults.values': [0.001 * steps]} if steps else {}


def proportional(_: float, measured: Measurement) -> float:
    assert measured.setpoint is not None
    return GAIN * (measured.setpoint.position - measured.slider_position)


def following(time: float, measured: Measurement) -> float:
    return 0.003 + 15.0 * (0.003 * time - measured.slider_position)


def scene(changes: dict[str, Any], name: str = 'positioning') -> stickslip.Scene:
    return stickslip.load_scene(name, changes)


@pytest.mark.parametrize(('rate', 'delay'), [(None, 0), (None, 3), (250.0, 0), (100.0, 4)])
def test_without_friction_it_is_the_linear_recursion(rate: float | None, delay: int) -> None:
    """Position, velocity and drive position of spring, damper and mass, the drive held over each step."""
    axis = scene(LINEAR).axis
    c, h, m = axis.drive_stiffness, axis.drive_damping, axis.mass
    motion = expm(0.001 * np.array([[0, 1, 0, 0], [-c / m, -h / m, c / m, h * axis.feed_share / m], [0, 0, 0, 1],
                                    [0, 0, 0, 0]]))
    run = stickslip.close_loop(proportional, scene({**LINEAR, **late(delay)}), 0.4, rate, lambda _: 1e-3)
    every = 1 if rate is None else round(1000.0 / rate)
    state, waiting = np.zeros(4), [0.0] * delay
    expected = []
    for step in range(401):
        expected.append(state[:3].copy())
        if step % every == 0:
            sent = GAIN * (1e-3 - state[0])
        waiting.append(sent)
        state = motion @ np.append(state[:3], waiting.pop(0))
    found = np.stack([run.samples[name] for name in ('position', 'velocity', 'drive_position')], axis=1)
    assert np.abs(found - expected).max(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-13)
    assert len(run.commands['time']) == math.ceil(400 / every)


class TestWhatIsTold:
    def told(self, changes: dict[str, Any], duration: float = 0.6, **options: Any
             ) -> tuple[list[tuple[float, Measurement]], ClosedLoopRun]:
        found: list[tuple[float, Measurement]] = []

        def listening(time: float, measured: Measurement) -> float:
            found.append((time, measured))
            return following(time, measured)

        return found, stickslip.close_loop(listening, scene(changes), duration, **options)

    def test_the_state_after_each_step_but_the_last(self) -> None:
        found, run = self.told({})
        states = run.samples
        assert [time for time, _ in found] == states['time'][:-1].tolist()
        for name, column in (('slider_position', 'position'), ('slider_velocity', 'velocity'),
                             ('drive_position', 'drive_position'), ('drive_velocity', 'drive_velocity'),
                             ('drive_force', 'drive_force')):
            assert [getattr(one, name) for _, one in found] == states[column][:-1].tolist()
            assert run.measured[name].tolist() == states[column].tolist()

    def test_what_was_measured_last_where_it_is_lost(self) -> None:
        found, run = self.told(NOISY)
        lost = [one.is_lost for _, one in found]
        assert 20 < sum(lost) < 100
        assert run.measured['is_lost'][:-1].tolist() == lost
        for (_, before), (_, one) in pairwise(found):
            if one.is_lost:
                assert one[:4] == before[:4]
        assert run.measured['slider_position'][:-1].tolist() == [one.slider_position for _, one in found]
        assert all(one.slider_position == pytest.approx(1e-6 * round(one.slider_position / 1e-6)) for _, one in found)

    def test_a_rate_of_its_own(self) -> None:
        found, run = self.told({}, rate=125.0)
        assert [time for time, _ in found] == run.samples['time'][:-1:8].tolist()

    def test_the_setpoint(self) -> None:
        found, run = self.told({}, setpoint=lambda time: (0.003 * time, 0.003))
        assert [one.setpoint for _, one in found] == [(0.003 * time, 0.003) for time, _ in found]
        assert run.setpoint['position'].tolist() == (0.003 * run.samples['time']).tolist()
        assert self.told({})[1].setpoint == {}


def test_a_reset_comes_first() -> None:
    class Counting:
        count = 5

        def reset(self) -> None:
            self.count = 0

        def __call__(self, time: float, measured: Measurement) -> float:
            self.count += 1
            return 0.0

    own = Counting()
    for _ in range(2):
        stickslip.close_loop(own, 'positioning', 0.01)
        assert own.count == 10


def test_a_force_and_silence() -> None:
    """Without commands after the first the drive times out, as the scene says; forces act at once."""
    def silent(time: float, _: Measurement) -> stickslip.Command:
        return stickslip.Command(0.001 if time == 0.0 else None, 250.0)

    run = stickslip.close_loop(silent, scene({'command.timeout': 0.05, 'command.on_timeout': 'ramp_to_zero',
                                              'command.timeout_deceleration': 1.0}), 0.2)
    assert run.samples['external_force'].tolist() == [0.0, *[250.0] * 200]
    assert [mark.label for mark in run.marks] == ['time-out']
    assert run.samples['drive_velocity'][[10, -1]].tolist() == [0.001, 0.0]
    assert run.receipt['commands']['timed_out'] == 1


def test_the_drive_keeps_its_limits() -> None:
    run = stickslip.close_loop(lambda *_: 0.05, scene({**REST, 'command.velocity_limit': 0.02,
                                                       'command.acceleration_limit': 0.5}), 0.1)
    speeds = run.samples['drive_velocity']
    assert speeds.max() == 0.02
    assert np.diff(speeds).max() == pytest.approx(0.5e-3)
    assert run.receipt['commands']['limited'] == 100


class TestSetpoints:
    TIMES = np.arange(0.0, 0.5, 0.001)

    def run(self, given: Any) -> ClosedLoopRun:
        return stickslip.close_loop(proportional, scene({}), 0.4, setpoint=given)

    def test_all_kinds_are_the_same(self, tmp_path: Path) -> None:
        file, other = tmp_path / 'move.csv', tmp_path / 'other.csv'
        file.write_text('time,position\n' + ''.join(f'{time!r},{0.002 * time!r}\n' for time in self.TIMES.tolist()))
        other.write_text('# a move\nt; x [mm]; note\n0; 0; a\n0,5; 1,0; b\n')
        expected = self.run(lambda time: 0.002 * time)
        for given in ((self.TIMES, 0.002 * self.TIMES), ([0, 0.5], [0, 0.001]), file, str(other)):
            found = self.run(given)
            assert found.setpoint['position'] == pytest.approx(expected.setpoint['position'], abs=1e-17)
            assert found.setpoint['velocity'] == pytest.approx(0.002, rel=1e-9)
            assert found.samples['position'] == pytest.approx(expected.samples['position'], abs=1e-12)

    def test_moves(self) -> None:
        moves = Moves(0.0002, 0.001)
        found = self.run(moves).setpoint
        assert list(zip(found['position'].tolist(), found['velocity'].tolist())) == [
            moves.at(time) for time in found['time'].tolist()]

    @pytest.mark.parametrize(('given', 'said'), [
        (([0.0, 0.3], [0.0, 1.0]), 'setpoint = .0 to 0.3 s. is refused: must be from 0 to the end of the run, 0.4 s'),
        (([0.1, 0.5], [0.0, 1.0]), '0.1 to 0.5 s'),
        (([0.0, 0.2, 0.2, 0.5], [0.0] * 4), r'setpoint times\[2\] = 0.2 .* after the one before it, 0.2 s'),
        (([0.0, math.nan], [0.0, 1.0]), r'setpoint times\[1\] = nan'),
        (([0.0, 1.0], [0.0, math.inf]), r'setpoint positions\[1\] = inf'),
        (([0.0, 1.0], [0.0]), r'shapes \(2,\) and \(1,\)'),
        ((0.0, 1.0), 'shapes'),
        (3, 'setpoint = 3 is refused: must be a function of time'),
        ('missing.csv', "setpoint = 'missing.csv'"),
        (lambda time: None, r'setpoint\(0\) is missing'),
        (lambda time: math.nan if time > 0.05 else 0.0, r'setpoint\(0.051\) = nan'),
        (lambda time: (time, 1.0) if time else 0.0, r'setpoint\(0.001\) = '),
        (lambda time: 'far', r"setpoint\(0\) = 'far'"),
        (lambda time: 1.0 / time, r'setpoint\(0\) = .ZeroDivisionError: .*\(test_closed_loop.py, line'),
    ])
    def test_refused(self, given: Any, said: str) -> None:
        with pytest.raises(InputError, match=said):
            self.run(given)

    @pytest.mark.parametrize('heading', ['position [kg]', 'position [MM]', 'position (m/s)', 'x [furlong]'])
    def test_a_unit_that_is_none_is_not_taken_for_si(self, heading: str, tmp_path: Path) -> None:
        (tmp_path / 'move.csv').write_text(f'time,{heading}\n0,0\n1,2\n')
        with pytest.raises(InputError, match=r'must be a heading with one of the units .*mm'):
            self.run(tmp_path / 'move.csv')


class TestRefused:
    @pytest.mark.parametrize(('answer', 'said'), [
        (None, 'velocity of control after step 30 (t = 0.03 s) is missing: must be a number within ±1 m/s'),
        (math.nan, '= nan is refused'), (math.inf, '= inf'), ('fast', "= 'fast'"), ([0.1], '= [0.1]'), (True, '= True'),
        (np.array([0.1, 0.2]), '= array([0.1, 0.2])'), ((0.1, 0.2), '= (0.1, 0.2)'),
        (2.0, '= 2.0 is refused: must be a number within ±1 m/s (command.max_velocity); limit it in the controller'),
        (stickslip.Command(0.0, math.nan), 'force of control after step 30 (t = 0.03 s) = nan'),
    ])
    def test_answers(self, answer: object, said: str) -> None:
        def control(time: float, _: Measurement) -> object:
            return answer if time >= 0.03 else 0.0005

        with pytest.raises(ControllerError) as error:
            stickslip.close_loop(control, 'positioning', 0.1)
        assert said in str(error.value)
        assert error.value.exit_code == 2
        kept = error.value.run
        assert kept.samples['time'].tolist() == [k / 1000 for k in range(31)]
        assert kept.commands['velocity'].tolist() == [0.0005] * 30

    @pytest.mark.parametrize('answer', [np.float64(0.001), np.float32(0.5), 0, stickslip.Command(np.float64(0.001), 1)])
    def test_other_numbers_are_taken(self, answer: Any) -> None:
        run = stickslip.close_loop(lambda *_: answer, 'positioning', 0.01)
        assert type(run.commands['velocity'][0]) is np.float64

    def test_an_error_of_its_own(self) -> None:
        def control(time: float, _: Measurement) -> float:
            return 0.001 / (0.02 - time)

        said = (r'control raised ZeroDivisionError: .*zero \(test_closed_loop.py, line \d+\), asked after step 20 '
                r'\(t = 0.02 s\)')
        with pytest.raises(ControllerError, match=said):
            stickslip.close_loop(control, scene({'command.max_velocity': 10.0}), 0.1)

    def test_an_error_in_its_reset(self) -> None:
        class Own:
            def reset(self) -> None:
                raise RuntimeError('no')

            def __call__(self, time: float, measured: Measurement) -> float:
                return 0.0

        with pytest.raises(ControllerError, match=r'Own.reset\(\) raised RuntimeError: no \(test_closed_loop.py'):
            stickslip.close_loop(Own(), 'positioning', 0.1)

    @pytest.mark.parametrize('given', [3, 'control', Moves, None])
    def test_no_controller(self, given: Any) -> None:
        with pytest.raises(InputError, match=r'controller = .*give an instance'):
            stickslip.close_loop(given, 'positioning', 0.1)

    def test_the_rate_that_is_proposed_is_taken(self) -> None:
        with pytest.raises(InputError) as refused:
            stickslip.close_loop(following, 'positioning', 0.1, 300.0)
        proposed = float(str(refused.value).split('for example ')[1].split(',')[0])
        assert proposed == 250.0
        stickslip.close_loop(following, 'positioning', 0.1, proposed)

    @pytest.mark.parametrize('rate', [0.0, -1.0, 300.0, 2000.0, math.nan, math.inf])
    def test_rates(self, rate: float) -> None:
        with pytest.raises(InputError, match=r'rate = .* must be time.rate \(1000 Hz\) divided by a whole number'):
            stickslip.close_loop(following, 'positioning', 0.1, rate)

    @pytest.mark.parametrize('duration', [0.0, -1.0, math.nan, math.inf, 1e-9, 1e5])
    def test_durations(self, duration: float) -> None:
        with pytest.raises(InputError, match='duration = '):
            stickslip.close_loop(following, 'positioning', duration)


@pytest.fixture(scope='module')
def noisy(tmp_path_factory: pytest.TempPathFactory) -> tuple[ClosedLoopRun, RecordedRun]:
    run = stickslip.close_loop(following, scene(NOISY), 1.0, setpoint=lambda time: 0.003 * time)
    folder = tmp_path_factory.mktemp('loop') / 'run'
    run.save(folder)
    return run, read_run(folder)


class TestBag:
    def test_is_made_again_step_by_step(self, noisy: tuple[ClosedLoopRun, RecordedRun]) -> None:
        run, recorded = noisy
        verdict = verify(recorded)
        events = [event for event in run.events if event.kind != stickslip.EventKind.KNOT]
        assert (verdict.difference, verdict.steps, verdict.events) == (None, 1001, len(events))
        assert verdict.events > 5

    def test_is_the_run(self, noisy: tuple[ClosedLoopRun, RecordedRun]) -> None:
        run, recorded = noisy
        assert recorded.scene == run.scene
        assert run.scene.values['joint_interface.enabled'] is True
        assert run.scene.time.mode == 'lockstep'
        for name in ('time', 'position', 'velocity', 'mode', 'friction_force', 'drive_force', 'rest_time'):
            assert recorded.samples[name].tolist() == run.samples[name].tolist(), name
        assert recorded.commands['velocity'].tolist() == run.commands['velocity'].tolist()
        assert recorded.commands['time'] == pytest.approx(run.commands['time'], abs=1e-12)
        assert [mark.label for mark in recorded.marks] == [mark.label for mark in run.marks]
        assert [mark.begin for mark in recorded.marks] == pytest.approx([mark.begin for mark in run.marks])
        assert {'lost', 'encoder_dropout', 'friction_scale'} <= {mark.label for mark in run.marks}
        assert recorded.summary.last == run.summary.last
        assert recorded.receipt['results'] == run.receipt['results']
        assert recorded.receipt['controller'] == {'name': 'following', 'rate': 1000.0}

    def test_has_the_setpoint(self, noisy: tuple[ClosedLoopRun, RecordedRun]) -> None:
        run, recorded = noisy
        for name in ('time', 'position', 'velocity'):
            assert recorded.setpoint[name].tolist() == run.setpoint[name].tolist()

    def test_one_more_than_a_block(self, tmp_path: Path) -> None:
        run = stickslip.close_loop(following, 'micro_feed', 11.0, 50.0)
        run.save(tmp_path / 'run')
        assert verify(read_run(tmp_path / 'run')).difference is None
        assert read_run(tmp_path / 'run').setpoint == {}

    def test_an_existing_folder_is_not_touched(self, noisy: tuple[ClosedLoopRun, RecordedRun], tmp_path: Path
                                               ) -> None:
        (tmp_path / 'note').touch()
        with pytest.raises(stickslip.RecordingError):
            noisy[0].save(tmp_path)
        assert [path.name for path in tmp_path.iterdir()] == ['note']


class TestLikeEveryOtherRun:
    def test_limits(self, noisy: tuple[ClosedLoopRun, RecordedRun], tmp_path: Path) -> None:
        run, recorded = noisy
        limits = tmp_path / 'limits.yaml'
        limits.write_text('limits:\n  peak_speed: {max: 1.0, window: {begin: first_command}}\n'
                          '  overshoot: {max: 1.0e-3, target: 0.003}\n  following_error: {max: 1.0}\n')
        checked = run.check(limits)
        assert checked.passed
        recorded_outcomes = ClosedLoopRun.check(recorded, str(limits)).outcomes  # type: ignore[arg-type]
        assert recorded_outcomes == checked.outcomes
        error = np.abs(run.setpoint['position'] - run.samples['position'])
        assert checked.outcomes[-1].value == error.max()
        limits.write_text('limits: {peak_speed: {max: 1.0e-3}}\n')
        assert not run.check(limits).passed

    def test_picture_frame_and_cycles(self, noisy: tuple[ClosedLoopRun, RecordedRun], tmp_path: Path) -> None:
        run, recorded = noisy
        run.plot(tmp_path / 'run.svg')
        recorded.plot(tmp_path / 'recorded.svg')
        sizes = [(tmp_path / name).stat().st_size for name in ('run.svg', 'recorded.svg')]
        assert sizes[0] == pytest.approx(sizes[1], rel=0.1)
        assert run.cycles() == recorded.cycles()
        pytest.importorskip('pandas')
        assert len(run.frame()) == 1001

    def test_no_error_estimate(self, noisy: tuple[ClosedLoopRun, RecordedRun]) -> None:
        with pytest.raises(InputError, match='must be of a scene alone'):
            stickslip.error_estimate(noisy[0])

    def test_says_what_drove_it(self, noisy: tuple[ClosedLoopRun, RecordedRun]) -> None:
        assert noisy[0].source == 'simulated for 1 s with following in the loop'


def test_the_same_run_twice() -> None:
    first, second = (stickslip.close_loop(following, scene(NOISY), 0.5) for _ in range(2))
    assert first.events == second.events
    assert all((first.samples[name] == second.samples[name]).all() for name in first.samples)


def test_progress() -> None:
    shares: list[float] = []
    stickslip.close_loop(following, 'positioning', 3.0, progress=shares.append)
    assert shares == sorted(shares)
    assert len(shares) >= 3


@pytest.mark.parametrize('control', [following, lambda time, measured: 0.0])
def test_a_scene_that_measures_anyway_stays_as_it_is(control: Callable[[float, Measurement], float]) -> None:
    given = scene({'joint_interface.enabled': True, 'time.mode': 'lockstep'})
    assert stickslip.close_loop(control, given, 0.01).scene is given
