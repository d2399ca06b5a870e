# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The container files against what they rely on; that they build and run is written in docs/docker.md."""

import fnmatch
import os
import re
import signal
import subprocess
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import yaml

from stickslip_sim.inputs import load_scene
from stickslip_sim.scene.schema import BY_NAME
from tests.support.dockerfiles import instructions, stages
from tests.support.node_processes import executable
from tests.support.repository import ROOT
from tests.support.ros_nodes import client
from tests.support.tool import restore_interrupt
from tests.support.waiting import DEADLINE

from stickslip_sim.ros.controllers.controller_parameters import (  # isort: skip  # after ros_nodes, which skips
    COMMON, COMPENSATION,
)

FILES = ['docker/Dockerfile', 'docker/Dockerfile.ros']
KNOWN = {'sim_node': set(BY_NAME), 'compensating_controller': {entry.name for entry in (*COMMON, *COMPENSATION)}}
ENTRYPOINT = ROOT / 'docker' / 'entrypoint'


def in_context(path: str) -> bool:
    """Return whether .dockerignore lets a path in: the last rule that matches it, or a folder above it, decides."""
    let_in = True
    for rule in (ROOT / '.dockerignore').read_text(encoding='utf-8').split('\n'):
        pattern = rule.lstrip('!').replace('**/', '*')
        if rule and not rule.startswith('#') and any(
                fnmatch.fnmatch(above, pattern) for above in (path, *map(str, Path(path).parents))):
            let_in = rule.startswith('!')
    return let_in


@pytest.mark.parametrize('file', FILES)
class TestBoth:
    def test_what_is_copied_exists_and_is_in_the_context(self, file: str) -> None:
        sources = [word for instruction in instructions(file) if instruction.name == 'COPY'
                   and '--from' not in instruction.text for word in instruction.words[:-1]]
        assert 'stickslip_sim' in sources
        assert all((ROOT / source).exists() for source in sources)
        assert all(in_context(source) for source in sources)

    def test_who_it_runs_as_how_it_is_asked_and_how_it_ends(self, file: str) -> None:
        final = {instruction.name: instruction for instruction in stages(file)[-1]}
        assert final['USER'].text not in ('root', '0')
        assert final['STOPSIGNAL'].text == 'SIGINT'
        assert final['ENTRYPOINT'].words == ['/opt/stickslip/docker/entrypoint']
        assert final['HEALTHCHECK'].words == ['/opt/stickslip/docker/entrypoint', 'health']
        assert final['CMD'].words == ['sim_node']
        for name in (final['CMD'].words[0], final['HEALTHCHECK'].words[1]):
            assert executable(name)

    def test_heard_on_this_machine_only(self, file: str) -> None:
        """As ROS has it, or as the profiles of Fast DDS do."""
        environment = ' '.join(entry.text for entry in stages(file)[-1] if entry.name == 'ENV')
        discovery_range = 'SYSTEM_DEFAULT' if 'DEFAULT_PROFILES_FILE' in environment else 'LOCALHOST'
        assert f'ROS_AUTOMATIC_DISCOVERY_RANGE={discovery_range}' in environment

    def test_lists_of_apt_stay_in_no_layer(self, file: str) -> None:
        for instruction in instructions(file):
            if 'apt-get' in instruction.text:
                assert 'rm -rf' in instruction.text
                assert '/var/lib/apt/lists/*' in instruction.text
                assert '--no-install-recommends' in instruction.text


class TestImage:
    def test_what_is_installed_is_what_the_lock_says(self) -> None:
        text = (ROOT / 'docker/Dockerfile').read_text(encoding='utf-8')
        assert 'pip install' not in text
        assert 'RUN ros2_ws/bootstrap\n' in text
        distro, = re.findall(r'ARG DISTRO=(\w+)', text)
        assert (ROOT / f'ros2_ws/requirements-{distro}.txt').is_file()

    def test_the_base_has_a_release(self) -> None:
        base, = re.findall(r'ARG BASE=(\S+)', (ROOT / 'docker/Dockerfile').read_text(encoding='utf-8'))
        assert re.fullmatch(r'debian:[a-z]+-slim', base)

    def test_compilers_stay_behind(self) -> None:
        build, final = stages('docker/Dockerfile')
        assert any('g++' in instruction.text for instruction in build)
        assert not any('g++' in instruction.text for instruction in final)

    def test_profiles_of_fast_dds_are_there_under_both_names(self) -> None:
        words = [word for entry in stages('docker/Dockerfile')[-1] if entry.name == 'ENV' for word in entry.words]
        values = dict(word.split('=') for word in words)
        assert values['FASTRTPS_DEFAULT_PROFILES_FILE'] == values['FASTDDS_DEFAULT_PROFILES_FILE']
        assert (ROOT / values['FASTDDS_DEFAULT_PROFILES_FILE'].removeprefix('/opt/stickslip/')).is_file()


