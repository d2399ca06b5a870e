# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify` on bags of the tool: identical, or what differs and how quickly it is found."""

import json
import struct
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from stickslip_sim import load_scene, simulate
from stickslip_sim.bags.topics import FRICTION_FORCE, SLIDER_STATE, Topic
from stickslip_sim.check import verification
from stickslip_sim.check.remake import doubts_about
from stickslip_sim.check.verification import Difference, Verdict, same_bytes, verify
from stickslip_sim.cli.main import run
from stickslip_sim.core.errors import RecordingWarning, StickslipError
from stickslip_sim.core.types import EventKind
from stickslip_sim.plots.style import save
from stickslip_sim.recording import RunFacts, flat_layout, open_bag, read_run
from stickslip_sim.recording.offline_bag import write_blocks
from stickslip_sim.report.values import plain
from stickslip_sim.runs import simulate_events
from tests.support.check_files import cut, verified
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture, refused

STEPS, EVENTS = 3001, 17     # of that bag
FAULTS = ('faults.ids=[dry, knock]', 'faults.kinds=[friction_scale, force_pulse]', 'faults.starts=[0.3, 0.7004]',
          'faults.durations=[0.5, 0.0125]', 'faults.values=[1.5, 900.0]')


def simulated(folder: Path, scene: str, duration: float, *changes: str) -> Path:
    options = [word for change in changes for word in ('--set', change)]
    assert run(['simulate', scene, '--duration', str(duration), '--bag', str(folder), *options]) == 0
    return folder


class TestIdentical:
    def test_what_it_says(self, fig8_bag: Path, capsys: Capture) -> None:
        assert verified(capsys, fig8_bag) == (0, f'identical, {STEPS} steps, {EVENTS} events, up to t = 3 s\n', '')

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

    def test_an_mcap_file_in_another_namespace(self, fig8_bag: Path, tmp_path: Path) -> None:
        rewritten(fig8_bag, tmp_path / 'cell', lambda name: f'/cell{name}' if name != '/parameter_events' else name)
        assert verify(read_run(tmp_path / 'cell' / 'run_0.mcap')).steps == STEPS


def of_step(bag: Path, topic: Topic, step: int) -> tuple[bytes, list[Any]]:
    """Return the message of a step, and its numbers."""
    data = next(item.data for item in open_bag(bag).messages([f'/{topic.name}']) if item.sequence == step)
    numbers = flat_layout(topic.type).numbers(data)
    assert numbers is not None
    return data, list(numbers)


def with_number(topic: Topic, original: bytes, numbers: list[Any], field: str, number: float) -> bytes:
    """Return a message with another number in a field."""
    layout = flat_layout(topic.type)
    place = layout.names.index(field)
    return original[:12] + layout.pack(0, *numbers[:place], number, *numbers[place + 1:])[12:]


def difference_of(folder: Path) -> Difference:
    difference = verify(read_run(folder)).difference
    assert difference is not None
    return difference


