# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs have in common: the arguments RUN and RUN_OR_SCENE, the options --set and --allow-implausible."""

import functools
import os
import shlex
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from ..core.errors import ALLOW
from . import completion
from .files import Verb, progress_bar

if TYPE_CHECKING:
    from ..check.limits import Limits
    from ..recording import RecordedRun
    from ..runs import Run
    from ..scene import Scene
    from ..study.sample import Distribution
    from ..study.sweep import Workers
    from ..study.variation import Variation


verb = functools.partial(click.command, cls=Verb)
_OF_RUNS, _OF_SCENES = ('.mcap',), ('.yaml', '.yml')
_OF_A_GLOB = '*?['
_A_RUN = 'a recorded run, a folder or an .mcap file'


def is_recorded(source: str) -> bool:
    """Return whether this is a recorded run, a folder or an .mcap file; the name of a shipped scene is the scene.

    Raises InputError when it is neither, nor the file of a scene.
    """
    from ..scene import scene_names

    path = Path(source)
    if source in scene_names():
        return False
    if not os.path.lexists(path):
        raise _is_not_there('RUN_OR_SCENE', source, 'a recorded run or a scene', scene_names(), _OF_RUNS + _OF_SCENES)
    return path.is_dir() or path.suffix in _OF_RUNS


def recorded_run(path: str) -> 'RecordedRun':
    """Return a recorded run; each verb says in its own words what is missing of it.

    Raises RecordingError, and InputError where nothing is.
    """
    from ..core.errors import RecordingWarning
    from ..recording import read_run

    check_run(path)
    with warnings.catch_warnings(), progress_bar('reading'):
        warnings.simplefilter('ignore', RecordingWarning)
        return read_run(path)


def check_sources(sources: Sequence[str], duration: float | None, changes: 'SceneChanges', once: bool = True) -> None:
    """Raise UsageError where one is given again, --duration and --set have no scene, or a scene has no duration."""
    if once:
        check_each_once(sources)
    recorded = [is_recorded(source) for source in sources]
    if all(recorded) and (duration is not None or changes.overrides):
        raise click.UsageError('--duration and --set apply to scenes, not to recorded runs.')
    if not all(recorded) and duration is None:
        raise click.UsageError('A scene needs --duration SECONDS.')


def run_of(source: str, duration: float | None, changes: 'SceneChanges', limits: 'Limits | None' = None) -> 'Run':
    """Return a recorded run, or that of a scene: for `limits`, which have to fit it, sampled as its node records it.

    Raises InputError and RecordingError.
    """
    if is_recorded(source) or duration is None:    # a scene has one
        return recorded_run(source)
    from ..check.limits import check_fit
    from ..runs import simulate, simulate_events
    from ..runs.simulated import check_run_times

    if limits is not None:
        check_fit(limits, 0.0, duration, has_timing=False, commands=None)
    check_run_times(duration, None)
    scene = changes.load(source)
    with progress_bar('simulating') as progress:
        return simulate_events(scene, duration, progress) if limits is None else simulate(scene, duration,
                                                                                          progress=progress)


def check_run(path: str) -> None:
    """Raise InputError unless something is where a recorded run should be."""
    from ..core.errors import InputError
    from ..scene import scene_names

    if os.path.lexists(path):
        return
    if path in scene_names():
        raise InputError('RUN', path, _A_RUN, f'this is a scene: record it with stickslip simulate {path} --duration 10'
                         ' --bag FOLDER')
    raise _is_not_there('RUN', path, _A_RUN, [], _OF_RUNS)


def _is_not_there(name: str, source: str, allowed: str, known: list[str], endings: tuple[str, ...]) -> Exception:
    """Return what is wrong with a path or name that nothing has, with the nearest one."""
    from ..core.errors import InputError, paths_beside, suggestion

    if any(letter in source for letter in _OF_A_GLOB):
        return InputError(name, source, allowed, 'no such run: nothing matches it')
    words = [] if os.sep in source else known
    beside = paths_beside(Path(source), endings, folders=True)
    written = [f'.{os.sep}{word}' if source.startswith(f'.{os.sep}') else word for word in beside]
    what = 'no such file' if source.endswith(_OF_SCENES) else 'no such run' if not words else 'no such run or scene'
    meant = suggestion(source, [*words, *written], '')
    return InputError(name, source, allowed, f'{what}; {meant}' if meant else f'{what}: check the name')


# The options --set and --allow-implausible of every verb that loads a scene, and the scene with them.

ClickCommand = Callable[..., Any]
Members = AbstractContextManager['Workers | None']    # that run a study


class SceneChanges(NamedTuple):
    """The values of --set, and the names of --allow-implausible."""

    overrides: tuple[str, ...]
    meant: tuple[str, ...]

    def also(self, override: str) -> 'SceneChanges':
        """Return the changes with one more, as of --set."""
        return self._replace(overrides=(*self.overrides, override))

    def given(self) -> dict[str, object]:
        """Return the changed values by dotted name; raises InputError."""
        from ..scene import parse_override

        return dict(parse_override(override) for override in self.overrides)

    def load(self, name: str) -> 'Scene':
        """Return a shipped scene or a file with the changes; raises InputError, also on a value to be asked back."""
        from ..inputs import load_scene
        from ..scene.load import named
        from ..scene.plausible import check_plausible

        scene = load_scene(name, self.given())
        with named(name):
            check_plausible(scene.values, self.meant)
        return scene

    def check_changed(self, scene: 'Scene') -> None:
        """Raise InputError on a value among those of --set to be asked back."""
        from ..scene.plausible import check_plausible

        check_plausible({name: scene.values.get(name) for name in self.given()}, self.meant)

    def check_ranges(self, ranges: 'Iterable[Variation | Distribution]') -> None:
        """Raise InputError on an end of a range, or of a distribution, to be asked back."""
        from ..scene.plausible import check_plausible

        for one in ranges:
            check_plausible({one.name.partition('[')[0]: (one.low, one.high)}, self.meant)