@pytest.mark.parametrize(('path', 'is_in'), [
    ('ros2_ws/bootstrap', True), ('ros2_ws/requirements-jazzy.txt', True), ('docker/entrypoint', True),
    ('ros2_ws/.venv', False), ('ros2_ws/install/setup.bash', False), ('.git/config', False), ('runs/a', False),
    ('stickslip_sim/stickslip_sim/__pycache__', False), ('tests/house/test_docker.py', False),
    ('stickslip_sim/stickslip_sim/_hot.cpython-311-x86_64-linux-gnu.so', False),
])
def test_context(path: str, is_in: bool) -> None:
    assert in_context(path) == is_in


def compose(file: str) -> Any:
    return yaml.safe_load((ROOT / 'docker' / file).read_text(encoding='utf-8'))


def defaults(text: str) -> str:
    """Return a text with the defaults of its variables in place."""
    return re.sub(r'\$\{\w+:-([^}]*)\}', r'\1', text)


class TestCompose:
    def test_all_run_the_image_that_is_built_here(self) -> None:
        for service in compose('compose.yaml')['services'].values():
            context = ROOT / 'docker' / service['build']['context']
            assert context.resolve() == ROOT
            assert service['build']['dockerfile'] == 'docker/Dockerfile'
            assert service['image'] == 'stickslip'

    def test_programs_and_parameters(self) -> None:
        for service in compose('compose.yaml')['services'].values():
            program, *words = map(defaults, service['command'])
            assert executable(program)
            parameters = dict(word.split(':=') for flag, word in pairwise(words) if flag == '-p')
            assert words == ['--ros-args', *(word for name, value in parameters.items()
                                             for word in ('-p', f'{name}:={value}'))]
            assert set(parameters) <= KNOWN[program]
            for name, value in parameters.items():
                if name == 'scene':
                    load_scene(value)
                elif name in BY_NAME:
                    BY_NAME[name].checked(yaml.safe_load(value))

    def test_the_axis_records_into_the_volume(self) -> None:
        file = compose('compose.yaml')
        volume, _, folder = file['services']['axis']['volumes'][0].partition(':')
        assert volume in file['volumes']
        workdir = next(entry.text for entry in stages('docker/Dockerfile')[-1] if entry.name == 'WORKDIR')
        assert folder == f'{workdir}/runs'
        assert 'record.enabled:=true' in file['services']['axis']['command']

    def test_closed_to_the_outside_and_open_to_each_other(self) -> None:
        services = compose('compose.yaml')['services']
        assert services['axis']['network_mode'] == 'none'
        assert services['controller']['network_mode'] == 'service:axis'
        for service in services.values():
            assert service['read_only'] is True
            assert service['cap_drop'] == ['ALL']

    def test_on_the_network_of_the_machine_all_are(self) -> None:
        services, on_host = (compose(file)['services'] for file in ('compose.yaml', 'compose.host.yaml'))
        assert set(on_host) == set(services)
        assert all(service == {'network_mode': 'host'} for service in on_host.values())

    def test_real_time_adds_rights_and_parameters_to_the_axis(self) -> None:
        """A second file replaces the command as a whole."""
        axis = compose('compose.yaml')['services']['axis']
        (name, wanted), = compose('compose.realtime.yaml')['services'].items()
        assert name == 'axis'
        assert wanted['command'][:len(axis['command'])] == axis['command']
        added = [word.split(':=')[0] for word in wanted['command'][len(axis['command']):] if word != '-p']
        assert added == ['thread_priority', 'lock_memory', 'cpu_affinity', 'require_real_time']
        assert wanted['ulimits'] == {'rtprio': 99, 'memlock': -1}


@pytest.mark.ros
def test_the_entrypoint_runs_the_programs_and_hands_signals_on() -> None:
    """It runs in the built tree as in the image; what it starts takes its place."""
    environment = {name: value for name, value in os.environ.items() if name != 'AMENT_PREFIX_PATH'}
    process = subprocess.Popen([ENTRYPOINT, 'sim_node', '--ros-args', '-p', 'scene:=positioning'], env=environment,
                               stderr=subprocess.PIPE, text=True, preexec_fn=restore_interrupt)
    try:
        with client() as axis:
            axis.connect()
            assert axis.latest('run_info').scene == 'positioning'
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=DEADLINE)
    finally:
        process.kill()
    assert process.returncode == 0, errors
