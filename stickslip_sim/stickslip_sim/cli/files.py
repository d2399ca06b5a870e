# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of results: checked before the work begins, and written whole or not at all; and the progress of the work.

A new folder of results is made with those around it.  A file makes one folder at most: below two that are missing
stands a path that is misspelt.
"""

import os
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.errors import InputError, VerdictError
from ..core.paths import check_picture_name, made_folder, nearest_existing, replacing
from ..core.types import Progress

if TYPE_CHECKING:
    from ..report.model import Part

STDOUT = '-'


class Output(click.types.StringParamType):
    """An option that names what a verb writes: checked, for all that the verb writes together, before it begins."""

    def __init__(self, check: Callable[[str, str], None], *endings: str, to_stdout: bool = False) -> None:
        self._check, self._endings, self._to_stdout = check, endings, to_stdout

    def check(self, option: str, path: str) -> None:
        """Raise InputError unless it can be written."""
        if self._endings and Path(path).suffix not in self._endings:
            raise InputError(option, path, f'a file ending in {" or ".join(self._endings)}', 'change its ending')
        if not (self._to_stdout and path == STDOUT):
            self._check(option, path)


class Verb(click.Command):
    """A command whose outputs are checked before it begins."""

    def invoke(self, ctx: click.Context) -> Any:
        """Check and run."""
        targets = []
        for option in self.params:
            if isinstance(option.type, Output):
                given = ctx.params[option.name or '']
                for path in given if isinstance(given, tuple) else () if given is None else (given,):
                    if option.type is not FOLDER or not ctx.params.get('resume'):    # of what goes on it is there
                        option.type.check(option.opts[0], path)
                    targets.append((option.opts[0], path))
        check_distinct(targets)
        return super().invoke(ctx)


def check_file(option: str, path: str) -> None:
    """Raise InputError unless a file can be written there; an existing one may be replaced, but no other argument.

    Its folder may be missing, but not the one around that.
    """
    place = _real(path)
    for name, other in _files_of_the_command(option):
        if _real(other) == place:
            raise InputError(option, path, f'a different file than {name}', 'choose another name')
    if place.is_dir():
        raise InputError(option, path, 'a file', 'this is a folder: add a file name')
    _check_folder(option, path, place.parent)
    _check_near(option, path, place.parent)
    if place.exists() and not os.access(place, os.W_OK):
        raise InputError(option, path, 'a writable file', 'change its permissions or choose another name')


def check_picture(option: str, path: str) -> None:
    """Raise InputError unless a picture can be written there."""
    check_picture_name(option, path)
    check_file(option, path)


def check_new_folder(option: str, path: str) -> None:
    """Raise InputError unless a new folder can be made there."""
    place = Path(os.path.abspath(path))
    if os.path.lexists(place):
        raise InputError(option, path, 'a folder that does not exist',
                         'runs are never overwritten: choose another name')
    _check_folder(option, path, place.parent)


def check_distinct(targets: Iterable[tuple[str, str]]) -> None:
    """Raise InputError when two options name the same place."""
    seen: dict[Path, str] = {}
    for option, path in targets:
        place = _real(path)
        if place in seen and (path == STDOUT or not _is_special(place)):
            raise InputError(option, path, f'a different file than {seen[place]}', 'choose another name')
        seen[place] = option


FILE, TEXT, PICTURE = Output(check_file), Output(check_file, to_stdout=True), Output(check_picture)
SCENE_FILE, FOLDER = Output(check_file, '.yaml', '.yml'), Output(check_new_folder)


@contextmanager
def new_folder(option: str, path: str) -> Iterator[Path]:
    """Yield a temporary folder that becomes the new folder `path` at the end, or vanishes on an error.

    Raises InputError when the disk refuses, or somebody else has made `path` meanwhile.
    """
    place = Path(os.path.abspath(path))
    temporary = place.with_name(f'.{os.getpid()}.{place.name}')
    with _refusing(path), made_folder(temporary):
        yield temporary
        check_new_folder(option, path)
        temporary.rename(place)


@contextmanager
def whole(path: str) -> Iterator[Path]:
    """Yield the path of a temporary file that takes the place of `path` at the end, or vanishes on an error.

    Raises InputError when the disk refuses.  What is no ordinary file (a pipe, /dev/null) is written to directly.
    """
    place = _real(path)
    if _is_special(place):
        with _refusing(path):
            yield place
        return
    with _refusing(path):
        place.parent.mkdir(parents=True, exist_ok=True)
        with replacing(place) as temporary:
            yield temporary


def write_text(path: str | None, lines: Iterable[str]) -> None:
    """Write lines where they are asked for: to a file, or for '-' to standard output.

    Errors of that are left to the end of the tool (`main`).
    """
    if path is None:
        return
    if path == STDOUT:
        if sys.stdout is None:
            raise InputError('output', 'standard output', 'open', 'the parent process closed it')
        sys.stdout.writelines(lines)
        sys.stdout.flush()
        return
    with whole(path) as temporary, open(temporary, 'w', encoding='utf-8', newline='\n') as file:
        file.writelines(lines)


def write_json(path: str | None, values: Any, indent: int = 2) -> None:
    """Write values, of any kind that `plain` takes, where they are asked for."""
    from ..report.values import json_text

    write_text(path, [] if path is None else [json_text(values, indent)])


def draw(path: str | None, drawing: Callable[[Path], object]) -> None:
    """Write a picture where one is asked for, whole or not at all."""
    if path is not None:
        with whole(path) as temporary:
            drawing(temporary)


def show(parts: 'Iterable[Part]', *others: str | None, flush: bool = False) -> None:
    """Print a report, unless one of `others` is written there instead; at once where the verb goes on with work."""
    from ..report.text import text_lines

    if STDOUT not in others:
        print(*(f'{line}\n' for line in text_lines(parts)), sep='', end='', flush=flush)


def end_with(complaint: str) -> None:
    """Raise VerdictError where there is something to complain of."""
    if complaint:
        raise VerdictError(complaint)


def say_written(*paths: str | None) -> None:
    """Print where results lie (None: not asked for); nothing where some of them are in the standard output."""
    given = [path for path in paths if path is not None]
    if given and STDOUT not in given:
        print(f'written: {", ".join(given)}')


@contextmanager
def _refusing(path: str) -> Iterator[None]:
    """Turn an error of the disk into an InputError; a reader that left is no error of the output."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        raise InputError('output', path, 'a writable place', error.strerror or str(error)) from None


