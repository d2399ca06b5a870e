# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The workflow file and the forms for issues against what they rely on; what of them was run is in CONTRIBUTING.md."""

import os
import re
from typing import Any

import pytest
import yaml

from tests.support.repository import ROOT

DISTROS = {path.stem.removeprefix('requirements-') for path in (ROOT / 'ros2_ws').glob('requirements-*.in')} - {
    'test', 'bench'}
PARTS = re.findall(r'^#   \.ci/ros2 (\w+)', (ROOT / '.ci/ros2').read_text(encoding='utf-8'), re.MULTILINE)


def read(name: str) -> Any:
    return yaml.safe_load((ROOT / '.github' / name).read_text(encoding='utf-8'))


@pytest.fixture(scope='module')
def jobs() -> Any:
    return read('workflows/ci.yaml')['jobs']


def commands(job: Any) -> list[str]:
    return [step['run'] for step in job['steps'] if 'run' in step]


def test_each_job_runs_on_each_distribution(jobs: Any) -> None:
    for job in jobs.values():
        assert set(job['strategy']['matrix']['distro']) == DISTROS


def test_jobs_call_programs_of_the_repository_and_nothing_else(jobs: Any) -> None:
    for job in jobs.values():
        for command in commands(job):
            assert os.access(ROOT / command.split()[0], os.X_OK)


def test_every_part_is_run_in_its_order(jobs: Any) -> None:
    assert commands(jobs['installed']) == [f'.ci/ros2 {part}' for part in PARTS]
    assert PARTS[0] == 'build'


def test_the_recipe_is_that_of_the_page() -> None:
    page = (ROOT / 'docs/install.md').read_text(encoding='utf-8')
    script = (ROOT / '.ci/ros2').read_text(encoding='utf-8')
    for command in (r'rosdep install .*', r'pip install --break-system-packages .*'):
        shown, = re.findall(command, page)
        assert shown in script


@pytest.mark.parametrize('name', ['defect.yml', 'proposal.yml'])
def test_forms_ask_for_scene_and_versions(name: str) -> None:
    fields = {field['id']: field for field in read(f'ISSUE_TEMPLATE/{name}')['body'] if 'id' in field}
    assert {'scene', 'versions'} <= set(fields)


def test_a_defect_and_a_change_come_with_a_receipt() -> None:
    assert 'receipt' in {field.get('id') for field in read('ISSUE_TEMPLATE/defect.yml')['body']}
    change = (ROOT / '.github/pull_request_template.md').read_text(encoding='utf-8')
    for word in ('scene', 'receipt', 'versions'):
        assert f'- {word}' in change
