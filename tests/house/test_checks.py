# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What keeps the repository in order: `make check`, its hooks, the workflow, and the end of a suite that hangs."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from dev.links import broken_links, missing_paths
from dev.mutants import Mutant, mutants
from tests.support.repository import ROOT

pytestmark = pytest.mark.slow

TOOLS = Path(sys.executable).parent


def read(name: str) -> Any:
    return yaml.safe_load((ROOT / name).read_text(encoding='utf-8'))


def output(*command: str | Path, code: int) -> str:
    """Return what a command prints on both streams; it must end with this exit code."""
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120,
                          check=False)
    assert done.returncode == code, done.stdout
    return done.stdout


class TestSeededFaults:
    def test_of_words(self, tmp_path: Path) -> None:
        (tmp_path / 'neighbors.txt').write_text('a scenario\nsecond_reports\nFrictionOutlets\nDWELL_TIME\nto recieve\n')
        said = output(TOOLS / 'codespell', tmp_path, code=65)
        for found in ('1: scenario ==> scene', '2: second_reports ==> periodic_reports', '3: Outlets ==> Publishers',
                      '4: DWELL_TIME ==> REST_TIME', '5: recieve ==> receive', ' neighbors ==> neighbours'):
            assert found in said

    def test_ordinary_words_are_free(self, tmp_path: Path) -> None:
        (tmp_path / 'a.txt').write_text('The course of the wave, of course, easily told; drive.course, break-aways')
        assert output(TOOLS / 'codespell', tmp_path, code=0) == ''

    def test_of_prose(self, tmp_path: Path) -> None:
        page = tmp_path / 'page.md'
        page.write_text('# What is here\n\nThere is a slip. The slider is moved by the drive. A very long one: '
                        f'{"word " * 36}.\n\n* It stands beside the axis.\n\n| what was measured |\n|---|\n\n'
                        '    what is none in code\n\n`what is code`, [text](what-is.md). '
                        f'{"Multidimensional identification methodology. " * 12}\n')
        said = output(TOOLS / 'python', '-m', 'dev.prose', page, code=1)
        assert [line.partition('page.md:')[2].partition(': ')[0::2] for line in said.splitlines()] == [
            ('1', "'What is': name it with a noun"),
            ('1', 'reading ease -42, at least 50: shorter words and sentences'),
            ('3', '"A very long one: word word word word word word wor...": 40 words, at most 35'),
            ('3', '"The slider is moved by ...": passive: let the subject act'),
            ('3', '"There is ...": begin with the subject, or with "you"'),
            ('3', "weasel_words.very: Substitute 'damn' every time you're inclined to write 'very'; your editor will"
                  ' delete it and the writing will be just as it should be.'),
            ('5', "'beside': write next to, with, as well as or compared with"),
            ('7', "'what was': name it with a noun")]

    def test_of_links_within_the_docs(self, tmp_path: Path) -> None:
        (tmp_path / 'docs').mkdir()
        (tmp_path / 'docs/index.md').write_text('# A\n\n[a](nowhere.md) [b](#nowhere) [c](index.md#a) [d](#a)\n')
        (tmp_path / 'mkdocs.yml').write_text(f'INHERIT: {ROOT}/mkdocs.yml\nnav: [index.md]\n')
        said = output(TOOLS / 'mkdocs', 'build', '-f', tmp_path / 'mkdocs.yml', code=1)
        assert 'Aborted with 2 warnings in strict mode' in said

    def test_of_links_from_elsewhere(self) -> None:
        text = ('[a](nowhere.md) [b](docs/model.md#nowhere) [c](#nowhere) ![d](docs/images/nowhere.png)'
                ' [good](docs/security.md#sros-2) [good](#stickslip) [good](https://example.org/x) `[code](nowhere)`')
        assert broken_links(ROOT / 'README.md', text) == ['nowhere.md', 'docs/model.md#nowhere', '#nowhere',
                                                          'docs/images/nowhere.png']

    def test_of_paths(self) -> None:
        """They are looked for at the top and in the package."""
        text = ('docs/model.md, `launch/sim.launch.py`, stickslip_sim/core/errors.py, tests/test_*.py,'
                ' tests/nowhere.py, https://example.org/docs/nowhere.md and my_docs/nowhere.md, but docs/nowhere.md.')
        assert missing_paths(text) == ['docs/nowhere.md', 'tests/nowhere.py']