def _files_of_the_command(but: str) -> Iterator[tuple[str, str]]:
    """Yield the other arguments and options of the command that name files which are there."""
    context = click.get_current_context(silent=True)
    for parameter in context.command.params if context else ():
        given = context.params.get(parameter.name or '') if context and but not in parameter.opts else None
        for value in given if isinstance(given, tuple) else (given,):
            if isinstance(value, str) and os.path.isfile(value):
                is_argument = isinstance(parameter, click.Argument)
                yield parameter.human_readable_name if is_argument else parameter.opts[0], value


def _real(path: str) -> Path:
    return Path(os.path.realpath(path))


def _is_special(place: Path) -> bool:
    return place.exists() and not place.is_file() and not place.is_dir()


def _check_folder(option: str, path: str, folder: Path) -> None:
    """Raise InputError unless a folder can be written in, or be made."""
    there = nearest_existing(folder)
    if not there.is_dir():
        raise InputError(option, path, f'in a folder; {there} is not a folder', 'choose another place')
    if not os.access(there, os.W_OK | os.X_OK):
        raise InputError(option, path, 'in a writable folder', 'choose another place')


def _check_near(option: str, path: str, folder: Path) -> None:
    """Raise InputError unless the folder of a file is there, or is a new one within one that is."""
    if nearest_existing(folder) not in (folder, folder.parent):
        raise InputError(option, path, f'in a folder, or one level below it; {folder.parent} does not exist',
                         'create it, or check the path')


# A progress bar on a terminal, for work that takes long: the share that is done where it is known, and the time.

_STEPS = 1000
_WITHOUT_SHARE = '%(label)s  %(info)s'
_WITH_SHARE = '%(label)s  [%(bar)s]  %(info)s'


@contextmanager
def progress_bar(label: str, patience: float = 1.0, every: float = 0.5) -> Iterator[Progress]:
    """Yield a function that takes the share that is done; None when nobody looks.

    A thread draws, so that one sees how long it takes also where the work does not come round to say how far it is.
    It draws after `patience` (s), and `every` so many seconds.  Within a bar there is no other.
    """
    if _Bar.is_up or not sys.stderr.isatty():
        yield None
        return
    bar = _Bar(label, patience, every)
    try:
        yield bar.take
    finally:
        bar.end()


def milestones(label: str, every: float = 10.0) -> Callable[[str, float], None]:
    """Return a function that takes a stage and the share that is done, and logs it, once in `every` seconds at most."""
    begin = said = time.monotonic()

    def take(stage: str, share: float) -> None:
        nonlocal said
        if time.monotonic() - said >= every:
            said = time.monotonic()
            click.echo(f'{label}: {stage}, {share:.0%} after {said - begin:.0f} s', err=True)
    return take


class _Bar:
    is_up = False

    def __init__(self, label: str, patience: float, every: float) -> None:
        _Bar.is_up = True
        self._label, self._patience, self._every = label, patience, every
        self._begin = time.monotonic()
        self._share: float | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._draw, daemon=True)
        self._thread.start()

    def take(self, share: float) -> None:
        self._share = share

    def end(self) -> None:
        self._ended.set()
        self._thread.join()
        _Bar.is_up = False

    def _draw(self) -> None:
        if self._ended.wait(self._patience):
            return
        without_share, with_share = self._drawn(_WITHOUT_SHARE, False), self._drawn(_WITH_SHARE, True)
        while True:
            share = self._share
            bar = without_share if share is None else with_share
            bar.update(round((share or 0.0) * _STEPS) - bar.pos)
            bar.render_progress()
            if self._ended.wait(self._every):
                break
        bar.render_finish()

    def _drawn(self, template: str, show_percent: bool) -> Any:
        return click.progressbar(length=_STEPS, label=self._label, file=sys.stderr, show_eta=False, width=30,
                                 show_percent=show_percent, bar_template=template,
                                 item_show_func=lambda _: f'{time.monotonic() - self._begin:.0f} s')
