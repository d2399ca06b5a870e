# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pages: what they list and quote is what the code has and prints, and their commands do not clash."""

import re
import shlex
import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain, pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click import Context

from benchmarks import identification, maps, measured
from benchmarks.page import part_of, quoted, replaced, shown
from dev.api import LISTS, quality
from dev.files import ROOT
from dev.pages import MADE
from stickslip_sim.bags import bag_files, mcap_records, schemas, topics
from stickslip_sim.check import remake
from stickslip_sim.cli.main import stickslip
from stickslip_sim.core import errors
from stickslip_sim.core.input_profile import MAX_SINUSOIDS
from stickslip_sim.friction.kinetic import MAX_BREAKPOINTS
from stickslip_sim.inputs import csv_table, load_scene
from stickslip_sim.recording import reader
from stickslip_sim.runs import samples, simulated
from stickslip_sim.scene import parameter, ros_yaml, schema
from stickslip_sim.simulation.faults import MAX_FAULTS
from stickslip_sim.study import folder
from tests.support.floors import floors
from tests.support.tool import Capture, answered

PAGES = [ROOT / 'README.md', *sorted((ROOT / 'docs').glob('*.md'))]


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding='utf-8')


class TestMade:
    """Files that `make pages` writes."""

    @pytest.mark.parametrize('name', MADE)
    def test_they_are_up_to_date(self, name: str) -> None:
        """A line of docs/api.md that goes or changes breaks the promise, and needs a major version."""
        assert text_of(name) == MADE[name](), 'make pages'

    @pytest.mark.parametrize('text', ['no place', '<!-- verbs: begin -->', '<!-- verbs: end -->'])
    def test_a_page_without_a_place_for_a_part_is_refused(self, text: str) -> None:
        with pytest.raises(ValueError, match='lacks <!-- verbs: begin -->'):
            replaced(text, 'verbs', '')

    def test_the_measured_tables_follow_the_data(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """A program that keeps new figures fills the page with them, and what it keeps is read back."""
        for file in measured.DATA.iterdir():
            (tmp_path / file.name).write_bytes(file.read_bytes())
        (tmp_path / 'measured.md').write_text(text_of('docs/measured.md'))
        monkeypatch.setattr(measured, 'DATA', tmp_path)
        monkeypatch.setattr(measured, 'PAGE', tmp_path / 'measured.md')
        soak = measured.kept('soak')
        assert measured.page() == text_of('docs/measured.md')
        soak['rows'][0]['measured'] = 4.75
        measured.keep(tmp_path / 'soak.json', **soak)
        assert measured.kept('soak') == soak
        assert '| 4.75 | 5 |' in (tmp_path / 'measured.md').read_text()

    @pytest.mark.parametrize(('name', 'row'), [
        ('verbs', '| `call inject-fault` | `KIND` |'),
        ('verbs', '| `simulate` | `SCENE` | `--duration`,'),
        ('python', '| `critical` | `(scene, name, between=None, accuracy=1e-09, progress=None)` |'),
        ('python', '| `Cycle` | a tuple of `begin`,'),
        ('topics', '| `/clock` | `rosgraph_msgs/msg/Clock` | out | reliable, keep last 1 | no |'),
        ('topics', '| `drive_velocity` | `stickslip_msgs/msg/DriveVelocity` | in | best effort, keep last 64 | yes |'),
        ('services', '| `sim_node` | `~/step` | `stickslip_msgs/srv/Step` |'),
        ('services', '`simulation_interfaces/srv/StepSimulation`'),
        ('services', '| `replay_node` | `~/stop` | `std_srvs/srv/Trigger` |'),
        ('messages', 'KIND_TIME_LOST 9'),
        ('messages', '`velocity`, `force` → `success` bool'),
    ])
    def test_each_list_has_what_users_meet(self, name: str, row: str) -> None:
        """Once for each way to find the names: a pattern that matches nothing would empty the list."""
        assert row in LISTS[name]()


class TestApi:
    """What docs/api.md says beside its lists."""

    def test_the_exit_codes_are_those_of_the_errors(self) -> None:
        listed = {int(code) for code in re.findall(r'^\| (\d) \|', text_of('docs/api.md'), re.MULTILINE)}
        kinds = {one.exit_code for one in vars(errors).values()
                 if isinstance(one, type) and issubclass(one, errors.StickslipError)}
        assert listed == kinds | {0}

    def test_the_parameters_of_scheduling_are_as_many_as_it_says(self) -> None:
        source = text_of('stickslip_sim/stickslip_sim/ros/node/parameters.py')
        names = [*{*re.findall(r"Entry\('(\w+)'", source)} - {'meant'}, 'cpu_affinity']
        assert len(names) == 4
        assert 'and four of [scheduling](realtime.md)' in text_of('docs/api.md')
        assert all(f'| `{name}` |' in text_of('docs/realtime.md') for name in names)

    def test_the_pages_of_topics_have_the_quality_of_service_of_the_node(self) -> None:
        for topic in (topics.JOINT_STATES, topics.JOINT_COMMANDS):
            assert f'\n`{topic.name}`, {quality(topic)}' in text_of('docs/ros2_control.md')
        assert f'up to {topics.DRIVE_VELOCITY.kept} of' in text_of('docs/hil.md')


class TestLimits:
    """The limits in docs/security.md are those of the code."""

    ROWS = tuple(line for line in text_of('docs/security.md').splitlines() if '|' in line)

    @pytest.mark.parametrize(('what', 'limits'), [
        ('a scene, limits or other', (ros_yaml.SIZE_LIMIT, ros_yaml.MOST_NODES, ros_yaml.MOST_LEVELS,
                                      ros_yaml.MOST_NUMBERS, ros_yaml.LISTS_LIMIT)),
        ('points of a profile', (schema.MOST_POINTS, csv_table.MOST_BYTES)),
        ('a text in a scene', (parameter.TEXT_LIMIT,)),
        ('breakpoints of a friction table', (MAX_BREAKPOINTS, MAX_SINUSOIDS, MAX_FAULTS)),
        ('a record of a bag', (mcap_records.RECORD_LIMIT >> 20,)),
        ('schemas, attachments', (bag_files.MOST_BESIDE >> 20,)),
        ('a definition', (schemas.LONGEST_DEFINITION, schemas.MOST_ELEMENTS)),
        ('a topic of a bag', (reader.MOST_TOPIC_BYTES >> 20,)),
        ('the description of a sweep', (folder.LONGEST_SIDECAR >> 20,)),
        ('steps that a recording may lack', (remake.MOST_MISSING,)),
        ('samples and events', (simulated.MAX_SAMPLES, samples.MOST_IN_MEMORY, simulated.MAX_EVENTS)),
    ])
    def test_of_the_package(self, what: str, limits: tuple[int, ...]) -> None:
        (row,) = [row for row in self.ROWS if row.startswith(f'| {what}')]
        assert tuple(int(word) for word in re.findall(r'(?<!\S)\d+(?=[\s;,])', row.split('|')[2])) == limits

    def test_of_the_node(self) -> None:
        pytest.importorskip('rclpy')
        from stickslip_msgs.srv import Step
        from stickslip_sim.ros.node.endpoints import COMMAND_SIZE
        from stickslip_sim.ros.node.parameters import MOST_PARAMETERS

        page = '\n'.join(self.ROWS)
        assert f'| a message on a command topic | {COMMAND_SIZE} bytes |' in page
        assert f'| steps of one `~/step` | {Step.Request.MAX_STEPS} |' in page
        assert f'| parameters that one request sets or asks for | {MOST_PARAMETERS} |' in page


class TestQuoted:
    """Commands with what they print, and files."""

    PRINTED = re.compile(r'^    (?:stickslip|python3 -m stickslip_sim) (.*(?:\\\n.*)*)\n\n'
                         r'((?:    .*\n|\n(?=    (?!stickslip|python3 -m stickslip_sim)))+)', re.MULTILINE)

    @pytest.mark.parametrize(('page', 'part', 'number'), [
        ('friction_curve', 'friction', 0), ('friction_curve', 'critical', 0), ('maps', 'critical', 1)])
    def test_a_command_prints_what_is_quoted(self, page: str, part: str, number: int,
                                             monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
        """In less than a second; those that take longer are in test_pages_run.py."""
        monkeypatch.chdir(ROOT)
        command, printed = self.PRINTED.findall(part_of(text_of(f'docs/{page}.md'), part))[number]
        code, out, _ = answered(capsys, *shlex.split(command.replace('\\\n', ' ')))
        assert (code, quoted(out)) == (0, printed)

    @pytest.mark.parametrize(('page', 'part', 'commands'), [
        *(('maps', name, [*map(shown, commands)]) for name, commands in maps.PICTURES.items()),
        ('maps', 'critical', [*map(shown, maps.CRITICAL)]),
        ('maps', 'uncertainty', [shown(maps.UNCERTAIN)]),
        *(('identification', name, [*map(shown, commands)]) for name, commands in identification.COMMANDS.items()),
    ])
    def test_the_commands_are_those_that_are_measured(self, page: str, part: str, commands: list[str]) -> None:
        text = '\n' + part_of(text_of(f'docs/{page}.md'), part)
        assert [command for command in commands if f'\n{command}\n' not in text] == []

    @pytest.mark.parametrize('name', maps.PICTURES)
    def test_the_picture_of_a_map_is_shown(self, name: str) -> None:
        picture = maps.picture_of(maps.PICTURES[name][-1]).name
        assert f'](images/{picture})' in text_of('docs/maps.md')
        assert (maps.IMAGES / picture).is_file()

    @pytest.mark.parametrize(('page', 'file', 'head'), [
        ('friction_curve', 'examples/my_axis.yaml', 'friction_curve.md.\n'),
        ('identification', 'examples/identify/free.yaml', ''),
    ])
    def test_a_file_is_the_one_of_the_page(self, page: str, file: str, head: str) -> None:
        _, _, shown_lines = f'\n{text_of(file)}'.partition(head or '\n')
        assert f'```yaml\n{shown_lines}```\n' in text_of(f'docs/{page}.md')

    def test_the_scene_has_the_measured_curve(self) -> None:
        kinetic = load_scene(str(ROOT / 'examples/my_axis.yaml')).axis.friction.kinetic
        assert [f'{1000 * speed:g},{coefficient:g}' for speed, coefficient in zip(
            kinetic.velocities, kinetic.coefficients, strict=True)] == [
                ','.join(f'{float(word):g}' for word in row.split(','))
                for row in text_of('examples/friction_curve.csv').splitlines()[1:]]

    def test_the_controller_is_the_one_of_the_page(self) -> None:
        shown_part, = re.findall(r'^```python\n(.*?)^```$', text_of('docs/hil.md'), re.MULTILINE | re.DOTALL)
        assert f'\n\n{shown_part}\n' in text_of('examples/controller.py')

    def test_the_recipe_for_an_installed_ros_is_the_one_that_is_run(self) -> None:
        for command in (r'rosdep install .*', r'pip install --break-system-packages .*'):
            recipe, = re.findall(command, text_of('docs/install.md'))
            assert recipe in text_of('.ci/ros2')


class TestCommands:
    """Each of them can be given, whichever is first; git sees nothing of what they write."""

    FOLDERS = '--out', '--bag'
    FILES = '--plot', '--csv', '--parquet', '--events', '--samples', '--receipt', '--junit', '--json', '--scene-out'
    OTHERS = re.compile(r"record\.folder:=(\w\S*)|open\('([^']+)', 'w|create_keystore (\S+)|-m venv (\S+)")

    def commands(self) -> Iterator[list[str]]:
        """Yield the words of each command of the pages: of a line, or within one in backticks."""
        for page in PAGES:
            text = page.read_text(encoding='utf-8').replace('\\\n', ' ')
            for line in re.findall(r'(?:stickslip|python3 -m stickslip_sim) [^`|#\n]*', text):
                with suppress(ValueError):      # prose with an apostrophe
                    yield shlex.split(line)

    def outputs(self, *options: str) -> Iterator[str]:
        """Yield what the commands write by these options, but for names in capitals and numbers of samples."""
        for words in self.commands():
            for option, word in pairwise(words):
                if option in options and re.fullmatch(r'[\w./-]*[a-z][\w./-]*', word) and not Path(word).stem.isupper():
                    yield word

    def test_no_two_make_the_same_folder(self) -> None:
        """What is there is never overwritten: the second one would be refused."""
        found = Counter(name for name in self.outputs(*self.FOLDERS) if not Path(name).suffix)
        assert {'runs/my_axis_map', 'runs/my_run_figures', 'runs/slippery', 'runs/maps/load', 'runs/measured',
                'runs/eight'} <= set(found)
        assert [name for name, count in found.items() if count > 1] == []

    def test_what_they_write_is_ignored_by_git(self) -> None:
        """Else `git status` shows runs and pictures where a page was followed.  Pages are written anew on purpose."""
        if not (ROOT / '.git').exists():
            pytest.skip('not a clone')
        pictures = {f'{Path(run).name}.png' for words in self.commands() for verb, run in pairwise(words)
                    if verb == 'plot' and '--out' not in words and not run.startswith('-')}
        others = {name for page in PAGES for names in self.OTHERS.findall(page.read_text(encoding='utf-8'))
                  for name in names if name}
        found = {name for name in {*self.outputs(*self.FOLDERS, *self.FILES), *others, *pictures}
                 if not name.endswith('.md')}
        assert {'runs/eight', 'runs/receipt.json', 'eight.png', '.venv', 'runs/again', 'runs/scene.yaml'} <= found
        done = subprocess.run(['git', 'check-ignore', '--stdin'], input='\n'.join(sorted(found)), cwd=ROOT, text=True,
                              capture_output=True, check=False)
        assert sorted(found - set(done.stdout.splitlines())) == []


def test_fences_stand_at_the_left() -> None:
    """Python-Markdown, which makes the site, takes none within a list for one."""
    assert [line for page in PAGES for line in page.read_text(encoding='utf-8').splitlines()
            if re.match(' +```', line)] == []


def test_every_page_of_the_docs_is_on_their_front_page() -> None:
    listed = re.findall(r'\]\((\w+\.md)\)', text_of('docs/index.md'))
    assert {*listed} == {page.name for page in PAGES[1:]} - {'index.md'}


def test_the_rooms_of_contributing_are_those_of_the_floors() -> None:
    """From the top, as import-linter keeps them; __main__ is no room.  A group is one or more floors, whole."""
    rooms = floors('stickslip_sim')[1:]
    _, _, table = text_of('CONTRIBUTING.md').partition('| floors in groups, from the top | rooms |\n|---|---|\n')
    groups = [re.findall(r'`(\w+)`', row) for row in table.partition('\n\n')[0].splitlines()]
    assert sorted(chain(*groups)) == sorted(chain(*rooms))
    order = {room: number for number, floor in enumerate(rooms) for room in floor}
    assert all(max(order[room] for room in group) < min(order[room] for room in following)
               for group, following in pairwise(groups))


def test_the_diagram_of_the_node_names_what_there_is() -> None:
    """Every topic but that of parameters, which each node has; services; verbs, which are the smallest words."""
    texts = [(''.join(element.itertext()), element.get('font-size'))
             for element in ElementTree.fromstring(text_of('docs/images/graph.svg')) if element.tag.endswith('}text')]
    words = {text for text, _ in texts}
    assert {topic.name for topic in vars(topics).values() if isinstance(topic, topics.Topic)} - words == {
        topics.PARAMETER_EVENTS.name}
    services = {word for word in words if word.startswith('~/')}
    assert services
    assert services <= {*re.findall(r'`(~/\w+)`', LISTS['services']())}
    verbs = {word for text, size in texts if size == '12' for word in text.split()} - {'--bag'}
    assert verbs >= {'simulate', 'uncertainty', 'export'}
    assert verbs <= {*stickslip.list_commands(Context(stickslip))}
