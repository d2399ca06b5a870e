# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Both packages as they are released and installed: what bloom, rosdep, colcon, the build farm and pip make of them."""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import docutils.core
import pytest
from catkin_pkg.changelog import get_changelog_from_path
from catkin_pkg.package import parse_package

from dev.changelog import PACKAGES, SOURCE, changelog, rst
from stickslip_sim.core.version import __version__
from tests.support.repository import ROOT

pytestmark = pytest.mark.slow

MARKDOWN = SOURCE.read_text(encoding='utf-8')
DATA = ROOT / 'tests/data/rosdep'
INDEX = """\
type: index
version: 4
distributions:
  jazzy:
    distribution: [{data}/distribution.yaml]
    distribution_status: active
    distribution_type: ros2
    python_version: 3
"""
PROGRAMS = {'cascade_controller', 'compensating_controller', 'controller_node', 'health', 'replay_node', 'sim_node',
            'stickslip'}
INSTALLATIONS = {
    'colcon, with links': ['colcon', 'build', '--base-paths', '.', '--build-base', '../build',
                           '--install-base', '../install', '--symlink-install'],
    'build farm': [sys.executable, 'setup.py', '-q', 'egg_info', '--egg-base', '..', 'build', '--build-base',
                   '../build', 'install', '--root', '../install', '--prefix', '/stickslip_sim'],
}


def copy_package(folder: Path) -> Path:
    """Copy it, without what was built there; return the copy."""
    built = shutil.ignore_patterns('build', '_hot*', '_text*', '_standstill*', '*.egg-info', '__pycache__')
    return Path(shutil.copytree(ROOT / 'stickslip_sim', folder / 'sources', ignore=built))


def done(*command: str | Path, folder: Path = ROOT, environment: dict[str, str] | None = None) -> str:
    """Return what a command that succeeds prints."""
    process = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                             timeout=240, check=False, env=environment)
    assert process.returncode == 0, process.stdout
    return process.stdout


@pytest.mark.parametrize('name', PACKAGES)
class TestEach:
    def test_package_xml_has_what_a_release_asks_for(self, name: str) -> None:
        package = parse_package(ROOT / name)
        warnings: list[str] = []
        package.validate(warnings)
        assert warnings == []
        assert (package.name, package.version) == (name, __version__)
        assert package.authors
        assert package.maintainers
        assert sorted(url.type for url in package.urls) == ['bugtracker', 'repository', 'website']
        assert (ROOT / name / 'README.md').is_file()

    def test_the_licence_is_that_of_the_repository(self, name: str) -> None:
        """After a change: cp LICENSE stickslip_msgs/; cp LICENSE stickslip_sim/.  bloom takes no link out of it."""
        [licence] = parse_package(ROOT / name).licenses
        assert (ROOT / name / licence.file).read_bytes() == (ROOT / 'LICENSE').read_bytes()

    @pytest.mark.filterwarnings('ignore:nodes.Node.traverse:DeprecationWarning')    # docutils, by catkin_pkg
    def test_catkin_pkg_reads_the_changelog(self, name: str) -> None:
        found = get_changelog_from_path(ROOT / name, name)
        releases = {version: (f'{date:%Y-%m-%d}', content) for version, date, content in found.foreach_version()}
        assert {version: date for version, (date, _) in releases.items()} == dict(
            re.findall(r'^## (\d\S*) - (\S+)$', MARKDOWN, re.MULTILINE))
        assert all(content for _, content in releases.values())
        assert __version__ == [*releases][-1]    # bloom refuses to release another version than the newest


