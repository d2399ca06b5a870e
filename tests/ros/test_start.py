# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The start of the programs: what is refused, in one line, and what their parameter files give."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from tests.support.axis_here import axis_here
from tests.support.node_processes import executable, refusal_of

pytestmark = [pytest.mark.ros, pytest.mark.slow]


def refused(*command: str, **options: Any) -> str:
    """Return the one line in which an installed program refuses to start."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, **options)
    line: str = done.stderr
    assert (done.returncode, done.stdout, line.count('\n')) == (2, '', 1), line
    return line


class TestRefusedStart:
    @pytest.mark.parametrize('text', [
        *(f'/**:\n  ros__parameters:\n    scene: mine\n    {content}\n' for content in (
            'axis: {mass: -1.0}', 'axis: {weight: 1.0}', 'axis: {mass: heavy}', 'axis: [',
            'friction: {kinetic: {velocities: [0.0, 1], coefficients: [0.1, 0.1]}}')),
        '', '/**:\n  ros__parameters:\n', '/**:\n  ros__parameters:\n    seed: 3\n',
        '/**:\n  ros__parameters:\n    scene: a\n---\n/**:\n  ros__parameters:\n    scene: b\n',
        '/**:\n  ros__parameters:\n    scene: mine.yaml\n', '/**:\n  ros__parameters:\n    axis: {mass: 0.0}\n',
    ])
    def test_in_the_words_of_the_tool(self, tmp_path: Path, text: str) -> None:
        file = tmp_path / 'scene.yaml'
        file.write_text(text)
        with pytest.raises(InputError) as of_the_tool:
            load_scene(str(file))
        with pytest.raises(InputError) as of_the_node, axis_here('--params-file', file):
            pass
        assert str(of_the_node.value) == str(of_the_tool.value)

    @pytest.mark.parametrize(('name', 'value', 'reported'), [
        ('ROS_DOMAIN_ID', '9999', '0 to 232'), ('ROS_DOMAIN_ID', '-1', '0 to 232'), ('ROS_DOMAIN_ID', 'x', '0 to 232'),
        ('ROS_STATIC_PEERS', 'no address', 'Unable to resolve peer'), ('ROS_LOG_DIR', '/proc/x', '/proc/x'),
        ('AMENT_PREFIX_PATH', '', 'setup.bash'), ('RMW_IMPLEMENTATION', 'rmw_smoke_signals', 'rmw_fastrtps_cpp'),
    ])
    def test_by_the_environment(self, monkeypatch: pytest.MonkeyPatch, name: str, value: str, reported: str) -> None:
        program = executable('sim_node')
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')    # that has peers
        monkeypatch.setenv(name, value)
        is_read_at_import = name in ('AMENT_PREFIX_PATH', 'RMW_IMPLEMENTATION')
        line = refused(program) if is_read_at_import else refusal_of('sim_node')
        assert value in line
        assert reported in line

    @pytest.mark.parametrize(('settings', 'reported'), [
        ({'ENABLE': 'True'}, "ENABLE = 'True' is refused: must be true or false"),
        ({'ENABLE': 'true', 'STRATEGY': 'enforce'}, "STRATEGY = 'enforce' is refused: must be Enforce or Permissive"),
        ({'ENABLE': 'true', 'STRATEGY': 'Enforce'}, "KEYSTORE = '' is refused: must be the folder of the keys"),
        ({'ENABLE': 'true', 'STRATEGY': 'Enforce', 'KEYSTORE': '.'}, "ENABLE = 'true' is refused"),
    ])
    def test_security_names_its_variables(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
                                          settings: dict[str, str], reported: str) -> None:
        monkeypatch.chdir(tmp_path)
        for name, value in settings.items():
            monkeypatch.setenv(f'ROS_SECURITY_{name}', value)
        line = refusal_of('sim_node', '--enclave', '/stickslip/feed_axis')
        assert line.startswith(f'sim_node: ROS_SECURITY_{reported}'), line

    @pytest.mark.parametrize(('words', 'reported'), [
        (['axis.mas:=1.0'], ['axis.mas = 1.0', 'did you mean axis.mass?']),
        (['scene:=paper_fig9'], ['paper_fig9', 'paper_fig8']),
        (['--nonsense'], ['--nonsense']), (['--params-file', 'nowhere.yaml'], ['nowhere.yaml', 'No such file']),
        (['record.enabled:=true', 'axis.mass:=-1.0'], ['axis.mass = -1.0']),
        (['solver.name:=adaptive'], ['solver.name', 'exact or fixed_step in the node']),
        (['drive.velocity:=5.0'], ['drive.velocity = 5.0 is refused', "if 5 m/s is intended, add -p 'meant:=["]),
        (['meant:=drive.velocity'], ["meant = 'drive.velocity'", 'a list']),
    ])
    def test_by_words(self, words: list[str], reported: list[str]) -> None:
        line = refusal_of('sim_node', *words)
        assert all(words in line for words in reported), line

    def test_a_parameter_without_p_is_no_name_to_be_replaced(self) -> None:
        line = refused(executable('sim_node'), 'scene:=positioning')
        assert line.startswith("sim_node: argument = 'scene:=positioning' is refused: must be behind --ros-args -p; "
                               'sim_node --ros-args -p scene:=positioning')

    @pytest.mark.parametrize('program', ['sim_node', 'stickslip'])
    def test_a_terminal_that_does_not_know_the_workspace(self, program: str) -> None:
        plain = {name: os.environ[name] for name in ('PATH', 'HOME')}
        path = executable(program)
        line = refused(path, '--help', env=plain)
        setup = re.fullmatch(rf'{program}: this terminal does not know the workspace: source (/.*/setup.bash), in each '
                             r'terminal\n', line)
        assert setup, line
        subprocess.run(['bash', '-c', f'source {setup[1]} && {path} --help'], timeout=60, check=True, env=plain)


class TestFiles:
    @pytest.mark.parametrize(('texts', 'words', 'scene', 'mass'), [
        (['scene: mine'], [], 'mine', 350.0),
        (['scene: paper_fig7'], ['axis.mass:=300.0'], 'paper_fig7', 300.0),
        (['record: {enabled: false}'], ['scene:=positioning'], 'positioning', 350.0),
        (['{scene: mine, axis: {mass: 200.0}, contact: {stiffness: null}}', 'seed: 5'], ['scene:=yours'],
         'yours', 200.0),
        (['use_sim_time: false'], [], 'paper_fig8', 350.0),
        (['{scene: paper_fig7, meant: null, contact: {stiffness: null}}'], [], 'paper_fig7', 350.0),    # as dumped
    ])
    def test_are_a_scene_by_the_rules_of_the_tool(self, tmp_path: Path, texts: list[str], words: list[str],
                                                  scene: str, mass: float) -> None:
        for number, text in reversed([*enumerate(texts)]):    # what comes later on the command line wins
            file = tmp_path / f'{number}.yaml'
            file.write_text(f'/**:\n  ros__parameters: {text}\n' if text[0] == '{'
                            else f'/**:\n  ros__parameters:\n    {text}\n')
            words = ['--params-file', str(file), *words]
        with axis_here(*words) as axis:
            of_the_node = axis.values('scene', 'axis.mass', 'contact.model', 'friction.static.law')
            assert [value.string_value or value.double_value for value in of_the_node[:2]] == [scene, mass]
            if texts[0].startswith('scene'):
                same = load_scene(str(tmp_path / '0.yaml')).values
                assert [value.string_value for value in of_the_node[2:]] == [
                    same['contact.model'], same['friction.static.law']]

    def test_one_without_friction_and_one_for_other_nodes_are_warned_of(self, tmp_path: Path,
                                                                       capfd: pytest.CaptureFixture[str]) -> None:
        """And an unusual number that is meant is taken."""
        mine, other = tmp_path / 'mine.yaml', tmp_path / 'other.yaml'
        mine.write_text('/**:\n  ros__parameters:\n    scene: position\n')
        other.write_text('/press/feed_axis:\n  ros__parameters:\n    axis: {mass: 1.0}\n')
        files = ('--params-file', str(mine), '--params-file', str(other))
        with axis_here(*files, 'drive.velocity:=5.0', 'meant:=[drive.velocity]') as axis:
            assert axis.values('drive.velocity')[0].double_value == 5.0
        warned = capfd.readouterr().err
        assert 'the scene position leaves out the friction: the axis has none; did you mean positioning?' in warned
        assert f'{other} has no section for /feed_axis' in warned
        assert f'{mine} has no section' not in warned


def test_nothing_is_imported_before_signals_are_taken() -> None:
    program = ('import os, signal, sys, collections.abc; before = set(sys.modules);'
               'import stickslip_sim.ros.executables; print(*sorted(set(sys.modules) - before))')
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.split() == [
        'stickslip_sim', 'stickslip_sim.core', 'stickslip_sim.core.version', 'stickslip_sim.ros',
        'stickslip_sim.ros.executables', 'stickslip_sim.ros.stop_signals']