def test_a_commit_is_checked_by_the_tools_of_make_check() -> None:
    def tool(command: str) -> str:
        program, = re.findall(r'(?:\$\(TOOLS\)|ros2_ws/\.venv/bin)/(\S+(?: -m \S+)?)', command)
        return str(program)

    recipe = (ROOT / 'Makefile').read_text(encoding='utf-8').partition('\ncheck:')[2].partition('\n\n')[0]
    hooks = read('.pre-commit-config.yaml')['repos'][0]['hooks']
    assert [tool(hook['entry']) for hook in hooks] == [tool(line) for line in recipe.split('\n')[1:]]
    assert {hook['language'] for hook in hooks} == {'system'}


class TestWorkflow:
    JOBS = read('.github/workflows/ci.yaml')['jobs']

    def commands(self, job: str) -> list[str]:
        return [step['run'] for step in self.JOBS[job]['steps'] if 'run' in step]

    @pytest.mark.parametrize('job', JOBS)
    def test_a_job_runs_programs_of_the_repository_on_each_distribution(self, job: str) -> None:
        distros = {path.stem.removeprefix('requirements-') for path in (ROOT / 'ros2_ws').glob('requirements-*.in')}
        assert set(self.JOBS[job]['strategy']['matrix']['distro']) == distros - {'test', 'bench'}
        assert all(os.access(ROOT / command.split()[0], os.X_OK) for command in self.commands(job))

    def test_every_part_is_run_in_its_order(self) -> None:
        parts = re.findall(r'^#   (\.ci/ros2 \w+)', (ROOT / '.ci/ros2').read_text(encoding='utf-8'), re.MULTILINE)
        assert self.commands('installed') == parts
        assert parts[0] == '.ci/ros2 build'


ENDS = {
    'waits': 'import threading\n\ndef test_it():\n    threading.Event().wait()\n',
    'keeps_the_interpreter': 'import ctypes\n\ndef test_it():\n    ctypes.PyDLL(None).pause()\n',
    'is_killed': 'import os\nimport signal\n\ndef test_it():\n    os.kill(os.getpid(), signal.SIGKILL)\n',
}


def test_a_test_that_stands_still_or_kills_its_process_takes_no_other_with_it(tmp_path: Path) -> None:
    """Each has a test before it and one after in its file, beside ten files, as `make test` runs them."""
    passing = 'def test_{}():\n    pass\n\n'
    (tmp_path / 'conftest.py').write_text('from tests.support.whole_files import pytest_xdist_make_scheduler')
    for name, test in ENDS.items():
        (tmp_path / f'test_{name}.py').write_text(f'{passing.format("done")}{test}\n\n{passing.format("last")}')
    for number in range(10):
        (tmp_path / f'test_b{number}.py').write_text(passing.format('done'))
    said = output('env', f'PYTHONPATH={os.pathsep.join([str(ROOT), *sys.path])}', 'PYTEST_DISABLE_PLUGIN_AUTOLOAD=1',
                  sys.executable, '-m', 'pytest', '-c', ROOT / 'pyproject.toml', '--rootdir', tmp_path, tmp_path,
                  '-p', 'no:cacheprovider', '-p', 'xdist.plugin', '--dist', 'loadfile', '--no-loadscope-reorder',
                  '--tx', '2*popen', '-o', 'faulthandler_timeout=1', code=1)
    assert said.count(' in test_it\n') >= 2     # the stacks of those that stand still
    for name in ENDS:
        assert f"crashed while running 'test_{name}.py::test_it'" in said
    assert f'{len(ENDS)} failed, {10 + 2 * len(ENDS)} passed' in said


# The mutants of `make mutants` apply, and the tests that kill them are there.

MUTANTS = mutants()


def test_there_are_enough_of_them() -> None:
    assert len(MUTANTS) >= 60
    written = (ROOT / 'dev/mutants.yaml').read_text(encoding='utf-8').count('\n    test: ')    # YAML drops equal keys
    assert len({(one.file, one.name) for one in MUTANTS}) == len(MUTANTS) == written


@pytest.mark.parametrize('mutant', MUTANTS, ids=lambda one: f'{one.file}: {one.name}')
def test_a_mutant_applies_once_and_names_its_test(mutant: Mutant) -> None:
    assert mutant.text is not None, f'{mutant.file} does not have exactly once: {mutant.old}'
    assert mutant.new != mutant.old
    compile(mutant.text, mutant.file, 'exec')
    file, *names = mutant.test.partition('[')[0].split('::')
    text = (ROOT / file).read_text(encoding='utf-8')
    assert all(re.search(rf'\b(def|class) {name}\b', text) for name in names)
