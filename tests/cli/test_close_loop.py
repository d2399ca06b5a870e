# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip close-loop`: controllers from files."""

import json
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest

from stickslip_sim.check.verification import verify
from stickslip_sim.controllers.own_controller import load_controller, parse_gain
from stickslip_sim.core.errors import InputError
from stickslip_sim.recording import read_run
from tests.support.tool import Capture, answered, done, refusals, refused

OWN = '''
from dataclasses import dataclass
from own_gains import DEFAULT

@dataclass
class Own:
    kp: float = DEFAULT
    name: str = ''

    def __call__(self, t, measured):
        return measured.setpoint.velocity + self.kp * (measured.setpoint.position - measured.slider_position)

def still(t, measured):
    return 0.0

def agrees(t, measured):
    return True

def fails(t, measured):
    return 0.01 / (0.05 - t)

class Needs:
    def __init__(self, kp):
        raise ValueError('kp is too large')

ready, number = Own(3.0), 3
'''
LOOP = '--scene', 'positioning', '--duration', '0.2'


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the working directory, with a controller, a setpoint and limits."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / 'own_gains.py').write_text('DEFAULT = 5.0\n')
    (tmp_path / 'own.py').write_text(OWN)
    (tmp_path / 'move.csv').write_text('time,position\n0,0\n1,0.002\n')
    (tmp_path / 'limits.yaml').write_text('limits: {peak_speed: {max: 1.0}}\n')
    (tmp_path / 'narrow.yaml').write_text('limits: {following_error: {max: 1.0e-9}}\n')
    return tmp_path


def test_a_run_with_all_that_it_can_write(folder: Path, capsys: Capture) -> None:
    code, out, err = answered(
        capsys, 'close-loop', 'own.py:Own', *LOOP, '--setpoint', 'move.csv', '--gain', 'kp=8', '--gain', 'name=mine',
        '--rate', '500', '--limits', 'limits.yaml', '--out', 'runs/mine', '--plot', 'mine.png', '--junit', 'mine.xml',
        '--json', 'mine.json', '--set', 'encoder.resolution=1e-6')
    assert (code, err) == (0, '')
    assert out.startswith('positioning: 0.2 s with the exact solver\n')
    assert 'PASSED: 1 of 1' in out
    assert out.endswith('written: runs/mine, mine.png, mine.json, mine.xml\n')
    recorded = read_run('runs/mine')
    assert verify(recorded).difference is None
    assert len(recorded.commands['time']) == 100
    assert recorded.scene.values['encoder.resolution'] == 1e-6
    found = json.loads((folder / 'mine.json').read_text())
    assert found['passed'] is True
    assert found['receipt']['controller'] == {
        'name': 'Own', 'rate': 500.0, 'command': 'stickslip close-loop own.py:Own --scene positioning --duration 0.2 '
        '--rate 500.0 --setpoint move.csv --gain kp=8 --gain name=mine --set encoder.resolution=1e-6'}
    assert ElementTree.parse(folder / 'mine.xml').getroot().get('failures') == '0'
    assert answered(capsys, 'check', 'runs/mine', '--limits', 'limits.yaml')[0] == 0
    assert answered(capsys, 'verify', 'runs/mine')[1].startswith('identical, 201 steps')
    code, said, _ = answered(capsys, 'verify', 'runs/mine', '--set', 'axis.mass=300', '--set', 'friction.scale=1.2')
    *_, largest, rms, note = said.splitlines()
    error = recorded.setpoint['position'] - recorded.samples['position']
    assert (largest.split()[0], rms.split()[0]) == ('following_error', 'following_error_rms')
    assert f'{1e6 * abs(error).max():.5g} µm' in largest
    assert note.startswith('note: the commands are those of the recording; a controller that sees the other axis ')
    assert note.endswith(f": {found['receipt']['controller']['command']} --set axis.mass=300 --set friction.scale=1.2")


def test_a_limit_that_is_not_kept(folder: Path, capsys: Capture) -> None:
    code, out, err = answered(capsys, 'close-loop', 'own.py:Own', *LOOP, '--setpoint', 'move.csv', '--limits',
                              'narrow.yaml', '--out', 'run')
    assert code == 3
    assert 'FAILED: 1 of 1: following_error' in out
    assert err == 'stickslip: positioning does not keep narrow.yaml: following_error\n'
    assert (folder / 'run' / 'metadata.yaml').is_file()


def test_to_standard_output(capsys: Capture) -> None:
    out = done(capsys, 'close-loop', 'own.py:still', *LOOP, '--json', '-')
    assert json.loads(out)['receipt']['controller']['name'] == 'still'


@pytest.mark.parametrize('row', refusals(Path(__file__).with_name('close_loop_refusals.txt')), ids=lambda row: row[0])
def test_refused_in_one_line_and_nothing_is_written(row: list[str], folder: Path, capsys: Capture) -> None:
    given, *words = row
    (folder / 'raises.py').write_text('1 / 0\n')
    (folder / 'leaves.py').write_text('import sys\nsys.exit(3)\n')
    (folder / 'wrong.py').write_text('def f(:\n')
    before = {path.name for path in folder.iterdir()}
    refused(capsys, 'close-loop', *LOOP, *shlex.split(given), '--out', 'run', '--plot', 'run.png', words=words)
    assert {path.name for path in folder.iterdir()} - {'__pycache__'} == before


class TestLoading:
    def test_classes_functions_and_objects(self) -> None:
        assert load_controller('own.py:Own', {'kp': 2.0}).kp == 2.0
        assert load_controller('own.py:Own').kp == 5.0
        assert load_controller('own.py:still')(0.0, None) == 0.0
        assert load_controller('own.py:ready').kp == 3.0

    def test_a_file_is_read_again(self, folder: Path) -> None:
        assert load_controller('own.py:Own').kp == 5.0
        (folder / 'own.py').write_text(OWN.replace('kp: float = DEFAULT', 'kp: float = 66.0'))
        assert load_controller(f'{folder}/own.py:Own').kp == 66.0

    @pytest.mark.parametrize(('text', 'value'), [
        ('kp=4', 4), ('kp=4e-3', 4e-3), ('kp=-2', -2), ('kp=fast', 'fast'), ('kp=(1.0, 2)', (1.0, 2)),
        ('kp=a=b', 'a=b'),
    ])
    def test_gains(self, text: str, value: object) -> None:
        assert parse_gain(text) == ('kp', value)

    @pytest.mark.parametrize('text', ['kp', '=4', 'kp=', 'k p=4', '4=k'])
    def test_no_gains(self, text: str) -> None:
        with pytest.raises(InputError, match='--gain'):
            parse_gain(text)
