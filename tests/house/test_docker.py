# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The container files against what they rely on; that they build and run is written in docs/docker.md."""

import fnmatch
import json
import os
import re
import signal
import subprocess
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

from stickslip_sim.inputs import load_scene
from stickslip_sim.ros.controllers.controller_node import COMMON, COMPENSATION
from stickslip_sim.scene.schema import BY_NAME
from tests.support.node_processes import executable
from tests.support.repository import ROOT
from tests.support.ros_nodes import client
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

pytestmark = pytest.mark.slow

KNOWN = {'sim_node': set(BY_NAME), 'compensating_controller': {entry.name for entry in (*COMMON, *COMPENSATION)}}
ENTRYPOINT = '/opt/stickslip/docker/entrypoint'


class Instruction(NamedTuple):
    """One instruction, continued lines joined."""

    name: str
    text: str

    @property
    def words(self) -> list[str]:
        """Its words; of the exec form the elements."""
        exec_form = self.text[self.text.index('['):] if '[' in self.text else ''
        return [str(word) for word in json.loads(exec_form)] if exec_form else self.text.split()


def instructions(file: str) -> list[Instruction]:
    lines = (ROOT / file).read_text(encoding='utf-8').splitlines()
    text = '\n'.join(line for line in lines if not line.lstrip().startswith('#')).replace('\\\n', ' ')
    return [Instruction(*line.split(maxsplit=1)) for line in text.splitlines() if line.strip()]


def stages(file: str) -> list[list[Instruction]]:
    """Return the instructions of each stage, from FROM on."""
    found: list[list[Instruction]] = []
    for instruction in instructions(file):
        if instruction.name == 'FROM':
            found.append([])
        if found:
            found[-1].append(instruction)
    return found


def in_context(path: str) -> bool:
    """Return whether .dockerignore lets a path in: the last rule that matches it, or a folder above it, decides."""
    let_in = True
    for rule in (ROOT / '.dockerignore').read_text(encoding='utf-8').split('\n'):
        pattern = rule.lstrip('!').replace('**/', '*')
        if rule and not rule.startswith('#') and any(
                fnmatch.fnmatch(above, pattern) for above in (path, *map(str, Path(path).parents))):
            let_in = rule.startswith('!')
    return let_in


@pytest.mark.parametrize('file', ['docker/Dockerfile', 'docker/Dockerfile.ros'])
class TestBoth:
    def test_what_is_copied_exists_and_is_in_the_context(self, file: str) -> None:
        sources = [word for instruction in instructions(file) if instruction.name == 'COPY'
                   and '--from' not in instruction.text for word in instruction.words[:-1]]
        assert 'stickslip_sim' in sources
        assert all((ROOT / source).exists() and in_context(source) for source in sources)

    def test_who_it_runs_as_how_it_is_asked_and_how_it_ends(self, file: str) -> None:
        final = {instruction.name: instruction for instruction in stages(file)[-1]}
        assert final['USER'].text not in ('root', '0')
        assert final['STOPSIGNAL'].text == 'SIGINT'
        assert [final[name].words for name in ('ENTRYPOINT', 'HEALTHCHECK', 'CMD')] == [
            [ENTRYPOINT], [ENTRYPOINT, 'health'], ['sim_node']]
        assert executable('health')
        assert executable('sim_node')

    def test_heard_on_this_machine_only(self, file: str) -> None:
        """As ROS has it, or as the profiles of Fast DDS do."""
        environment = ' '.join(entry.text for entry in stages(file)[-1] if entry.name == 'ENV')
        discovery_range = 'SYSTEM_DEFAULT' if 'DEFAULT_PROFILES_FILE' in environment else 'LOCALHOST'
        assert f'ROS_AUTOMATIC_DISCOVERY_RANGE={discovery_range}' in environment


def test_the_image_has_what_the_lock_says_and_no_compiler() -> None:
    text = (ROOT / 'docker/Dockerfile').read_text(encoding='utf-8')
    build, final = (' '.join(instruction.text for instruction in stage) for stage in stages('docker/Dockerfile'))
    assert 'pip install' not in text
    assert 'RUN ros2_ws/bootstrap\n' in text
    distro, = re.findall(r'ARG DISTRO=(\S+)', text)
    assert (ROOT / f'ros2_ws/requirements-{distro}.txt').is_file()
    assert 'g++' in build
    assert 'g++' not in final
    profiles, again = re.findall(r'FAST(?:RTPS|DDS)_DEFAULT_PROFILES_FILE=/opt/stickslip/(\S+)', final)
    assert profiles == again    # under both names
    assert (ROOT / profiles).is_file()


