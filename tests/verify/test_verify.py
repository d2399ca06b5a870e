# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify` on bags of the tool: identical, or what differs; cut, damaged, foreign; what if."""

import struct
from collections.abc import Callable
from pathlib import Path

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.recording import flat_layout, open_bag, read_run
from stickslip_sim.recording.topics import FRICTION_FORCE, SLIDER_STATE, Topic
from stickslip_sim.verify.origin import doubts_about
from stickslip_sim.verify.verification import verify
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture
from tests.support.verify_tool import verified

STEPS, EVENTS = 3001, 17     # of the bag
FAULTS = ('faults.ids=[dry, knock]', 'faults.kinds=[friction_scale, force_pulse]', 'faults.starts=[0.3, 0.7004]',
          'faults.durations=[0.5, 0.0125]', 'faults.values=[1.5, 900.0]')


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return simulated(tmp_path_factory.mktemp('runs') / 'eight', 'paper_fig8', 3.0)


def simulated(folder: Path, scene: str, duration: float, *changes: str) -> Path:
    options = [word for change in changes for word in ('--set', change)]
    assert run(['simulate', scene, '--duration', str(duration), '--bag', str(folder), *options]) == 0
    return folder


class TestIdentical:
    def test_what_it_says(self, bag: Path, capsys: Capture) -> None:
        assert verified(capsys, bag) == (0, f'identical, {STEPS} steps, {EVENTS} events, up to t = 3 s\n', '')

    @pytest.mark.parametrize(('scene', 'duration', 'changes'), [
        ('cutting_force', 1.0, ['time.rate=333.3']),
        ('positioning', 1.5, ['drive.amplitudes=[0.001]', 'drive.frequencies=[7.0]', *FAULTS]),
        ('paper_fig7', 0.987654, ['solver.name=fixed_step', 'solver.step=0.0003', *FAULTS]),
        ('paper_fig8', 1.00005, ['solver.name=adaptive', 'time.rate=100.0']),
        ('paper_fig8', 1.5, ['normal_load.course=steps', 'normal_load.times=[0.0, 0.4, 0.7]',
                             'normal_load.forces=[0.0, -3000.0, 500.0]', 'normal_load.period=0.9', *FAULTS]),
    ])
    def test_all_that_moves_the_axis(self, scene: str, duration: float, changes: list[str], tmp_path: Path) -> None:
        recording = read_run(simulated(tmp_path / 'run', scene, duration, *changes))
        verdict = verify(recording)
        assert (verdict.difference, verdict.missing, doubts_about(recording)) == (None, 0, ())
        assert verdict.steps == recording.bag.counts['/slider_state'] > 50
        assert verdict.events == recording.bag.counts['/mode_event'] > 2

    def test_an_mcap_file_in_another_namespace(self, bag: Path, tmp_path: Path) -> None:
        rewritten(bag, tmp_path / 'cell', lambda name: f'/cell{name}' if name != '/parameter_events' else name)
        assert verify(read_run(tmp_path / 'cell' / 'run_0.mcap')).steps == STEPS


class TestDifferent:
    @pytest.mark.parametrize('topic', [SLIDER_STATE, FRICTION_FORCE])
    def test_every_field_to_the_last_bit(self, topic: Topic, bag: Path, tmp_path: Path) -> None:
        layout = flat_layout(topic.type)
        name = f'/{topic.name}'
        original = next(item.data for item in open_bag(bag).messages([name]) if item.sequence == 1500)
        numbers = layout.numbers(original)
        assert numbers is not None
        for place, field in enumerate(layout.names):
            changed = list(numbers)
            changed[place] = nudged(numbers[place])
            data = original[:12] + layout.pack(0, *changed)[12:]
            folder = rewritten(bag, tmp_path / field, message=replacing(name, 1500, data))
            difference = verify(read_run(folder)).difference
            assert difference is not None
            assert (difference.step, difference.topic, difference.field) == (1500, name, field)
            assert (difference.recorded, difference.made) == (changed[place], numbers[place])

    def test_a_sign_of_zero_and_a_stamp(self, bag: Path, tmp_path: Path) -> None:
        layout = flat_layout(SLIDER_STATE.type)
        original = next(item.data for item in open_bag(bag).messages(['/slider_state']) if item.sequence == 0)
        numbers = layout.numbers(original)
        assert numbers is not None
        place = layout.names.index('position')
        assert numbers[place] == 0.0
        zero = original[:12] + layout.pack(0, *numbers[:place], -0.0, *numbers[place + 1:])[12:]
        later = original[:8] + struct.pack('<I', 1) + original[12:]
        for data, field in ((zero, 'position'), (later, 'header.stamp')):
            folder = rewritten(bag, tmp_path / field, message=replacing('/slider_state', 0, data))
            difference = verify(read_run(folder)).difference
            assert difference is not None
            assert difference.field == field

    def test_a_transition_too_few_and_one_too_many(self, bag: Path, tmp_path: Path) -> None:
        times = {item.sequence: item.log_time for item in open_bag(bag).messages(['/mode_event'])}
        step = list(times)[3]
        less = rewritten(bag, tmp_path / 'less', message=lambda topic, number, data: (
            None if (topic, number) == ('/mode_event', step) else data))
        difference = verify(read_run(less)).difference
        assert difference is not None
        assert (difference.step, difference.recorded) == (step, None)
        assert difference.time == difference.made == pytest.approx(times[step] * 1e-9, abs=1e-9)
        more = rewritten(bag, tmp_path / 'more', definition=lambda text: text)
        other = simulated(tmp_path / 'other', 'paper_fig8', 3.0, 'axis.normal_force=3000.0')
        scene = (open_bag(other).attachments['scene.yaml'])
        mixed = rewritten(more, tmp_path / 'mixed', contents=lambda name, data: scene if name == 'scene.yaml' else data)
        assert verify(read_run(mixed)).difference is not None

    def test_what_it_says(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        layout = flat_layout(SLIDER_STATE.type)
        original = next(item.data for item in open_bag(bag).messages(['/slider_state']) if item.sequence == 1500)
        numbers = layout.numbers(original)
        assert numbers is not None
        data = original[:12] + layout.pack(0, numbers[0], numbers[1], 0.25, *numbers[3:])[12:]
        folder = rewritten(bag, tmp_path / 'odd', message=replacing('/slider_state', 1500, data),
                           metadata=lambda facts: {**facts, 'numpy': '1.0'})
        code, out, err = verified(capsys, folder)
        assert code == 3
        assert out.startswith('differs after 1500 steps, ')
        assert 'recorded with numpy 1.0 (here ' in out
        assert (f'step 1500 (t = 1.5 s), /slider_state position: recorded 0.25, re-simulated {numbers[2]!r}, '
                f'difference {numbers[2] - 0.25:.3g}') in err


def nudged(number: float) -> float:
    """Return a number that differs as little as its kind allows, and still fits its field."""
    if isinstance(number, int):
        return number + 1
    (bits,) = struct.unpack('<q', struct.pack('<d', number))
    nearest: float = struct.unpack('<d', struct.pack('<q', bits ^ 1))[0]
    return nearest


def replacing(topic: str, sequence: int, data: bytes) -> Callable[[str, int, bytes], bytes]:
    return lambda name, number, original: data if (name, number) == (topic, sequence) else original
