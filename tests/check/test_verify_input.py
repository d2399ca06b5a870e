# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify` on bags that are cut, damaged, altered or foreign, and with --set."""

import json
from pathlib import Path
from random import Random
from typing import Any

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from stickslip_sim.core.errors import StickslipError
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.style import save
from stickslip_sim.recording import read_run
from stickslip_sim.report.values import plain
from stickslip_sim.runs import simulate_events
from tests.support.check_files import cut
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture
from tests.support.verify_tool import refused, verified

STEPS = 3001   # of that bag


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
        assert 'cut off before its first message was written' in refused(capsys, cut(fig8_bag, tmp_path / 'cut', 0.01))

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
        assert 'no recorded run there' in refused(capsys, tmp_path / 'empty')
        assert 'no such run' in refused(capsys, tmp_path / 'nothing')


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
            assert reported in refused(capsys, fig8_bag, *words)
        assert list(tmp_path.iterdir()) == []
