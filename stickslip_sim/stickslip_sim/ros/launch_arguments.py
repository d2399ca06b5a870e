# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The arguments that `ros2 launch` was given: launch passes over those that no file declares."""

import difflib
import runpy
import sys
from collections.abc import Iterable
from pathlib import Path

from ..core.errors import InputError

_OF_LAUNCH = ('launch-prefix', 'launch-prefix-filter', 'emulate_tty', 'sigterm_timeout', 'sigkill_timeout')


def check_arguments(file: str, names: Iterable[str], *included: str) -> None:
    """Raise InputError on an argument of the command line that neither this launch file nor those beside it have.

    Only where this file itself is launched: one that includes it has arguments of its own.
    """
    known = [*names]
    for other in included:
        known += runpy.run_path(str(Path(file).with_name(other)))['ARGUMENTS']
    for word in _words_behind(Path(file).name):
        name, assigned, value = word.partition(':=')
        if assigned and name not in (*known, *_OF_LAUNCH):
            close = difflib.get_close_matches(name, known, 1)
            raise InputError(name, value, f'one of the arguments {", ".join(dict.fromkeys(known))}',
                             f'did you mean {close[0]}?' if close else 'drop it')


def _words_behind(name: str) -> list[str]:
    """Return the words of the command line behind a launch file; none where it is not there."""
    places = [place for place, word in enumerate(sys.argv) if Path(word).name == name]
    return sys.argv[places[0] + 1:] if places else []