class TestChangelog:
    @staticmethod
    def text_of(markup: str) -> str:
        """Return what docutils reads, which finds no fault."""
        tree = docutils.core.publish_doctree(markup, settings_overrides={'report_level': 1, 'halt_level': 1})
        return ' '.join(str(tree.astext()).split())

    def test_it_loses_no_word(self) -> None:
        """Markdown without its marks, beside what docutils reads."""
        body = MARKDOWN[MARKDOWN.index('\n## '):]
        plain = re.sub(r'^## .*$|^#+ |^\* ', '', re.sub(r'\[([^\]]+)\]\([^)\s]+\)', r'\1', body), flags=re.MULTILINE)
        plain = re.sub(r'(`[^`]+`)|\*\*', lambda match: (match[1] or '').strip('`'), plain)
        read = self.text_of(changelog('stickslip_sim', MARKDOWN))
        read = ' '.join(re.split(r' (?:Forthcoming|\d+\.\d+\.\d+ \([\d-]+\)) ', read)[1:])
        assert read == ' '.join(plain.split())

    @pytest.mark.parametrize(('markdown', 'expected'), [
        ('`a`s and `*`', '``a``\\ s and ``*``'),
        ('x`a`', 'x\\ ``a``'),
        ('**Use `a` now** (`b`).', '**Use** ``a`` **now** (``b``).'),
        ('**`a` and `b`**: c', '``a`` **and** ``b``: c'),
        ('wildcards `*` and `**`, **bold**', 'wildcards ``*`` and ``**``, **bold**'),
        ('mu_k, name_ and 2 * 3', 'mu_k, name\\_ and 2 \\* 3'),
        ('* see [the page](docs/a.md#b)\n  [`c`](d)', '* see the page\n  ``c``'),
        ('### Motion of `a`\n\n* b', '**Motion of** ``a``\n\n* b'),
    ])
    def test_markup(self, markdown: str, expected: str) -> None:
        assert rst(markdown) == expected
        self.text_of(expected)

    def test_one_without_a_release_is_refused(self) -> None:
        with pytest.raises(ValueError, match=r'CHANGELOG.md has no heading "## X.Y.Z - YYYY-MM-DD"'):
            changelog('stickslip_sim', '# Changelog\n')


def test_rosdep_finds_a_rule_for_each_dependency(tmp_path: Path) -> None:
    """By the documented line, with the keys of its database that our packages name, and no more of them."""
    pytest.importorskip('rosdep2')
    (tmp_path / 'sources').mkdir()
    (tmp_path / 'sources/20-default.list').write_text(f'yaml file://{DATA}/keys.yaml\n')
    (tmp_path / 'index.yaml').write_text(INDEX.format(data=f'file://{DATA}'))
    outside = {name: value for name, value in os.environ.items() if name != 'AMENT_PREFIX_PATH'}    # of the wheels
    environment = {**outside, 'ROSDEP_SOURCE_PATH': str(tmp_path / 'sources'), 'ROS_HOME': str(tmp_path / 'home'),
                   'ROSDISTRO_INDEX_URL': f'file://{tmp_path}/index.yaml', 'ROS_DISTRO': 'jazzy'}

    def rosdep(*words: str) -> str:
        program = 'import sys; from rosdep2.main import rosdep_main; rosdep_main(sys.argv[1:])'
        return done(sys.executable, '-c', program, *words, environment=environment)

    rosdep('update', '--rosdistro', 'jazzy')
    (tmp_path / 'src').mkdir()
    for name in PACKAGES:
        (tmp_path / 'src' / name).symlink_to(ROOT / name)
    line = re.search(r'^ +rosdep (install .*)$', (ROOT / 'docs/install.md').read_text(), re.MULTILINE)
    assert line is not None
    asked = rosdep(*line[1].replace('--from-paths src', f'--from-paths {tmp_path}/src').split(), '--simulate',
                   '--reinstall', '--os', 'ubuntu:noble', '--rosdistro', 'jazzy')
    assert {'ros-jazzy-rclpy', 'ros-jazzy-std-msgs', 'python3-scipy', 'cython3'} <= {
        *re.findall(r'apt-get install -y (\S+)', asked)}
    assert 'pip' not in asked
    named = set(rosdep('keys', '--from-paths', f'{tmp_path}/src').split()) - set(PACKAGES)
    assert named == {word for file in ('keys', 'distribution') for words in re.findall(
        r'^ *- (\w+)$|^(?!type:|version:|rele|repo)([\w-]+):', (DATA / f'{file}.yaml').read_text(), re.MULTILINE)
        for word in words if word}