class _Renamed(click.Option):
    """An option whose old name works, but is not in the help."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        record = super().get_help_record(ctx)
        return record and (record[0].replace(f', {self.opts[1]}', ''), record[1])


def allow_implausible(help_of_it: str, **others: Any) -> Callable[[ClickCommand], ClickCommand]:
    """Return the option --allow-implausible, by its old name `--meant` an argument `meant`."""
    return click.option(ALLOW, '--meant', 'meant', cls=_Renamed, multiple=True, help=help_of_it, **others)


def scene_changes(help_of_set: str) -> Callable[[ClickCommand], ClickCommand]:
    """Give a command the two options; it takes them as one argument `changes`."""
    def decorated(command: ClickCommand) -> ClickCommand:
        @functools.wraps(command)
        def with_changes(*, changes: tuple[str, ...], meant: tuple[str, ...], **arguments: Any) -> Any:
            return command(changes=SceneChanges(changes, meant), **arguments)

        allowed = allow_implausible('Accept an implausible value of this parameter.', metavar='A.B',
                                    shell_complete=completion.complete_parameters)
        return click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help=help_of_set,
                            shell_complete=completion.complete_parameters)(
            allowed(with_changes))
    return decorated


# What several verbs have.

scene_argument = click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
run_argument = click.argument('run', metavar='RUN', shell_complete=completion.complete_folders)
sources_argument = click.argument('sources', nargs=-1, required=True, metavar='RUN_OR_SCENE...',
                                  shell_complete=completion.complete_scenes)
scene_duration = click.option('--duration', type=float, metavar='SECONDS', help='Simulated time of a scene.')


def check_each_once(sources: Sequence[str]) -> None:
    """Raise UsageError where one is given again."""
    if len(set(sources)) < len(sources):
        raise click.UsageError('Give each RUN_OR_SCENE only once.')


def command_line(*words: str, **options: Iterable[object]) -> str:
    """Return the words that call the tool with options, each for every value but None; or those it was called with."""
    given = [word for name, values in options.items() for value in values if value is not None
             for word in (f'--{name}', str(value))]
    return shlex.join(['stickslip', *(words or sys.argv[1:]), *given])


# What a verb with a controller of the user has.

def controller_options(help_of_gain: str) -> Callable[[ClickCommand], ClickCommand]:
    """Give a command the argument `controller` and the options `scene`, `rate` and `gains`."""
    options = (
        click.argument('controller', metavar='FILE.py:NAME'),
        click.option('--scene', required=True, metavar='SCENE', shell_complete=completion.complete_scenes,
                     help='Axis and its rig: a shipped scene or a file.'),
        click.option('--rate', type=float, metavar='HZ', help='Controller rate: time.rate divided by a whole number '
                                                              '[default: time.rate].'),
        click.option('--gain', 'gains', multiple=True, metavar='NAME=VALUE', help=help_of_gain),
    )
    return lambda command: functools.reduce(lambda decorated, option: option(decorated), reversed(options), command)


# The options of every verb that runs a study.

_OF_WORKERS = (
    click.option('--workers', metavar='N|all', help='Number of processes [default: 1].'),
    click.option('--scheduler', metavar='ADDRESS', help='Use the workers of this Dask scheduler.'),
    click.option('--resume', is_flag=True, help='Continue an interrupted study.'),
)
_OPTIONS = (
    click.option('--out', required=True, metavar='FOLDER',
                 help='New folder for points.csv (with pandas also .parquet).'),
    click.option('--duration', type=float, metavar='SECONDS',
                 help='Simulated time [default: until the motion settles].'),
)


def study_options(command: ClickCommand) -> ClickCommand:
    """Give a command the options of every study; it takes those of its workers as one argument `members`."""
    decorated = worker_options(scene_changes('Change a parameter of the scene.')(command))
    for option in reversed(_OPTIONS):
        decorated = option(decorated)
    return decorated


def worker_options(command: ClickCommand) -> ClickCommand:
    """Give a command the options of what runs a study; it takes them as the arguments `members` and `resume`."""
    @functools.wraps(command)
    def with_members(*, workers: str | None, scheduler: str | None, **arguments: Any) -> Any:
        return command(members=_members(workers, scheduler), **arguments)

    decorated: ClickCommand = with_members
    for option in reversed(_OF_WORKERS):
        decorated = option(decorated)
    return decorated


def _members(workers: str | None, scheduler: str | None) -> Members:
    """Return the workers on a study: none but this process, processes, or a cluster; raises InputError, UsageError."""
    if workers is None and scheduler is None:
        return nullcontext()
    from ..study.folder import process_count
    from ..study.sweep import cluster, processes

    if scheduler is not None:
        if workers is not None:
            raise click.UsageError('--workers and --scheduler exclude each other.')
        return cluster(scheduler)
    count = process_count(str(workers))
    return processes(count) if count > 1 else nullcontext()
