# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every error a user can meet.

    StickslipError
    ├── InputError       a scene, parameter, command, file or flag is wrong
    ├── RecordingError   a run cannot be written or read
    ├── SolverError      the solver gave up
    │   └── UnsoundError what it found contradicts itself
    ├── RefusedError     a running node does not do what it is asked for
    ├── ControllerError  a controller of the user raised, or answered what is no command
    └── VerdictError     what was checked did not pass

Each carries one line of text for people and the exit code of the tool.
"""

import difflib
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

LINE_LIMIT = 2000   # characters
ALLOW = '--allow-implausible'    # the option that a refusal of an implausible number names; in 1.0 --meant


class StickslipError(Exception):
    """Base of all errors raised on purpose; `exit_code` is what the tool exits with."""

    exit_code = 1

    def __str__(self) -> str:
        """Return one line of printable text, with any names of files, topics and parameters in it."""
        return one_line(super().__str__())


class InputError(StickslipError):
    """A thing given by the user is refused, or missing (None): its name, value, allowed range and the fix."""

    exit_code = 2

    def __init__(self, name: str, value: object, allowed: str, fix: str) -> None:
        found = 'is missing' if value is None else f'= {_short(value)} is refused'
        super().__init__(f'{name} {found}: must be {allowed}; {fix}')
        self.name = name
        self.value = value
        self.allowed = allowed
        self.fix = fix


def check_kind(name: str, given: object, kind: Any, allowed: str, fix: str) -> None:
    """Raise InputError on an argument of Python of another kind."""
    if not isinstance(given, kind):
        raise InputError(name, type(given).__name__, allowed, fix)


class RecordingError(StickslipError):
    """A run folder cannot be written or read."""

    exit_code = 2


class RecordingWarning(UserWarning):
    """A run folder can be read, but not all of the run is in it."""


class SolverError(StickslipError):
    """The solver cannot go on; the last state it reached is still valid."""

    exit_code = 4


class UnsoundError(SolverError):
    """A run contradicts its own motion or its balance of energy: the solver is at fault, and it has no figures."""


class RefusedError(StickslipError):
    """A running node does not do what it is asked for, and says why."""

    exit_code = 2


class ControllerError(StickslipError):
    """A controller of the user raised, or answered what is no command; `run` is what was made before that, or None."""

    exit_code = 2
    run: Any = None


class VerdictError(StickslipError):
    """The work was done, and its verdict is "failed" or "differs"."""

    exit_code = 3


def one_line(text: str, limit: int = LINE_LIMIT) -> str:
    """Return text from outside as one line that any terminal and any file can hold."""
    printable = ''.join(letter if letter.isprintable() else '?' for letter in ' '.join(text[:4 * limit].split()))
    return printable if len(printable) <= limit else printable[:limit] + '…'


def not_utf8(error: UnicodeDecodeError, what: str) -> str:
    """Return where a file that should be `what` is not text in UTF-8, and the fix."""
    return (f'byte {error.start} is none; is it a {what}? If it is, in another encoding (µ in Latin-1), '
            'save it as UTF-8')


def internal_error(error: Exception) -> str:
    """Return one line about an error that nobody expected; under STICKSLIP_DEBUG=1 raise it, which shows where."""
    if os.environ.get('STICKSLIP_DEBUG') == '1':
        raise error
    first, *_ = str(error).splitlines() or ['']
    return f'internal error: {type(error).__name__}: {first} (STICKSLIP_DEBUG=1 shows where)'


def _short(value: object, limit: int = 80) -> str:
    return one_line(repr(value), limit)


# What a misspelt word was meant to be: a path for a path, a name for a name.

_ENDINGS = '.yaml', '.yml', '.mcap', '.csv'
_LISTED = 1000   # files of a folder that are looked at


def suggestion(word: str, known: Iterable[str], otherwise: str) -> str:
    """Return the question for the known word that is nearest, or what to do `otherwise`.

    An ending that files have in common makes none of them near.
    """
    ending = next((one for one in _ENDINGS if word.endswith(one)), '')
    names = {one.removesuffix(ending): one for one in known}
    close = difflib.get_close_matches(word.removesuffix(ending), names, 1)
    return f'did you mean {names[close[0]]}?' if close and names[close[0]] != word else otherwise


def paths_beside(path: Path, endings: Iterable[str], *, folders: bool = False) -> list[str]:
    """Return what lies in the folder of a path, as it would be written: files with these endings, and folders."""
    wanted = tuple(endings)
    known: list[str] = []
    if not path.name:   # of no word, nothing is near
        return known
    try:
        for _, place in zip(range(_LISTED), path.parent.iterdir()):
            if place.name.endswith(wanted) or (folders and not place.name.startswith('.') and place.is_dir()):
                known.append(str(path.with_name(place.name)))
    except OSError:
        return []
    return known