@pytest.mark.parametrize(('path', 'is_in'), [
    ('ros2_ws/bootstrap', True), ('ros2_ws/requirements-jazzy.txt', True), ('docker/entrypoint', True),
    ('ros2_ws/.venv', False), ('ros2_ws/install/setup.bash', False), ('.git/config', False), ('runs/a', False),
    ('stickslip_sim/stickslip_sim/__pycache__', False), ('tests/house/test_docker.py', False),
    ('stickslip_sim/stickslip_sim/_hot.cpython-311-x86_64-linux-gnu.so', False),
])
def test_context(path: str, is_in: bool) -> None:
    assert in_context(path) == is_in


class TestCompose:
    @staticmethod
    def services(file: str = 'compose.yaml') -> dict[str, Any]:
        """Return the services of a file, with the defaults of its variables in place."""
        text = re.sub(r'\$\{\w+:-([^}]*)\}', r'\1', (ROOT / 'docker' / file).read_text(encoding='utf-8'))
        found: dict[str, Any] = yaml.safe_load(text)['services']
        return found

    @pytest.mark.parametrize('name', ['axis', 'controller'])
    def test_a_service_runs_the_image_that_is_built_here_without_rights(self, name: str) -> None:
        service = self.services()[name]
        assert (ROOT / 'docker' / service['build']['context']).resolve() == ROOT
        assert (service['build']['dockerfile'], service['image']) == ('docker/Dockerfile', 'stickslip')
        assert (service['read_only'], service['cap_drop']) == (True, ['ALL'])

    @pytest.mark.parametrize('name', ['axis', 'controller'])
    def test_a_program_has_parameters_that_there_are(self, name: str) -> None:
        program, flag, *words = self.services()[name]['command']
        assert executable(program)
        assert (flag, set(words[::2])) == ('--ros-args', {'-p'})
        parameters = dict(word.split(':=') for word in words[1::2])
        assert set(parameters) <= KNOWN[program]
        for parameter, value in parameters.items():
            if parameter == 'scene':
                load_scene(value)
            elif parameter in BY_NAME:
                BY_NAME[parameter].checked(yaml.safe_load(value))

    def test_the_axis_records_into_the_volume(self) -> None:
        axis = self.services()['axis']
        workdir = next(entry.text for entry in stages('docker/Dockerfile')[-1] if entry.name == 'WORKDIR')
        assert axis['volumes'] == [f'runs:{workdir}/runs']
        assert 'record.enabled:=true' in axis['command']

    def test_closed_to_the_outside_and_open_to_each_other(self) -> None:
        assert {name: service['network_mode'] for name, service in self.services().items()} == {
            'axis': 'none', 'controller': 'service:axis'}
        assert self.services('compose.host.yaml') == {
            name: {'network_mode': 'host'} for name in self.services()}

    def test_real_time_adds_rights_and_parameters_to_the_axis(self) -> None:
        """A second file replaces the command as a whole."""
        command = self.services()['axis']['command']
        (name, wanted), = self.services('compose.realtime.yaml').items()
        assert (name, wanted['command'][:len(command)]) == ('axis', command)
        added = [word.split(':=')[0] for flag, word in pairwise(wanted['command'][len(command):]) if flag == '-p']
        assert added == ['thread_priority', 'lock_memory', 'cpu_affinity', 'require_real_time']
        assert wanted['ulimits'] == {'rtprio': 99, 'memlock': -1}


@pytest.mark.ros
def test_the_entrypoint_runs_the_programs_and_hands_signals_on() -> None:
    """It runs in the built tree as in the image; what it starts takes its place."""
    environment = {name: value for name, value in os.environ.items() if name != 'AMENT_PREFIX_PATH'}
    process = subprocess.Popen([ROOT / 'docker/entrypoint', 'sim_node', '--ros-args', '-p', 'scene:=positioning'],
                               env=environment, stderr=subprocess.PIPE, text=True, preexec_fn=restore_interrupt)
    try:
        with client() as axis:
            axis.connect()
            assert axis.latest('run_info').scene == 'positioning'
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=DEADLINE)
    finally:
        process.kill()
    assert process.returncode == 0, errors