class TestDifferent:
    @pytest.mark.parametrize('topic', [SLIDER_STATE, FRICTION_FORCE])
    def test_every_field_to_the_last_bit(self, topic: Topic, tmp_path: Path) -> None:
        bag = simulated(tmp_path / 'short', 'paper_fig8', 0.06, 'initial.velocity=0.02')
        name, (original, numbers) = f'/{topic.name}', of_step(bag, topic, 50)
        for field, number in zip(flat_layout(topic.type).names, numbers, strict=True):
            data = with_number(topic, original, numbers, field, nudged(number))
            found = difference_of(rewritten(bag, tmp_path / field, message=replacing(name, 50, data)))
            assert (found.step, found.topic, found.field) == (50, name, field)
            assert (found.recorded, found.made) == (nudged(number), number)

    def test_a_sign_of_zero_and_a_stamp(self, fig8_bag: Path, tmp_path: Path) -> None:
        original, numbers = of_step(fig8_bag, SLIDER_STATE, 0)
        zero = with_number(SLIDER_STATE, original, numbers, 'position', -0.0)
        assert zero != original
        later = original[:8] + struct.pack('<I', 1) + original[12:]
        for data, field in ((zero, 'position'), (later, 'header.stamp')):
            folder = rewritten(fig8_bag, tmp_path / field, message=replacing('/slider_state', 0, data))
            assert difference_of(folder).field == field

    def test_a_transition_too_few_and_one_too_many(self, fig8_bag: Path, tmp_path: Path) -> None:
        times = {item.sequence: item.log_time for item in open_bag(fig8_bag).messages(['/mode_event'])}
        step = list(times)[3]
        less = rewritten(fig8_bag, tmp_path / 'less', message=lambda topic, number, data: (
            None if (topic, number) == ('/mode_event', step) else data))
        difference = difference_of(less)
        assert (difference.step, difference.recorded) == (step, None)
        assert difference.time == difference.made == pytest.approx(times[step] * 1e-9, abs=1e-9)
        other = simulated(tmp_path / 'other', 'paper_fig8', 3.0, 'axis.normal_force=3000.0')
        scene = open_bag(other).attachments['scene.yaml']
        mixed = rewritten(fig8_bag, tmp_path / 'mixed', contents=lambda name, data: (
            scene if name == 'scene.yaml' else data))
        assert difference_of(mixed)

    def test_what_it_says(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        original, numbers = of_step(fig8_bag, SLIDER_STATE, 1500)
        data = with_number(SLIDER_STATE, original, numbers, 'position', 0.25)
        folder = rewritten(fig8_bag, tmp_path / 'odd', message=replacing('/slider_state', 1500, data),
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


DURATION = 4.0


@pytest.fixture(scope='module', params=['cutting_force', 'paper_fig8', 'positioning'])
def offline(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of an offline run."""
    scene = load_scene(request.param)
    folder = tmp_path_factory.mktemp('runs') / 'run'
    run = simulate(scene, DURATION)
    write_blocks(folder, RunFacts.of(scene, DURATION, scene.time.step), run.sample_blocks(), run.events, {})
    return folder


def of_both(folder: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Verdict, Verdict]:
    """Return what verify says as it is, and without the quick comparison."""
    run = read_run(folder)
    quick = verify(run)
    monkeypatch.setattr(verification, 'same_bytes', lambda *_: None)
    return quick, verify(run)


def test_a_whole_run(offline: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The quick comparison finds it the same, with the same figures as step by step."""
    scene = load_scene(read_run(offline).scene.name)
    assert same_bytes(read_run(offline), simulate(scene, DURATION)) is not None
    quick, slow = of_both(offline, monkeypatch)
    assert quick == slow


@pytest.mark.parametrize('share', [0.3, 0.5, 0.8])
def test_a_run_that_was_cut_off(offline: Path, share: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As far as it goes, up to its last whole step."""
    with pytest.warns(RecordingWarning, match='no end'):
        quick, slow = of_both(cut(offline, tmp_path / 'cut', share), monkeypatch)
    assert quick == slow


@pytest.mark.parametrize('name', ['position', 'friction_force', 'drive_velocity', 'direction', 'a transition'])
def test_a_changed_bit_is_found_step_by_step(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The quick comparison does not decide on it, nor on a transition that is missing."""
    scene = load_scene('paper_fig8')
    run = simulate(scene, DURATION)
    samples, events = dict(run.samples), list(run.events)
    if name in samples:
        samples[name] = samples[name].copy()
        samples[name][2500] = np.nextafter(samples[name][2500], 9.0) if name != 'direction' else -1.0
    else:
        del events[-1]
    write_blocks(tmp_path / 'run', RunFacts.of(scene, DURATION, scene.time.step), [samples], events, {})
    assert same_bytes(read_run(tmp_path / 'run'), run) is None
    quick, slow = of_both(tmp_path / 'run', monkeypatch)
    assert quick == slow
    assert quick.difference is not None
    assert name not in samples or quick.difference.step == 2500


def test_a_shorter_run_is_not_a_longer_one(offline: Path) -> None:
    """Steps beyond the end of the run made again are not the same as nothing."""
    run = read_run(offline)
    assert same_bytes(run, simulate(run.scene, DURATION / 2)) is None


# `stickslip verify` on bags that are cut, damaged, altered or foreign, and with --set.

class TestCutAndDamaged:
    @pytest.mark.parametrize('share', [0.3, 0.5, 0.77, 0.999])
    def test_as_far_as_it_goes(self, share: float, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        code, out, _ = verified(capsys, cut(fig8_bag, tmp_path / 'cut', share))
        first, second = out.splitlines()
        assert first == 'note: the recording has no end: cut off, or still being written'
        assert code == 0
        assert second.startswith('identical as far as it goes, ')
        steps = int(second.split()[6])
        assert 0.5 * share * STEPS < steps <= STEPS
        assert second.endswith(f'up to t = {(steps - 1) / 1000:.9g} s')

    def test_before_the_first_message(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        stump = cut(fig8_bag, tmp_path / 'cut', 0.01)
        assert 'cut off before its first message was written' in refused(capsys, 'verify', stump)

    def test_no_damage_goes_unnoticed_or_is_an_internal_error(self, fig8_bag: Path, tmp_path: Path) -> None:
        """One bit, in the part of the file that holds the run: refused, never "identical"."""
        data, stream, path = next(fig8_bag.glob('*.mcap')).read_bytes(), Random(7), tmp_path / 'run_0.mcap'
        end = data.rindex(b'receipt.json')   # its index; what follows only helps to find things
        for _ in range(40):
            damaged = bytearray(data)
            damaged[stream.randrange(8, int(0.9 * end))] ^= 1 << stream.randrange(8)
            path.write_bytes(damaged)
            with pytest.raises(StickslipError, match='damaged: it was closed properly'):
                read_run(path)

    def test_lost_messages(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        lost = {700, 701, 1500}
        folder = rewritten(fig8_bag, tmp_path / 'less', contents=dropped_three, message=lambda topic, number, data: (
            None if number in lost and topic in ('/slider_state', '/friction_force') else data))
        code, out, _ = verified(capsys, folder)
        assert code == 0
        assert out.splitlines()[:2] == ['note: 3 messages were dropped while recording',
                                        'note: 3 steps have no recorded state']
        assert f'identical, {STEPS - 3} steps, ' in out


def dropped_three(name: str, data: bytes) -> bytes:
    return json.dumps({**json.loads(data), 'dropped_messages': 3}).encode() if name == 'receipt.json' else data


def with_scene(content: bytes) -> dict[str, Any]:
    return {'contents': lambda name, data: content if name == 'scene.yaml' else data}


def with_checkpoint(content: bytes) -> dict[str, Any]:
    return {'metadata': lambda facts: {**facts, 'origin': 'node'},
            'attachment': lambda name: 'checkpoint.json' if name == 'receipt.json' else name,
            'contents': lambda name, data: content if name == 'receipt.json' else data}


def made(**facts: str) -> dict[str, Any]:
    return {'metadata': lambda _: facts}


def defined(old: str, new: str) -> dict[str, Any]:
    return {'definition': lambda text: text.replace(old, new)}


def without(topic: str) -> dict[str, Any]:
    return {'topic': lambda name: None if name == topic else name}


class TestAlteredAndForeign:
    @pytest.mark.parametrize(('changes', 'reported'), [
        (with_scene(b'axis: ['), 'its scene.yaml is not valid in this version'),
        (with_scene(b'/**:\n  ros__parameters:\n    axis: {weight: 1.0}\n'), 'axis.weight'),
        (with_scene(b'\xff\xfe\x00'), 'its scene.yaml is not valid in this version'),
        (with_checkpoint(b'{'), 'its checkpoint.json is not a JSON object'),
        (with_checkpoint(b'{}'), "damaged or of another version: 'drive'"),
        (with_checkpoint(b'[]'), 'damaged or of another version'),
        (with_checkpoint(b'\xff'), 'its checkpoint.json is not a JSON object'),
        (made(), 'does not say whether a node or the tool made it'),
        (made(origin='offline', duration='long', sample_period='1/1000'), 'does not say whether'),
        (made(origin='offline', duration='3.0', sample_period='1/0'), 'does not say whether'),
        (made(origin='offline', duration='-3.0', sample_period='1/1000'), 'duration = -3.0'),
        (made(origin='offline', duration='2.0', sample_period='1/1000'), 'beyond the duration'),
        *((without(topic), 'no topic of type stickslip_msgs/msg/')
          for topic in ('/slider_state', '/friction_force', '/mode_event')),
        (defined('rest_time', 'stick_time'), 'its field stick_time is unknown here'),
        (defined('float64 rest_time', 'string rest_time'), 'has other fields than a step'),
        (defined('float64', 'float 64'), '/msg/ModeEvent cannot be read: Could not parse'),
        ({'attachment': lambda name: None}, 'it has no scene.yaml'),
    ])
    def test_refused(self, changes: dict[str, Any], reported: str, fig8_bag: Path, tmp_path: Path, capsys: Capture
                     ) -> None:
        code, _, err = verified(capsys, rewritten(fig8_bag, tmp_path / 'other', **changes))
        assert code == 2
        assert reported in err

    def test_another_version(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        folder = rewritten(fig8_bag, tmp_path / 'old', metadata=lambda facts: {**facts, 'version': '0.0.9'})
        code, out, _ = verified(capsys, folder)
        assert code == 0
        assert out.startswith('note: recorded by stickslip 0.0.9, this is ')

    def test_a_scene_that_was_changed(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        folder = rewritten(fig8_bag, tmp_path / 'other', contents=lambda name, data: data.replace(b'350.0', b'350.5'))
        code, out, err = verified(capsys, folder)
        assert code == 3
        assert out.startswith('note: scene.yaml was changed after the recording\ndiffers after 0 steps')
        assert 'step 0 (t = 0 s), /slider_state acceleration: recorded ' in err

    def test_no_run(self, tmp_path: Path, capsys: Capture) -> None:
        (tmp_path / 'empty').mkdir()
        assert 'no recorded run there' in refused(capsys, 'verify', tmp_path / 'empty')
        assert 'no such run' in refused(capsys, 'verify', tmp_path / 'nothing')


class TestWhatIf:
    def test_figures_of_both(self, fig8_bag: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
                             ) -> None:
        words: list[str] = []

        def look(figure: Figure, path: Path) -> None:
            words.extend(text.get_text() for text in figure.findobj(Text))
            save(figure, path)

        monkeypatch.setattr('stickslip_sim.plots.style.save', look)
        out = tmp_path / 'out'
        settings = ('--set', 'axis.normal_force=3000.0', '--set', 'drive.velocity=0.003')
        code, report, _ = verified(capsys, fig8_bag, *settings, '--out', out)
        assert code == 0
        assert [line.split() for line in report.splitlines()[1:3]] == [
            ['recorded', 'what', 'if'], ['motion', 'stick-slip', 'stick-slip']]
        assert sorted(path.name for path in out.iterdir()) == ['scene.yaml', 'what_if.json', 'what_if.png']
        figures = json.loads((out / 'what_if.json').read_text())
        changes = {'axis.normal_force': 3000.0, 'drive.velocity': 0.003}
        assert figures['changes'] == changes
        summary = simulate_events(load_scene('paper_fig8', changes), 3.0).summary
        assert figures['what_if'] == plain(summary) | {'events': figures['what_if']['events']}
        assert figures['what_if']['events']['breakaway'] == summary.events[EventKind.BREAKAWAY]
        mean = simulate_events(load_scene('paper_fig8'), 3.0).summary.mean
        assert mean is not None
        assert figures['recorded']['mean']['period'] == pytest.approx(mean.period, rel=1e-13)
        assert load_scene(str(out / 'scene.yaml')).values == load_scene('paper_fig8', changes).values
        assert (out / 'what_if.png').stat().st_size > 20_000
        assert 'eight (paper_fig8, recorded)' in words    # which run, and not only of which scene
        assert 'what if axis.normal_force = 3000.0, drive.velocity = 0.003' in words

    def test_refused(self, fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        for words, reported in (
                (('--out', tmp_path / 'out'), '--out needs --set'),
                (('--set', 'axis.mass'), "--set = 'axis.mass'"),
                (('--set', 'axis.mass=-1.0'), 'axis.mass = -1.0'),
                (('--set', 'axis.weight=1.0'), 'axis.weight'),
                (('--set', 'axis.mass=300.0', '--out', tmp_path), 'a folder that does not exist')):
            assert reported in refused(capsys, 'verify', fig8_bag, *words)
        assert list(tmp_path.iterdir()) == []