def test_the_built_workspace_has_programs_and_files() -> None:
    """Which colcon made, without links."""
    has_programs_and_files(ROOT / 'ros2_ws/install/stickslip_sim')


@pytest.mark.parametrize('command', INSTALLATIONS.values(), ids=INSTALLATIONS)
def test_an_installation_has_programs_and_files(command: list[str], tmp_path: Path) -> None:
    pytest.importorskip('rclpy')
    done(*command, folder=copy_package(tmp_path), environment={
        **os.environ, 'STICKSLIP_COMPILED': '0', 'COLCON_LOG_PATH': str(tmp_path / 'log')})
    has_programs_and_files(tmp_path / 'install/stickslip_sim')


def has_programs_and_files(prefix: Path) -> None:
    pytest.importorskip('rclpy')
    programs = [*(prefix / 'lib/stickslip_sim').iterdir()]
    assert {path.name for path in programs} == PROGRAMS
    assert [path.name for path in (prefix / 'bin').iterdir()] == ['stickslip']
    assert (prefix / 'share/ament_index/resource_index/packages/stickslip_sim').is_file()
    share = prefix / 'share/stickslip_sim'
    for name in ('launch', 'layouts', 'ros2_control', 'security', 'stickslip_sim/scenes'):
        wanted = {path.name for path in (ROOT / 'stickslip_sim' / name).iterdir() if path.is_file()}
        assert {path.name for path in (share / Path(name).name).iterdir()} == wanted, name
    for program in programs:
        outside = subprocess.run([program], capture_output=True, text=True, timeout=60, check=False, env={})
        assert (outside.returncode, outside.stderr.count('\n')) == (2, 1), outside.stderr
        assert f'{program.name}: this terminal does not know the workspace: source ' in outside.stderr


@pytest.fixture(scope='module')
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The unpacked wheel, made offline and without compiled code, which other tests are for."""
    folder = tmp_path_factory.mktemp('wheel')
    done(sys.executable, '-m', 'pip', 'wheel', '-q', '--no-deps', '--no-build-isolation', '--no-index',
         '--disable-pip-version-check', '-w', folder, copy_package(folder),
         environment={**os.environ, 'STICKSLIP_COMPILED': '0'})
    [file] = folder.glob('*.whl')
    zipfile.ZipFile(file).extractall(folder / 'unpacked')
    return folder / 'unpacked'


class TestWheel:
    """What `pip install ./stickslip_sim` gives to those without ROS: the tool, recording too, and no other program."""

    def test_the_tool_is_its_only_program(self, wheel: Path) -> None:
        [info] = wheel.glob('*.dist-info')
        programs = (info / 'entry_points.txt').read_text().split()
        assert programs == ['[console_scripts]', 'stickslip', '=', 'stickslip_sim.__main__:main']
        assert {path.name for path in wheel.iterdir()} == {info.name, 'stickslip_sim'}

    def test_a_run_is_recorded_and_verified_without_ros(self, wheel: Path, tmp_path: Path) -> None:
        commands = 'simulate paper_fig8 --duration 0.1 --bag eight', 'verify eight', 'export eight --csv states.csv'
        program = f'from stickslip_sim.cli.main import run; print(*[run(one.split()) for one in {commands}])'
        said = done(sys.executable, '-c', program, folder=tmp_path, environment={
            'PYTHONPATH': str(wheel), 'STICKSLIP_COMPILED': '0', '_ROS_WHEELS_BOOTSTRAP_COMPLETE': '1'})
        assert re.search(r'^identical, 101 steps', said, re.MULTILINE)
        assert said.endswith('\n0 0 0\n')
        assert (tmp_path / 'states.csv').stat().st_size > 5_000

    def test_the_copies_of_the_messages_are_the_messages(self) -> None:
        """After a change: cp stickslip_msgs/msg/*.msg stickslip_sim/stickslip_sim/bags/stickslip_msgs/."""
        copies = ROOT / 'stickslip_sim/stickslip_sim/bags/stickslip_msgs'
        assert {file.name: file.read_text() for file in copies.iterdir()} == {
            file.name: file.read_text() for file in (ROOT / 'stickslip_msgs/msg').glob('*.msg')}
