# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify` on bags that are cut, damaged, altered or foreign, and with --set."""

import json
from pathlib import Path
from random import Random

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from stickslip_sim.cli.main import run
from stickslip_sim.core.errors import StickslipError
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.style import save
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate_events
from stickslip_sim.runs.receipt import plain
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture
from tests.support.verify_tool import refused, verified

STEPS = 3001   # of the bag


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('runs') / 'eight'
    assert run(['simulate', 'paper_fig8', '--duration', '3', '--bag', str(folder)]) == 0
    return folder


def data_of(bag: Path) -> bytes:
    return next(bag.glob('*.mcap')).read_bytes()


def written(folder: Path, data: bytes) -> Path:
    folder.mkdir()
    (folder / 'run_0.mcap').write_bytes(data)
    return folder


class TestCutAndDamaged:
    @pytest.mark.parametrize('share', [0.3, 0.5, 0.77, 0.999])
    def test_as_far_as_it_goes(self, share: float, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        data = data_of(bag)
        code, out, _ = verified(capsys, written(tmp_path / 'cut', data[:int(share * len(data))]))
        first, second = out.splitlines()
        assert first == 'note: the recording has no end: cut off, or still being written'
        assert code == 0
        assert second.startswith('identical as far as it goes, ')
        steps = int(second.split()[6])
        assert 0.5 * share * STEPS < steps <= STEPS
        assert second.endswith(f'up to t = {(steps - 1) / 1000:.9g} s')

    def test_before_the_first_message(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        folder = written(tmp_path / 'cut', data_of(bag)[:4000])
        assert 'cut off before its first message was written' in refused(capsys, folder)

    def test_no_damage_goes_unnoticed_or_is_an_internal_error(self, bag: Path, tmp_path: Path) -> None:
        """One bit, in the part of the file that holds the run: refused, never "identical"."""
        data = data_of(bag)
        stream = Random(7)
        end = data.rindex(b'receipt.json')   # its index; what follows only helps to find things
        for trial in range(40):
            damaged = bytearray(data)
            damaged[stream.randrange(8, int(0.9 * end))] ^= 1 << stream.randrange(8)
            with pytest.raises(StickslipError, match='damaged: it was finished'):
                read_run(written(tmp_path / str(trial), bytes(damaged)))

    def test_lost_messages(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        lost = {700, 701, 1500}
        folder = rewritten(bag, tmp_path / 'less', contents=dropped_three, message=lambda topic, number, data: (
            None if number in lost and topic in ('/slider_state', '/friction_force') else data))
        code, out, _ = verified(capsys, folder)
        assert code == 0
        assert out.splitlines()[:2] == ['note: 3 messages were dropped while recording',
                                        'note: 3 steps have no recorded state']
        assert f'identical, {STEPS - 3} steps, ' in out


def dropped_three(name: str, data: bytes) -> bytes:
    return json.dumps({**json.loads(data), 'dropped_messages': 3}).encode() if name == 'receipt.json' else data


class TestAlteredAndForeign:
    def test_another_version(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        folder = rewritten(bag, tmp_path / 'old', metadata=lambda facts: {**facts, 'version': '0.0.9'})
        code, out, _ = verified(capsys, folder)
        assert code == 0
        assert out.startswith('note: recorded by stickslip 0.0.9, this is ')

    def test_a_scene_that_was_changed(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        folder = rewritten(bag, tmp_path / 'other', contents=lambda name, data: data.replace(b'350.0', b'350.5'))
        code, out, err = verified(capsys, folder)
        assert code == 3
        assert out.startswith('note: scene.yaml was changed after the recording\ndiffers after 0 steps')
        assert 'step 0 (t = 0 s), /slider_state acceleration: recorded ' in err

    @pytest.mark.parametrize(('content', 'reported'), [
        (b'axis: [', 'its scene.yaml is none of this version'),
        (b'/**:\n  ros__parameters:\n    axis: {weight: 1.0}\n', 'axis.weight'),
        (b'\xff\xfe\x00', 'its scene.yaml is none of this version'),
    ])
    def test_a_scene_of_another_kind(self, content: bytes, reported: str, bag: Path, tmp_path: Path, capsys: Capture
                                     ) -> None:
        folder = rewritten(bag, tmp_path / 'other', contents=lambda name, data: (
            content if name == 'scene.yaml' else data))
        assert reported in refused(capsys, folder)

    @pytest.mark.parametrize(('content', 'reported'), [
        (b'{', 'its checkpoint.json is no JSON object'), (b'{}', "damaged or of another version: 'drive'"),
        (b'[]', 'damaged or of another version'), (b'\xff', 'its checkpoint.json is no JSON object'),
    ])
    def test_a_checkpoint_of_another_kind(self, content: bytes, reported: str, bag: Path, tmp_path: Path,
                                          capsys: Capture) -> None:
        folder = rewritten(bag, tmp_path / 'other', metadata=lambda facts: {**facts, 'origin': 'node'},
                           attachment=lambda name: 'checkpoint.json' if name == 'receipt.json' else name,
                           contents=lambda name, data: content if name == 'receipt.json' else data)
        assert reported in refused(capsys, folder)

    @pytest.mark.parametrize(('facts', 'reported'), [
        ({}, 'does not say whether a node or the tool made it'),
        ({'origin': 'offline', 'duration': 'long', 'sample_period': '1/1000'}, 'does not say whether'),
        ({'origin': 'offline', 'duration': '3.0', 'sample_period': '1/0'}, 'does not say whether'),
        ({'origin': 'offline', 'duration': '-3.0', 'sample_period': '1/1000'}, 'duration = -3.0'),
        ({'origin': 'offline', 'duration': '2.0', 'sample_period': '1/1000'}, 'beyond the duration'),
    ])
    def test_what_made_it_is_unknown(self, facts: dict[str, str], reported: str, bag: Path, tmp_path: Path,
                                     capsys: Capture) -> None:
        code, _, err = verified(capsys, rewritten(bag, tmp_path / 'other', metadata=lambda _: facts))
        assert code == 2
        assert reported in err

    @pytest.mark.parametrize('topic', ['/slider_state', '/friction_force', '/mode_event'])
    def test_a_missing_topic(self, topic: str, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        rewritten(bag, tmp_path / 'less', lambda name: None if name == topic else name)
        assert 'no topic of type stickslip_msgs/msg/' in refused(capsys, tmp_path / 'less')

    def test_messages_of_another_version(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        rewritten(bag, tmp_path / 'old', definition=lambda text: text.replace('rest_time', 'stick_time'))
        assert 'its field stick_time is unknown here' in refused(capsys, tmp_path / 'old')
        rewritten(bag, tmp_path / 'odd', definition=lambda text: text.replace('float64 rest_time', 'string rest_time'))
        assert 'has other fields than a step' in refused(capsys, tmp_path / 'odd')
        rewritten(bag, tmp_path / 'none', definition=lambda text: text.replace('float64', 'float 64'))
        assert '/msg/ModeEvent cannot be read: Could not parse' in refused(capsys, tmp_path / 'none')

    def test_no_run_of_ours(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        (tmp_path / 'empty').mkdir()
        assert 'no recorded run there' in refused(capsys, tmp_path / 'empty')
        assert 'no such run' in refused(capsys, tmp_path / 'nothing')
        rewritten(bag, tmp_path / 'bare', attachment=lambda name: None)
        assert 'no scene.yaml travels in it' in refused(capsys, tmp_path / 'bare')


class TestWhatIf:
    def test_figures_of_both(self, bag: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
        words: list[str] = []

        def look(figure: Figure, path: Path) -> None:
            words.extend(text.get_text() for text in figure.findobj(Text))
            save(figure, path)

        monkeypatch.setattr('stickslip_sim.plots.what_if.save', look)
        out = tmp_path / 'out'
        code, report, _ = verified(capsys, bag, '--set', 'axis.normal_force=3000.0', '--set', 'drive.velocity=0.003',
                                   '--out', out)
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

    def test_the_picture_is_titled_by_the_run(self, bag: Path, tmp_path: Path, capsys: Capture,
                                              monkeypatch: pytest.MonkeyPatch) -> None:
        titles: list[str] = []
        monkeypatch.setattr('stickslip_sim.plots.plot_beside', lambda was, would_be, title, path: titles.append(title))
        verified(capsys, bag, '--set', 'drive.velocity=0.003', '--out', tmp_path / 'out')
        assert titles == [f'{bag.name} (paper_fig8, recorded)\nwhat if drive.velocity = 0.003']

    def test_refused(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        for words, reported in (
                (('--out', tmp_path / 'out'), '--out is of no use alone'),
                (('--set', 'axis.mass'), "--set = 'axis.mass'"),
                (('--set', 'axis.mass=-1.0'), 'axis.mass = -1.0'),
                (('--set', 'axis.weight=1.0'), 'axis.weight'),
                (('--set', 'axis.mass=300.0', '--out', tmp_path), 'a folder that does not exist')):
            assert reported in refused(capsys, bag, *words)
        assert list(tmp_path.iterdir()) == []
