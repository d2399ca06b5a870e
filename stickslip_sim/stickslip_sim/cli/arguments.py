# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs have in common: the arguments RUN and RUN_OR_SCENE, the options --set and --allow-implausible."""

import functools
import shlex
import sys
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager, nullcontext
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


def check_usage(*cases: tuple[object, str]) -> None:
    """Raise UsageError with what is said of the first of cases that is so."""
    for is_so, said in cases:
        if is_so:
            raise click.UsageError(said)


def recorded_run(path: str) -> 'RecordedRun':
    """Return a recorded run; each verb says in its own words what is missing of it.

    Raises RecordingError, and InputError where nothing is.
    """
    from ..inputs.sources import recorded_run as read

    with progress_bar('reading'):
        return read(path)


def check_sources(sources: Sequence[str], duration: float | None, changes: 'SceneChanges', once: bool = True) -> None:
    """Raise UsageError where one is given again, --duration and --set have no scene, or a scene has no duration."""
    from ..inputs.sources import is_recorded

    if once:
        check_each_once(sources)
    recorded = [is_recorded(source) for source in sources]
    check_usage((all(recorded) and (duration is not None or changes.overrides),
                 '--duration and --set apply to scenes, not to recorded runs.'),
                (not all(recorded) and duration is None, 'A scene needs --duration SECONDS.'))


def run_of_source(source: str, duration: float | None, changes: 'SceneChanges', limits: 'Limits | None' = None
                  ) -> 'Run':
    """Return a recorded run, or that of a scene: for `limits`, which have to fit it, sampled as its node records it.

    Raises InputError and RecordingError.
    """
    from ..inputs.sources import is_recorded
    from ..runs import simulate, simulate_events
    from ..runs.simulated import check_run_times

    if is_recorded(source) or duration is None:    # a scene has one
        return recorded_run(source)
    if limits is not None:
        from ..check.limits import check_fit

        check_fit(limits, 0.0, duration, has_timing=False, commands=None)
    check_run_times(duration, None)
    scene = changes.load(source)
    with progress_bar('simulating') as progress:
        return simulate_events(scene, duration, progress) if limits is None else simulate(scene, duration,
                                                                                          progress=progress)


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

        return _with_options(
            click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help=help_of_set,
                         shell_complete=completion.complete_parameters),
            allow_implausible('Accept an implausible value of this parameter.', metavar='A.B',
                              shell_complete=completion.complete_parameters))(with_changes)
    return decorated


# What several verbs have.

scene_argument = click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
run_argument = click.argument('run', metavar='RUN', shell_complete=completion.complete_folders)
sources_argument = click.argument('sources', nargs=-1, required=True, metavar='RUN_OR_SCENE...',
                                  shell_complete=completion.complete_scenes)
scene_duration = click.option('--duration', type=float, metavar='SECONDS', help='Simulated time of a scene.')


def check_each_once(sources: Sequence[str]) -> None:
    """Raise UsageError where one is given again."""
    check_usage((len(set(sources)) < len(sources), 'Give each RUN_OR_SCENE only once.'))


def command_line(*words: str, **options: Iterable[object]) -> str:
    """Return the words that call the tool with options, each for every value but None; or those it was called with."""
    given = [word for name, values in options.items() for value in values if value is not None
             for word in (f'--{name}', str(value))]
    return shlex.join(['stickslip', *(words or sys.argv[1:]), *given])


def _with_options(*options: Callable[[ClickCommand], ClickCommand]) -> Callable[[ClickCommand], ClickCommand]:
    """Return what gives a command options, as if they stood above it in this order."""
    return lambda command: functools.reduce(lambda decorated, option: option(decorated), reversed(options), command)


# What a verb with a controller of the user has.

def controller_options(help_of_gain: str) -> Callable[[ClickCommand], ClickCommand]:
    """Give a command the argument `controller` and the options `scene`, `rate` and `gains`."""
    return _with_options(
        click.argument('controller', metavar='FILE.py:NAME'),
        click.option('--scene', required=True, metavar='SCENE', shell_complete=completion.complete_scenes,
                     help='Axis and its rig: a shipped scene or a file.'),
        click.option('--rate', type=float, metavar='HZ', help='Controller rate: time.rate divided by a whole number '
                                                              '[default: time.rate].'),
        click.option('--gain', 'gains', multiple=True, metavar='NAME=VALUE', help=help_of_gain))


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
    return _with_options(*_OPTIONS, worker_options, scene_changes('Change a parameter of the scene.'))(command)


def worker_options(command: ClickCommand) -> ClickCommand:
    """Give a command the options of what runs a study; it takes them as the arguments `members` and `resume`."""
    @functools.wraps(command)
    def with_members(*, workers: str | None, scheduler: str | None, **arguments: Any) -> Any:
        return command(members=_members(workers, scheduler), **arguments)

    return _with_options(*_OF_WORKERS)(with_members)


def _members(workers: str | None, scheduler: str | None) -> Members:
    """Return the workers on a study: none but this process, processes, or a cluster; raises InputError, UsageError."""
    if workers is None and scheduler is None:
        return nullcontext()
    from ..study.folder import process_count
    from ..study.sweep import cluster, processes

    check_usage((scheduler is not None and workers is not None, '--workers and --scheduler exclude each other.'))
    if scheduler is not None:
        return cluster(scheduler)
    count = process_count(str(workers))
    return processes(count) if count > 1 else nullcontext()
